#include "scene/shading_classes.h"

#include "lancer.h"
#include "scene/ready_lobes.h"

#include <map>

namespace lancer {

namespace {

std::string code_of(const Material &material, size_t number) {
  std::string code = material.flags & LANCER_MATERIAL_NO_BUMP_CORRECTION ? "u" : "c";
  if (!material.fixed())
    return code + std::to_string(number);
  for (size_t i = 0; i < material.lobes.size(); ++i)
    code += material.ready[i].code() + ' ';
  return code;
}

} // namespace

std::vector<uint32_t> shading_classes(const std::vector<Material> &materials) {
  std::map<std::string, uint32_t> numbers;
  std::vector<uint32_t> classes;
  for (size_t i = 0; i < materials.size(); ++i)
    classes.push_back(numbers.try_emplace(code_of(materials[i], i), uint32_t(numbers.size())).first->second);
  return classes;
}

} // namespace lancer
