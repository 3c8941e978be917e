// Results of samples beside their SampleResults, as many as the settings ask for: channels of light groups, of outputs and of
// shadow catchers, and mattes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace lancer {

enum MatteKind : uint32_t { kObjectMattes = 0, kMaterialMattes = 1, kAssetMattes = 2, kMatteKinds = 3 };

// The channels of a sample in their order: three of each light group, four of each colour, one of each value; of shadow
// catchers the light among catchers alone, and the picture without catchers, with its alpha.
struct ExtraLayout {
  uint32_t groups = 0, colors = 0, values = 0;
  uint32_t mattes = 0; // bits 1u << MatteKind
  bool catchers = false;

  uint32_t channels() const { return catcher_light() + (catchers ? 7 : 0); }
  uint32_t color(uint32_t number) const { return 3 * groups + 4 * number; }
  uint32_t value(uint32_t number) const { return color(colors) + number; }
  uint32_t catcher_light() const { return value(values); }
  uint32_t matte() const { return catcher_light() + 3; }
  bool has_outputs() const { return colors + values > 0; }
  bool has_mattes(uint32_t kind) const { return (mattes >> kind & 1u) != 0; }
};

// A surface's share of a sample. sample: its number; ids: by MatteKind, 0 = none.
struct MatteShare {
  uint32_t sample = 0;
  float share = 0.0f;
  std::array<uint32_t, kMatteKinds> ids{};
};

// The extras of samples that follow one another.
struct Extras {
  std::vector<float> channels;    // [sample][ExtraLayout::channels()]
  std::vector<MatteShare> mattes; // in no order

  void begin(size_t samples, const ExtraLayout &layout) {
    channels.assign(samples * layout.channels(), 0.0f);
    mattes.clear();
  }
  // Adds to the light of a sample from a group, 1 being the first; 0 = none.
  void add_light(const ExtraLayout &layout, uint32_t sample, uint32_t group, const glm::vec3 &light) {
    if (group == 0 || group > layout.groups)
      return;
    float *const to = channels.data() + size_t(sample) * layout.channels() + 3 * (group - 1);
    for (int i = 0; i < 3; ++i)
      to[i] += light[i];
  }
  // Multiplies the light of groups and of catchers; outputs are no light.
  void expose(const ExtraLayout &layout, float exposure) {
    const uint32_t of_groups = 3 * layout.groups, of_catchers = layout.catchers ? 6 : 0;
    for (size_t first = 0; of_groups + of_catchers > 0 && first < channels.size(); first += layout.channels()) {
      for (uint32_t i = 0; i < of_groups; ++i)
        channels[first + i] *= exposure;
      for (uint32_t i = 0; i < of_catchers; ++i)
        channels[first + layout.catcher_light() + i] *= exposure;
    }
  }
};

} // namespace lancer
