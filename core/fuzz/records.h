// Records of the C interface from bytes: small, with arbitrary contents.
#pragma once

#include "bytes.h"
#include "lancer.h"

#include <memory>
#include <vector>

namespace lancer_fuzz {

// The numbers of objects added to a scene, so that most references are valid.
struct Filled {
  uint32_t meshes = 0, images = 0, materials = 0, lights = 0, instances = 0;
};

// Makes records, and keeps the arrays that they point to during its lifetime.
class Records {
public:
  explicit Records(Bytes &bytes) : bytes_(bytes) {}

  lancer_mesh mesh();
  lancer_image image();
  lancer_material material(const Filled &filled);
  lancer_light light(const Filled &filled);
  lancer_world world(const Filled &filled);
  lancer_camera camera();
  lancer_settings settings();
  struct Instances {
    std::vector<lancer_instance> rows;
    std::vector<uint32_t> slots;
    const char *names;
    size_t names_size;
  };
  Instances instances(const Filled &filled);

  const char *name();
  void matrix(double rows[12], double away = 0.0);
  // Returns a number of keys of motion.
  uint32_t key_count();
  // Lets later records have members for compositing and motion; those before read no bytes for them, so that old files keep
  // their meaning.
  void widen() { wide_ = true; }

private:
  lancer_parameter parameter(float usual, float low = 0.0f, float high = 1.0f);
  lancer_parameter vector();
  lancer_attribute attribute(uint32_t vertices, uint32_t triangles);
  lancer_lobe lobe();
  lancer_principled principled();
  lancer_node node(const Filled &filled, uint32_t at);
  uint32_t nodes(const Filled &filled, const lancer_node *&out);
  uint32_t outputs(const lancer_output *&out);
  uint32_t matte();
  uint32_t group();
  uint64_t sets();
  void widen(lancer_mesh &mesh);
  void widen(lancer_instance &row);
  void widen(lancer_light &light);
  void widen(lancer_camera &camera);
  void widen(lancer_settings &settings);
  float *floats(size_t count, float low, float high);
  void make_blocks(lancer_image &image);
  void make_wide(lancer_image &image);
  uint32_t hidden_from() { return bytes_.rarely(40) ? bytes_.below(128) : bytes_.rarely(2) ? ~0u : 0u; }
  uint32_t flag(uint32_t often = 60) { return bytes_.rarely(often); }

  template <class T> T *keep(std::vector<T> values) {
    const auto kept = std::make_shared<std::vector<T>>(std::move(values));
    kept_.push_back(kept);
    return kept->data();
  }

  Bytes &bytes_;
  bool wide_ = false;
  uint32_t node_count_ = 0; // of the owner being made
  std::vector<std::shared_ptr<void>> kept_;
};

} // namespace lancer_fuzz
