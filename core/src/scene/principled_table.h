// The parameters of lancer_principled: X(kind, member, name for artists, default).
// Generated from core/include/lancer.h by `make bindings`; changes here are lost.
#pragma once

#define LANCER_PRINCIPLED_PARAMETERS(X)                                                                                        \
  X(Color, base_color, "base colour", 0.8f)                                                                                    \
  X(Share, metallic, "metallic", 0.0f)                                                                                         \
  X(Share, roughness, "roughness", 0.5f)                                                                                       \
  X(Index, ior, "IOR", 1.5f)                                                                                                   \
  X(Share, diffuse_roughness, "diffuse roughness", 0.0f)                                                                       \
  X(Amount, specular, "specular", 0.5f)                                                                                        \
  X(Color, specular_tint, "specular tint", 1.0f)                                                                               \
  X(Share, anisotropic, "anisotropic", 0.0f)                                                                                   \
  X(Turns, anisotropic_rotation, "anisotropic rotation", 0.0f)                                                                 \
  X(Share, transmission, "transmission", 0.0f)                                                                                 \
  X(Share, transmission_roughness, "transmission roughness", 0.0f)                                                             \
  X(Amount, coat, "coat", 0.0f)                                                                                                \
  X(Share, coat_roughness, "coat roughness", 0.03f)                                                                            \
  X(Denser, coat_ior, "coat IOR", 1.5f)                                                                                        \
  X(Color, coat_tint, "coat tint", 1.0f)                                                                                       \
  X(Direction, coat_normal, "coat normal", 0.0f)                                                                               \
  X(Amount, sheen, "sheen", 0.0f)                                                                                              \
  X(Share, sheen_roughness, "sheen roughness", 0.5f)                                                                           \
  X(Color, sheen_tint, "sheen tint", 1.0f)                                                                                     \
  X(Vector, emission, "emission", 0.0f)
