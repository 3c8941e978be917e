// The features that a scene needs and the classes of its materials, found at commit.
#pragma once

#include "scene/material.h"

#include <cstdint>
#include <string>

namespace lancer {

// Features that a scene uses. commit() finds them, the statistics name them, and they decide which stages run.
enum Feature : uint32_t {
  kFeatureTransparency = 1u << 0, // some material lets light pass straight through
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
  kFeatureEnvironmentMap = 1u << 13, // the radiance of the environment varies
  kFeatureVertexColors = 1u << 14,
  kFeatureNodes = 1u << 15, // some material computes its parameters by nodes
  kFeatureTextures = 1u << 16,
  kFeatureDisplacement = 1u << 17,
  kFeatureHoldout = 1u << 18,
  kFeatureVisibility = 1u << 19, // some object is hidden from some rays
  kFeatureGlass = 1u << 20,      // some material reflects and refracts
  kFeaturePortals = 1u << 21,    // some surface sends light on elsewhere
  kFeatureSubsurface = 1u << 22, // light enters some surface
  kFeatureMipmaps = 1u << 23,    // some node reads levels of an image
  kFeatureMotion = 1u << 24,     // some object moves or changes its shape
  kFeatureCatchers = 1u << 25,   // some object is a shadow catcher
  kFeatureOpenings = 1u << 26,   // light samples of the environment go through openings
};

struct Features {
  uint32_t bits = 0;   // Feature
  uint32_t shapes = 0; // shape_bit of every lobe shape that can occur
};

struct Description;

Features find_features(const Description &description);
// Returns the names of all features and shapes, separated by blanks.
std::string feature_names(const Features &features);

// Whether materials let light through a surface.

// Whether a lobe may refract.
bool is_glass(const LobeDescription &lobe);
// Whether some lobe of the material may be one of facets, which a least roughness changes.
bool has_facets(const MaterialView &material);
// Whether light may pass through the surface, straight or refracted.
bool lets_light_through(const MaterialView &material);

// Classes of materials by their shading code. Vertices of one class may be lanes of the same block.

// Returns the class of each material. Materials without nodes share a class if their lobes differ in numbers alone; a material
// with nodes has its own class, because its program differs.
std::vector<uint32_t> shading_classes(std::span<const MaterialView> materials);

} // namespace lancer
