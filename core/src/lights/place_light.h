// A light as described becomes one of the normalised world.
#pragma once

#include "lights/light.h"
#include "scene/normalisation.h"

namespace lancer {

Light place_light(const LightDescription &from, const Normalisation &normalisation);

} // namespace lancer
