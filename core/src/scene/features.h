// What a scene uses: found at commit, named in the statistics, and the reason for which stage runs.
#pragma once

#include <cstdint>
#include <string>

namespace lancer {

enum Feature : uint32_t {
  // One bit per lobe kind, in the order of LobeKind.
  kFeatureLambert = 1u << 0,
  kFeatureBeckmann = 1u << 1,
  kFeatureMirror = 1u << 2,
  kFeatureDielectric = 1u << 3,
  kFeaturePhong = 1u << 4,
  kFeatureBlinnPhong = 1u << 5,
  kFeatureAllLobes = 0x3f,
  kFeatureOpacity = 1u << 6, // some material lets light pass straight on
  kFeatureTriangles = 1u << 7,
  kFeatureInstances = 1u << 8, // some mesh is placed more than once
  kFeatureSpheres = 1u << 9,
  kFeaturePlanes = 1u << 10,
  kFeatureCylinders = 1u << 11,
  kFeatureCones = 1u << 12,
  kFeaturePointLights = 1u << 13,
  kFeatureSpotLights = 1u << 14,
  kFeatureSunLights = 1u << 15,
  kFeatureAreaLights = 1u << 16,
  kFeatureEmitters = 1u << 17,
  kFeatureEnvironment = 1u << 18,
  kFeatureVertexColors = 1u << 19,
};

struct Description;

uint32_t find_features(const Description &description);
// Names of all set bits, separated by blanks.
std::string feature_names(uint32_t features);

} // namespace lancer
