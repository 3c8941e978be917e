// The passes, and the members of lancer_settings: X(kind, member, default, largest value).
// Generated from core/include/lancer.h by `make bindings`; changes here are lost.
#pragma once

#include <cstdint>

namespace lancer {

// clang-format off
enum class Pass : uint32_t {
  Combined = 0, Depth = 1, Normal = 2, Albedo = 3, Position = 4, ObjectIndex = 5, MaterialIndex = 6, Uv = 7, Mist = 8, Emission
  = 9, Environment = 10, AmbientOcclusion = 11, DiffuseDirect = 12, DiffuseIndirect = 13, DiffuseColor = 14, GlossyDirect = 15,
  GlossyIndirect = 16, GlossyColor = 17, TransmissionDirect = 18, TransmissionIndirect = 19, TransmissionColor = 20,
  DenoisingNormal = 21, DenoisingDepth = 22, Error = 23, Halves = 24, AlbedoHalves = 25, NormalHalves = 26, SpecularAlbedo = 27,
  Roughness = 28, Vector = 29
};
// clang-format on

} // namespace lancer

#define LANCER_SETTINGS(X)                                                                                                     \
  X(Choice, integrator, 0u, 2u)                                                                                                \
  X(Number, samples, 256u, 0xffffffffu)                                                                                        \
  X(Number, seed, 0u, 0xffffffffu)                                                                                             \
  X(Number, max_bounces, 12u, 1024u)                                                                                           \
  X(Number, diffuse_bounces, 1024u, 1024u)                                                                                     \
  X(Number, glossy_bounces, 1024u, 1024u)                                                                                      \
  X(Number, transmission_bounces, 1024u, 1024u)                                                                                \
  X(Amount, contribution_threshold, 0.0f, 0xffffffffu)                                                                         \
  X(Amount, clamp_indirect, 0.0f, 0xffffffffu)                                                                                 \
  X(Amount, clamp_direct, 0.0f, 0xffffffffu)                                                                                   \
  X(Switch, no_reflections, false, 0xffffffffu)                                                                                \
  X(Switch, no_refractions, false, 0xffffffffu)                                                                                \
  X(Amount, filter_glossy, 0.0f, 0xffffffffu)                                                                                  \
  X(Amount, exposure, 1.0f, 0xffffffffu)                                                                                       \
  X(Number, fast_bounces, 0u, 1024u)                                                                                           \
  X(Amount, fast_factor, 1.0f, 0xffffffffu)                                                                                    \
  X(Amount, fast_distance, 0.0f, 0xffffffffu)                                                                                  \
  X(Amount, ambient, 0.0f, 0xffffffffu)                                                                                        \
  X(Number, split_lights, 1u, 16u)                                                                                             \
  X(Number, split_paths, 1u, 16u)                                                                                              \
  X(Choice, pixel_filter, 0u, 1u)                                                                                              \
  X(Width, filter_width, 1.0f, 0xffffffffu)                                                                                    \
  X(Switch, film_transparent, false, 0xffffffffu)                                                                              \
  X(Switch, transparent_glass, false, 0xffffffffu)                                                                             \
  X(Amount, glass_roughness, 0.0f, 0xffffffffu)                                                                                \
  X(Number, transparent_bounces, 8u, 1024u)                                                                                    \
  X(Number, transparent_shadows, 8u, 1024u)                                                                                    \
  X(Amount, alpha_threshold, 0.5f, 0xffffffffu)                                                                                \
  X(Switch, environment_reflections, false, 0xffffffffu)                                                                       \
  X(Amount, occlusion_distance, 0.0f, 0xffffffffu)                                                                             \
  X(Amount, mist_start, 5.0f, 0xffffffffu)                                                                                     \
  X(Amount, mist_depth, 25.0f, 0xffffffffu)                                                                                    \
  X(Amount, mist_falloff, 2.0f, 0xffffffffu)                                                                                   \
  X(Switch, blended_features, false, 0xffffffffu)                                                                              \
  X(Switch, sky_vectors, false, 0xffffffffu)                                                                                   \
  X(Switch, even_choices, false, 0xffffffffu)                                                                                  \
  X(Choice, features, 0u, 1u)                                                                                                  \
  X(Bits, passes, 1u, 1073741823u)                                                                                             \
  X(Bits, mattes, 0u, 7u)                                                                                                      \
  X(Number, light_groups, 0u, 1024u)                                                                                           \
  X(Number, aov_colors, 0u, 1024u)                                                                                             \
  X(Number, aov_values, 0u, 1024u)                                                                                             \
  X(Choice, catchers, 0u, 2u)                                                                                                  \
  X(Number, threads, 0u, 1024u)                                                                                                \
  X(Number, tile_size, 0u, 0xffffffffu)                                                                                        \
  X(Switch, refines, false, 0xffffffffu)
