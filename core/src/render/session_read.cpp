// The passes of a session, by their numbers in the interface.
#include "render/session.h"

#include "scene/messages.h"

#include <algorithm>

namespace lancer {

uint32_t Session::channels_of(uint32_t pass) {
  switch (pass / LANCER_PASS_SPAN) {
  case LANCER_PASS_KIND_PLAIN:
    if (pass >= LANCER_PASS_COUNT)
      bad_argument("read: pass " + std::to_string(pass) + " >= " + std::to_string(LANCER_PASS_COUNT) + " passes");
    return channels(static_cast<Pass>(pass));
  case LANCER_PASS_KIND_OBJECT_MATTES:
  case LANCER_PASS_KIND_MATERIAL_MATTES:
  case LANCER_PASS_KIND_ASSET_MATTES:
  case LANCER_PASS_KIND_AOV_COLOR:
  case LANCER_PASS_KIND_CATCHER_MATTE:
    return 4;
  case LANCER_PASS_KIND_LIGHT_GROUP:
  case LANCER_PASS_KIND_SHADOW_CATCHER:
    return 3;
  case LANCER_PASS_KIND_AOV_VALUE:
  case LANCER_PASS_KIND_SAMPLES:
  case LANCER_PASS_KIND_RENDER_TIME:
    return 1;
  default:
    bad_argument("read: pass " + std::to_string(pass) + " is of no kind");
  }
}

void Session::read(uint32_t pass, std::span<float> out) const {
  const uint32_t kind = pass / LANCER_PASS_SPAN, number = pass % LANCER_PASS_SPAN;
  const ExtraLayout &extras = film_.extras();
  const auto require = [&](bool stored) {
    if (!stored)
      bad_argument("session: pass " + std::to_string(pass) + " is not stored; request it in the settings");
  };
  switch (kind) {
  case LANCER_PASS_KIND_OBJECT_MATTES:
  case LANCER_PASS_KIND_MATERIAL_MATTES:
  case LANCER_PASS_KIND_ASSET_MATTES:
    require(extras.has_mattes(kind - LANCER_PASS_KIND_OBJECT_MATTES));
    return film_.read_mattes(kind - LANCER_PASS_KIND_OBJECT_MATTES, number, out);
  case LANCER_PASS_KIND_LIGHT_GROUP:
    require(number < extras.groups);
    return film_.read_extra(3 * number, 3, out);
  case LANCER_PASS_KIND_AOV_COLOR:
    require(number < extras.colors);
    return film_.read_extra(extras.color(number), 4, out);
  case LANCER_PASS_KIND_AOV_VALUE:
    require(number < extras.values);
    return film_.read_extra(extras.value(number), 1, out);
  case LANCER_PASS_KIND_SHADOW_CATCHER:
    require(extras.catchers);
    return film_.read_catcher(out);
  case LANCER_PASS_KIND_CATCHER_MATTE:
    require(extras.catchers);
    return film_.read_extra(extras.matte(), 4, out);
  case LANCER_PASS_KIND_SAMPLES:
    return film_.read_sample_count(out);
  case LANCER_PASS_KIND_RENDER_TIME:
    return film_.read_render_time(out);
  default:
    break;
  }
  if (static_cast<Pass>(pass) == Pass::Error) {
    const std::vector<float> bars = error_bars(LuminanceMap(film_, pool_.size()));
    std::copy(bars.begin(), bars.end(), out.begin());
    return;
  }
  require(film_.has(static_cast<Pass>(pass)));
  if (static_cast<Pass>(pass) == Pass::Combined && settings_.catchers == LANCER_CATCHERS_SHADOWS)
    return film_.read_shadows(!settings_.film_transparent, out);
  if (static_cast<Pass>(pass) == Pass::Combined && extras.catchers)
    return film_.read_extra(extras.matte(), 4, out);
  film_.read(static_cast<Pass>(pass), out);
}

} // namespace lancer
