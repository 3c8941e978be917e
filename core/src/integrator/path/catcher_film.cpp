#include "integrator/path/catcher_film.h"

namespace lancer {

void CatcherFilm::begin(size_t samples, uint32_t sums) {
  if (!keeps())
    return;
  sums_ = sums;
  met_.assign(samples, 0);
  indirect_.assign(samples * sums, glm::vec3(0.0f));
}

void CatcherFilm::add(Extras &extras, uint32_t sample, uint32_t channel, const glm::vec3 &light) const {
  float *const to = extras.channels.data() + size_t(sample) * layout_.channels() + channel;
  for (int i = 0; i < 3; ++i)
    to[i] += light[i];
}

void CatcherFilm::meet(uint32_t sample, const SampleResult &result, const glm::vec3 &gathered, float share, Extras &extras) {
  float *const matte = extras.channels.data() + size_t(sample) * layout_.channels() + layout_.matte();
  if (!met_[sample]) {
    add(extras, sample, layout_.matte(), gathered);
    matte[3] = result.alpha;
  }
  met_[sample] = 1;
  matte[3] -= share;
}

void CatcherFilm::end(uint32_t sample, const SampleResult &result, Extras &extras) {
  for (const glm::vec3 &light : indirect(sample))
    add(extras, sample, layout_.catcher_light(), light);
  if (!met_[sample])
    meet(sample, result, result.radiance, 0.0f, extras);
}

} // namespace lancer
