// Asks memory for texels before they are looked up. In a picture of 8192 x 8192 a random look-up waits for main memory twice as
// long as all else that it does takes; asked for one hit ahead it hardly waits, which takes a third off the look-ups' share of
// a textured scene.
#pragma once

#include "compile/scene.h"

#include <vector>

namespace lancer {

// A look-up that shading a hit will make; no image: none that is known beforehand.
struct ComingLookup {
  const Image *image = nullptr;
  glm::vec2 uv{0.0f};
  Extension extension = Extension::Repeat;
};

class TexturePrefetch {
public:
  explicit TexturePrefetch(const Scene &scene);

  // For the hit that will be shaded next. Pictures that lie on a surface by its UV map alone; the others are left to chance.
  void ahead(const Hit &hit) const {
    if (any_ && hit.valid())
      ask(hit);
  }
  // Of a valid hit.
  ComingLookup coming(const Hit &hit) const;

private:
  struct Picture {
    const Image *image = nullptr;
    uint32_t uv_map = 0; // number of the name
    Extension extension = Extension::Repeat;
  };

  static Picture find(const Scene &scene, const Material &material);
  void ask(const Hit &hit) const;

  const Scene &scene_;
  std::vector<Picture> pictures_; // by material
  bool any_ = false;
};

} // namespace lancer
