// What a scene needs: features and classes of materials, found at commit.
#pragma once

#include "scene/material.h"

#include <cstdint>
#include <string>

namespace lancer {

// Features that a scene uses: found at commit, named in the statistics; they decide which stages run.
enum Feature : uint32_t {
  kFeatureTransparency = 1u << 0, // some material lets light pass straight on
  kFeatureTriangles = 1u << 1,
  kFeatureInstances = 1u << 2, // some mesh is placed more than once
  kFeatureSpheres = 1u << 3,
  kFeaturePlanes = 1u << 4,
  kFeatureCylinders = 1u << 5,
  kFeatureCones = 1u << 6,
  kFeaturePointLights = 1u << 7,
  kFeatureSpotLights = 1u << 8,
  kFeatureSunLights = 1u << 9,
  kFeatureAreaLights = 1u << 10,
  kFeatureEmitters = 1u << 11,
  kFeatureEnvironment = 1u << 12,
  kFeatureEnvironmentMap = 1u << 13, // its radiance varies
  kFeatureVertexColors = 1u << 14,
  kFeatureNodes = 1u << 15, // some material computes its parameters
  kFeatureTextures = 1u << 16,
  kFeatureDisplacement = 1u << 17,
  kFeatureHoldout = 1u << 18,
  kFeatureVisibility = 1u << 19, // something is hidden from some rays
  kFeatureGlass = 1u << 20,      // some material reflects and refracts
};

struct Features {
  uint32_t bits = 0;   // Feature
  uint32_t shapes = 0; // shape_bit of every lobe shape that can occur
};

struct Description;

Features find_features(const Description &description);
// Names of all that is there, separated by blanks.
std::string feature_names(const Features &features);

// Which materials let light through a surface.

// A lobe that may refract.
bool is_glass(const LobeDescription &lobe);
// Straight on, or refracted.
bool lets_light_through(const Material &material);

// Materials by the code that shades them: vertices of one class may stand side by side in lanes.

// The number of each material's class. Materials without nodes share one where their lobes differ in numbers alone; one with
// nodes has a class of its own, as its program belongs to it.
std::vector<uint32_t> shading_classes(const std::vector<Material> &materials);

} // namespace lancer
