// A lobe's parameters at one point, after textures: what sample, eval and pdf work on.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace lancer {

enum class LobeKind : uint32_t { Lambert = 0, Beckmann = 1, Mirror = 2, Dielectric = 3, Phong = 4, BlinnPhong = 5 };

struct Lobe {
  LobeKind kind = LobeKind::Lambert;
  glm::vec3 color{0.0f};
  float alpha = 0.0f;     // Beckmann
  float ior = 1.5f;       // Beckmann, Dielectric; may be infinite
  float shininess = 0.0f; // Phong, BlinnPhong
};

// A direction drawn from a lobe or a whole BSDF, in the local frame (n = +z, wo and wi away from the surface).
struct BsdfSample {
  glm::vec3 wi{0.0f};
  glm::vec3 weight{0.0f}; // f |cos(wi)| / pdf; 0 = no sample
  float pdf = 0.0f;       // per solid angle; for a delta lobe the probability of having chosen it
  bool delta = false;     // a single direction: evaluation and pdf elsewhere are 0
};

} // namespace lancer
