// The input of render_whole(): a bit of everything, as records of the C interface.
#pragma once

#include "lancer.h"

#include <array>
#include <vector>

namespace lancer_test {

// The records, and the arrays that they point to.
struct WholeScene {
  std::vector<float> positions, normals, uvs, colors, tangents;
  std::vector<uint32_t> triangles;
  std::vector<uint16_t> slots;
  std::vector<uint8_t> texels;
  std::vector<float> sky;
  std::array<lancer_attribute, 2> attributes;
  std::array<lancer_mesh, 2> meshes;
  std::vector<lancer_node> paint_nodes, leaf_nodes, sky_nodes;
  lancer_principled principled;
  std::vector<lancer_lobe> paint_lobes, glass_lobes, leaf_lobes, old_lobes;
  std::vector<lancer_material> materials;
  std::array<lancer_image, 2> images;
  std::vector<lancer_light> lights;
  lancer_world world;
  std::vector<lancer_instance> instances;
  std::vector<uint32_t> instance_slots;

  WholeScene();
  WholeScene(const WholeScene &) = delete;
  WholeScene &operator=(const WholeScene &) = delete;

private:
  void make_meshes();
  void make_images();
  void make_materials();
  void make_lights();
  void make_instances();
};

// Made at the first call, which allocates memory.
const WholeScene &whole_scene();

} // namespace lancer_test
