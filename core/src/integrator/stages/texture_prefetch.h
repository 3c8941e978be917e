// Prefetches texels before they are looked up. In an image of 8192 x 8192, a random look-up waits for main memory twice as long
// as the rest of the look-up takes. With a prefetch one hit ahead, the look-up hardly waits; this saves a third of the time of
// look-ups in a textured scene.
#pragma once

#include "compile/scene.h"

#include <vector>

namespace lancer {

// The look-up that the shading of a hit will make; image is null if no look-up can be predicted.
struct ComingLookup {
  const ImageView *image = nullptr;
  glm::vec2 uv{0.0f};
  Extension extension = Extension::Repeat;
};

class TexturePrefetch {
public:
  explicit TexturePrefetch(const Scene &scene);

  // Prefetches for the hit that is shaded next. Only images placed by a UV map alone are prefetched.
  void ahead(const Hit &hit) const {
    if (any_ && hit.valid())
      ask(hit);
  }
  // Returns the look-up that the shading of the hit will make. The hit must be valid.
  ComingLookup coming(const Hit &hit) const;

private:
  struct Source {
    const ImageView *image = nullptr;
    uint32_t uv_map = 0; // number of its name
    Extension extension = Extension::Repeat;
  };

  static Source find(const MaterialView &material);
  void ask(const Hit &hit) const;

  const Scene &scene_;
  std::vector<Source> pictures_; // by material
  bool any_ = false;
};

} // namespace lancer
