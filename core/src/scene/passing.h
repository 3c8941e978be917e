// Which materials let light through a surface.
#pragma once

#include "scene/material.h"

namespace lancer {

// A lobe that may refract.
bool is_glass(const LobeDescription &lobe);
// Straight on, or refracted.
bool lets_light_through(const Material &material);

} // namespace lancer
