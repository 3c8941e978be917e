// Checks and copies settings; an Error names the setting and its value.
#pragma once

#include "lancer.h"
#include "render/session.h"

namespace lancer {

SessionSettings read_settings(const lancer_settings &source);
FilterKind read_filter(uint32_t filter, float width);

} // namespace lancer
