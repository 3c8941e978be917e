// Checks and copies materials; values outside the model are replaced and said, structure that cannot be read is refused.
#include "scene/description.h"
#include "scene/error.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace lancer {

namespace {

constexpr float kBrightest = 1e30f;

std::string number(float value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", double(value));
  return text;
}

class MaterialReader {
public:
  MaterialReader(std::string object, Messages &messages) : object_(std::move(object)), messages_(messages) {}

  // Each component: NaN becomes fallback, the rest is brought into [low, high].
  Parameter read(const char *what, const lancer_parameter &given, float low, float high, float fallback) {
    Parameter parameter;
    for (int i = 0; i < 3; ++i) {
      const float value = given.value[i];
      const float used = std::isnan(value) ? fallback : std::clamp(value, low, high);
      if (!(value == used))
        messages_.add(object_, std::string(what) + " " + number(value) + " was replaced by " + number(used));
      parameter.value[i] = used;
    }
    return parameter;
  }

  // A scalar in value[0]; nobody is told of the other two.
  Parameter read_scalar(const char *what, lancer_parameter given, float low, float high, float fallback) {
    given.value[1] = given.value[2] = low;
    Parameter parameter = read(what, given, low, high, fallback);
    parameter.value = glm::vec3(parameter.value.x);
    return parameter;
  }

  Parameter read_ior(const lancer_parameter &given) {
    // Zero and below have no meaning; glass's own default is the least surprise.
    const float value = given.value[0];
    lancer_parameter checked = given;
    if (!(value > 0.0f)) {
      messages_.add(object_, "IOR " + number(value) + " was replaced by 1.45");
      checked.value[0] = 1.45f;
    }
    return read_scalar("IOR", checked, 0.0f, INFINITY, 1.45f);
  }

private:
  std::string object_;
  Messages &messages_;
};

LobeDescription read_lobe(MaterialReader &reader, const lancer_lobe &given) {
  LobeDescription lobe;
  lobe.kind = static_cast<LobeKind>(given.kind);
  lobe.color = reader.read("colour", given.color, 0.0f, kBrightest, 0.0f);
  // Only what the lobe uses is looked at: nobody is told of a value without effect.
  if (lobe.kind == LobeKind::Beckmann)
    lobe.roughness = reader.read_scalar("roughness", given.roughness, 0.0f, 1.0f, 0.5f);
  if (lobe.kind == LobeKind::Beckmann || lobe.kind == LobeKind::Dielectric)
    lobe.ior = reader.read_ior(given.ior);
  if (lobe.kind == LobeKind::Phong || lobe.kind == LobeKind::BlinnPhong)
    lobe.shininess = reader.read_scalar("shininess", given.shininess, 0.0f, 1e8f, 32.0f);
  return lobe;
}

void check_textures(const std::string &object, const lancer_material &source) {
  const auto check = [&](const char *what, const lancer_parameter &given) {
    if (given.texture >= 0)
      bad_argument(object + ": " + what + " names texture " + std::to_string(given.texture) + ", but the scene has 0 textures");
  };
  check("emission", source.emission);
  check("opacity", source.opacity);
  check("ambient", source.ambient);
  for (uint32_t i = 0; i < source.lobe_count; ++i) {
    check("colour", source.lobes[i].color);
    check("roughness", source.lobes[i].roughness);
    check("IOR", source.lobes[i].ior);
    check("shininess", source.lobes[i].shininess);
  }
}

} // namespace

void add_material(Description &description, const lancer_material &source) {
  const std::string object = label("material", source.name, description.materials.size());
  if (source.lobe_count > uint32_t(kMaxLobes))
    bad_argument(object + ": " + std::to_string(source.lobe_count) + " lobes > " + std::to_string(kMaxLobes));
  if (source.lobe_count && !source.lobes)
    bad_argument(object + ": lobes is NULL for " + std::to_string(source.lobe_count) + " lobes");
  for (uint32_t i = 0; i < source.lobe_count; ++i) {
    if (source.lobes[i].kind > LANCER_BLINN_PHONG)
      bad_argument(object + ": lobe " + std::to_string(i) + " has kind " + std::to_string(source.lobes[i].kind) +
                   ", which is none");
  }

  check_textures(object, source);

  MaterialReader reader(object, description.messages);
  Material material;
  material.name = source.name ? source.name : "";
  material.index = source.material_index;
  for (uint32_t i = 0; i < source.lobe_count; ++i)
    material.lobes.push_back(read_lobe(reader, source.lobes[i]));
  material.emission = reader.read("emission", source.emission, 0.0f, kBrightest, 0.0f);
  material.opacity = reader.read_scalar("opacity", source.opacity, 0.0f, 1.0f, 1.0f);
  material.ambient = reader.read("ambient", source.ambient, 0.0f, kBrightest, 0.0f);
  for (const LobeDescription &lobe : material.lobes)
    for (const Parameter &parameter : {lobe.color, lobe.roughness, lobe.ior, lobe.shininess})
      material.textured |= parameter.texture >= 0;
  for (const LobeDescription &lobe : material.lobes)
    material.constant.lobes[material.constant.count++] = evaluate(lobe, Surface{});
  description.materials.push_back(std::move(material));
}

} // namespace lancer
