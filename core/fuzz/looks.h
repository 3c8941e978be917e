// Reads of sessions: their numbers are finite and in their ranges.
#pragma once

#include "states.h"

namespace lancer_fuzz {

// Waits until no range runs.
void wait_for_end(lancer_session session);
void ask_error(lancer_session session, double confidence, bool nowhere);
lancer_statistics statistics_of(lancer_session session);
// Returns the largest number of samples of a pixel.
uint32_t most_samples(lancer_session session);
// Returns whether the session gives its samples as a part.
bool exported(lancer_session session, std::vector<uint8_t> &part);
// Reads all passes of the film and the statistics, and replays a sample. state: null if unknown.
void look(lancer_session session, const SessionState *state, Bytes &bytes);

} // namespace lancer_fuzz
