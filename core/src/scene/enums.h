// The numbers of the interface that records of a scene hold, and the parameters of lancer_principled:
// X(kind, member, name for artists, default).
// Generated from core/include/lancer.h by `make bindings`; changes here are lost.
#pragma once

#include <cstdint>

namespace lancer {

// clang-format off
struct RayKind { enum : uint32_t {
  Camera = 1, Diffuse = 2, Glossy = 4, Transmission = 8, Shadow = 16, Volume = 32, Raycast = 64
}; };
struct NodeKind { enum : uint32_t {
  Coordinate = 0, Attribute = 1, Image = 2, Environment = 3, Alpha = 4, Mapping = 5, Transform = 6, Math = 7, VectorMath = 8,
  Mix = 9, Separate = 10, Combine = 11, Grey = 12, Fresnel = 13, LayerWeight = 14, NormalMap = 15, Bump = 16, Tangent = 17,
  Clamp = 18, Displacement = 19, Gamma = 20, Invert = 21, Noise = 22, Voronoi = 23, Gradient = 24, Curves = 25, ObjectInfo = 26,
  LightPath = 27, ColorModel = 28, Wave = 29, Magic = 30, Checker = 31, Brick = 32, WhiteNoise = 33, Gabor = 34, RadialTiling =
  35, Wireframe = 36, VectorTransform = 37, Ies = 38, Sky = 39, Occlusion = 40, Bevel = 41, Raycast = 42, Voxels = 43
}; };
struct AttributeFlag { enum : uint32_t {
  Opaque = 1, First = 2, Still = 4
}; };
struct ColorModel { enum : uint32_t {
  ToHsv = 0, FromHsv = 1, ToHsl = 2, FromHsl = 3
}; };
struct ObjectFact { enum : uint32_t {
  Location = 0, Color = 1, Index = 2, Random = 3, Attribute = 4
}; };
struct PathFact { enum : uint32_t {
  IsCamera = 0, IsShadow = 1, IsDiffuse = 2, IsGlossy = 3, IsSingular = 4, IsReflection = 5, IsTransmission = 6, IsVolume = 7,
  Length = 8, Depth = 9, DiffuseDepth = 10, GlossyDepth = 11, TransparentDepth = 12, TransmissionDepth = 13, PortalDepth = 14
}; };
struct NoiseKind { enum : uint32_t {
  Fbm = 0, Multifractal = 1, HybridMultifractal = 2, RidgedMultifractal = 3, HeteroTerrain = 4
}; };
struct NoiseFlag { enum : uint32_t {
  Normalized = 4, Repeats = 8, Counted = 16, Color = 32
}; };
struct VoronoiFeatureKind { enum : uint32_t {
  F1 = 0, F2 = 1, SmoothF1 = 2, DistanceToEdge = 3, NSphereRadius = 4
}; };
struct VoronoiMetric { enum : uint32_t {
  Euclidean = 0, Manhattan = 1, Chebychev = 2, Minkowski = 3
}; };
struct VoronoiFlag { enum : uint32_t {
  Normalized = 16, Color = 32, Position = 64, Integers = 128, Bounded = 256
}; };
struct GradientKind { enum : uint32_t {
  Linear = 0, Quadratic = 1, Easing = 2, Diagonal = 3, Spherical = 4, QuadraticSphere = 5, Radial = 6
}; };
struct Profile { enum : uint32_t {
  Sin = 0, Saw = 1, Tri = 2
}; };
struct Wave { enum : uint32_t {
  BandsX = 0, BandsY = 1, BandsZ = 2, BandsDiagonal = 3, RingsX = 4, RingsY = 5, RingsZ = 6, RingsSpherical = 7
}; };
struct Space { enum : uint32_t {
  World = 0, Object = 1, Camera = 2
}; };
struct SkyModel { enum : uint32_t {
  Preetham = 0, HosekWilkie = 1, Nishita = 2, SingleScattering = 3, MultipleScattering = 4
}; };
struct Coordinate { enum : uint32_t {
  Generated = 0, Normal = 1, Uv = 2, Object = 3, Camera = 4, Window = 5, Reflection = 6, Position = 7, ShadingNormal = 8,
  TrueNormal = 9, Incoming = 10, Backfacing = 11, Parametric = 12, FromCamera = 13, EdgeU = 14, EdgeV = 15
}; };
struct ImageProjection { enum : uint32_t {
  Flat = 0, Box = 1, Sphere = 2, Tube = 3
}; };
struct EnvironmentProjection { enum : uint32_t {
  Equirectangular = 0, MirrorBall = 1, Cube = 2
}; };
struct MappingType { enum : uint32_t {
  Point = 0, Texture = 1, Vector = 2, Normal = 3
}; };
struct MathOperation { enum : uint32_t {
  Add = 0, Subtract = 1, Multiply = 2, Divide = 3, MultiplyAdd = 4, Power = 5, Logarithm = 6, Sqrt = 7, InverseSqrt = 8,
  Absolute = 9, Exponent = 10, Minimum = 11, Maximum = 12, LessThan = 13, GreaterThan = 14, Sign = 15, Compare = 16, SmoothMin =
  17, SmoothMax = 18, Round = 19, Floor = 20, Ceil = 21, Trunc = 22, Fract = 23, Modulo = 24, FlooredModulo = 25, Wrap = 26,
  Snap = 27, Pingpong = 28, Sine = 29, Cosine = 30, Tangent = 31, Arcsine = 32, Arccosine = 33, Arctangent = 34, Arctan2 = 35,
  Sinh = 36, Cosh = 37, Tanh = 38, Radians = 39, Degrees = 40
}; };
struct VectorOperation { enum : uint32_t {
  Add = 0, Subtract = 1, Multiply = 2, Divide = 3, MultiplyAdd = 4, CrossProduct = 5, Project = 6, Reflect = 7, DotProduct = 8,
  Distance = 9, Length = 10, Scale = 11, Normalize = 12, Absolute = 13, Minimum = 14, Maximum = 15, Floor = 16, Ceil = 17,
  Fraction = 18, Modulo = 19, Snap = 20, Sine = 21, Cosine = 22, Tangent = 23
}; };
struct MixMode { enum : uint32_t {
  Mix = 0, Darken = 1, Multiply = 2, Burn = 3, Lighten = 4, Screen = 5, Dodge = 6, Add = 7, Overlay = 8, SoftLight = 9,
  LinearLight = 10, Difference = 11, Exclusion = 12, Subtract = 13, Divide = 14, Hue = 15, Saturation = 16, Color = 17, Value =
  18
}; };
struct MaterialFlag { enum : uint32_t {
  NoBumpCorrection = 1, NotALight = 2, OpaqueShadows = 4, KeepNormals = 8
}; };
// clang-format on

} // namespace lancer

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
  X(Vector, emission, "emission", 0.0f)                                                                                        \
  X(Amount, film_thickness, "film thickness", 0.0f)                                                                            \
  X(Index, film_ior, "film IOR", 1.33f)                                                                                        \
  X(Share, thin_wall, "thin wall", 0.0f)                                                                                       \
  X(Share, wall_scattering, "wall scattering", 0.0f)                                                                           \
  X(Share, wall_forward, "wall forward", 0.5f)                                                                                 \
  X(Share, subsurface, "subsurface", 0.0f)                                                                                     \
  X(Color, subsurface_radius, "subsurface radius", 0.0f)                                                                       \
  X(Color, subsurface_color, "subsurface colour", 0.8f)                                                                        \
  X(Index, subsurface_ior, "subsurface IOR", 1.4f)                                                                             \
  X(Signed, subsurface_anisotropy, "subsurface anisotropy", 0.0f)
