// Damage to parts of pictures, also with checksums that fit it.
#pragma once

#include "bytes.h"

#include <cstdint>
#include <vector>

namespace lancer_fuzz {

// Changes some bytes, numbers or the length of a part, and mostly corrects its size, its hash and its checksum afterwards, so
// that the checks behind them are reached.
void spoil(std::vector<uint8_t> &part, Bytes &bytes);

} // namespace lancer_fuzz
