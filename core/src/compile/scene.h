// The committed scene: normalised, immutable, with its lights and its accelerator.
#pragma once

#include "accel/accelerator.h"
#include "compile/cutout.h"
#include "compile/features.h"
#include "lights/lamp_shader.h"
#include "lights/light_set.h"
#include "scene/affine.h"
#include "scene/description.h"

namespace lancer {

struct Scene {
  Geometry geometry; // normalised
  std::vector<uint32_t> slots;
  std::vector<Material> materials;
  std::vector<uint32_t> classes;              // by material, from shading_classes()
  std::vector<Cutout> cutouts;                // by material
  std::vector<uint8_t> transparent_instances; // by instance: some of its materials may let light pass straight through
  std::vector<uint8_t> perforated_instances;  // by instance: it may be absent at some places, as cutouts say
  std::vector<Image> images;
  World world;
  LightSet lights;
  LampShaders lamp_shaders; // of lights.lamps()
  Normalisation normalisation;
  uint32_t features = 0; // bits of features.h
  uint32_t shapes = 0;   // of lobes, as in Features
  std::unique_ptr<Accelerator> accelerator;
  std::string messages;
  uint64_t triangles = 0; // over all instances
  double build_seconds = 0.0;

  // Returns the data that any node may read. camera: may be null.
  NodeScene node_scene(const Camera *camera) const { return {&geometry, &images, &normalisation, camera}; }
  // Returns the number that the user gave a primitive.
  uint32_t face_number(uint32_t instance, uint32_t primitive) const;
  size_t geometry_bytes() const; // with lights, without images
  size_t texture_bytes() const;  // copied images
  size_t mapped_bytes() const;   // images that are read in place
};

// Turns a description into a scene. Throws Error, or BuildCancelled when context.cancel is raised.
std::shared_ptr<const Scene> commit(Description description, AcceleratorKind kind, const BuildContext &context);

} // namespace lancer
