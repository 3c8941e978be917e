// The committed scene: normalised, immutable, with its lights and its accelerator.
#pragma once

#include "accel/coplanar/coplanar_faces.h"
#include "bsdf/material_lobes.h"
#include "compile/cutout.h"
#include "compile/features.h"
#include "compile/made_emitters.h"
#include "compile/made_meshes.h"
#include "compile/placed_geometry.h"
#include "lights/lamp_shader.h"
#include "lights/light_set.h"
#include "scene/affine.h"
#include "scene/description.h"
#include "scene/vectors.h"

namespace lancer {

// Data of a material that commit() makes; Material keeps them.
struct ReadyMaterial {
  ReadyLobes lobes;
  Cutout cutout;
};

struct Scene {
  // The memory that views refer to.
  std::shared_ptr<const PlacedGeometry> placed;
  std::vector<std::shared_ptr<const Material>> material_owners;
  std::vector<std::shared_ptr<const ReadyMaterial>> ready_materials;
  std::vector<std::shared_ptr<const LightDescription>> light_owners;
  std::vector<std::shared_ptr<const Image>> images;
  std::shared_ptr<const World> world_owner;
  MadeMeshes made_meshes;     // displaced and flattened
  MadeEmitters made_emitters; // trees of emitting faces
  PlaneRules plane_rules;     // of accelerator

  GeometryView geometry;
  std::vector<uint32_t> slots;
  std::vector<MaterialView> materials;
  std::vector<uint32_t> classes;              // by material, from shading_classes()
  std::vector<Cutout> cutouts;                // by material
  std::vector<uint8_t> transparent_instances; // by instance: some of its materials may let light pass straight through
  // By instance: as transparent_instances, or some light passes it by its links; empty where no light does.
  std::vector<uint8_t> linked_blockers;
  std::vector<uint8_t> perforated_instances; // by instance: it may be absent at some places, as cutouts say
  WorldView world;
  LightSet lights;
  LampShaders lamp_shaders; // of lights.lamps()
  Normalisation normalisation;
  Motion motion; // of camera and shutter, in the normalised world
  InstanceVectors vectors;
  uint32_t features = 0; // bits of features.h
  uint32_t shapes = 0;   // of lobes, as in Features
  std::shared_ptr<const Accelerator> accelerator;
  std::string messages;
  double build_seconds = 0.0;

  // Returns the data that any node may read. camera: may be null.
  NodeScene node_scene(const Camera *camera) const { return {&geometry, &normalisation, camera}; }
  // Returns the number that the user gave a primitive.
  uint32_t face_number(uint32_t instance, uint32_t primitive) const;
  size_t geometry_bytes() const; // with lights, without images
  size_t texture_bytes() const;  // copied images
  size_t mapped_bytes() const;   // images that are read in place
};

// Turns a description into a scene. before: a scene that differs little; the new scene shares all parts with it that are the
// same, and has the bits of one made without it. Throws Error, or BuildCancelled when context.cancel is raised.
std::shared_ptr<const Scene> commit(const Description &description, AcceleratorKind kind, const BuildContext &context,
                                    const Scene *before = nullptr);

} // namespace lancer
