// Members of records for compositing and motion: mattes, light groups, outputs, links, catchers, keys and vectors.
#include "records.h"

#include <algorithm>
#include <iterator>

namespace lancer_fuzz {

namespace {

constexpr uint32_t kMostOutputs = 3, kMostGroups = 4;

} // namespace

uint32_t Records::key_count() {
  constexpr uint32_t kValid[] = {3, 3, 5, 9, 129}, kInvalid[] = {1, 2, 4, 130, 257, ~0u};
  return bytes_.rarely(10) ? kInvalid[bytes_.below(std::size(kInvalid))] : kValid[bytes_.below(std::size(kValid))];
}

uint32_t Records::matte() { return bytes_.rarely(10) ? bytes_.word() : bytes_.below(4); }

uint32_t Records::group() { return bytes_.rarely(4) ? bytes_.word() : bytes_.below(kMostGroups + 1); }

uint64_t Records::sets() {
  const uint32_t low = bytes_.rarely(60) ? bytes_.word() : 0, high = bytes_.rarely(20) ? bytes_.word() : 0;
  return uint64_t(high) << 32 | low;
}

uint32_t Records::outputs(const lancer_output *&out) {
  if (!wide_)
    return 0;
  std::vector<lancer_output> outputs(bytes_.below(kMostOutputs + 1));
  for (lancer_output &output : outputs) {
    output.number = bytes_.rarely(10) ? bytes_.word() : bytes_.below(kMostOutputs);
    output.is_color = bytes_.choice(2);
    output.value = parameter(0.5f, -2.0f, 2.0f);
  }
  const auto count = uint32_t(outputs.size());
  out = bytes_.rarely(2) ? nullptr : keep(std::move(outputs));
  return bytes_.rarely(1) ? ~0u : count;
}

void Records::widen(lancer_mesh &mesh) {
  if (!wide_)
    return;
  const size_t row = 3 * size_t(mesh.vertex_count);
  if (flag(80)) {
    mesh.key_count = key_count();
    // A number of keys that no mesh may have is refused before a key is read.
    const size_t keys = std::min<size_t>(mesh.key_count, 129);
    float *const moved = floats(keys * row, -1.5f, 1.5f);
    if (mesh.positions && !bytes_.rarely(4))
      std::copy_n(mesh.positions, row, moved + keys / 2 * row);
    mesh.moved_positions = bytes_.rarely(2) ? nullptr : moved;
    const size_t normals = 3 * size_t(std::max(3 * mesh.triangle_count, mesh.vertex_count));
    mesh.moved_normals = flag(80) ? floats(keys * normals, -1.0f, 1.0f) : nullptr;
  }
  mesh.vector_positions = flag(40) ? floats(2 * row, -1.5f, 1.5f) : nullptr;
}

void Records::widen(lancer_instance &row) {
  if (!wide_)
    return;
  row.object_matte = matte();
  row.asset_matte = matte();
  row.light_group = group();
  row.receiver_set = bytes_.rarely(4) ? 64 : bytes_.below(64);
  row.blocker_set = bytes_.rarely(4) ? ~0u : bytes_.below(64);
  row.fast_distance = bytes_.number(0.0f, 0.0f, 4.0f);
  row.unlit_sets = sets();
  row.clear_sets = sets();
  row.flags |= flag() ? LANCER_INSTANCE_CATCHER : 0;
}

void Records::widen(lancer_light &light) {
  if (!wide_)
    return;
  light.light_group = group();
  light.lit_surfaces = bytes_.rarely(40) ? bytes_.below(4) : 0;
  light.no_catchers = flag(40);
  light.unlit_sets = sets();
  light.clear_sets = sets();
}

void Records::widen(lancer_camera &camera) {
  if (!wide_)
    return;
  for (double *matrix : {camera.matrix_before, camera.matrix_after})
    if (flag(60))
      this->matrix(matrix, 6.0);
  for (double *window : {camera.window_before, camera.window_after})
    for (int i = 0; i < 4; ++i)
      window[i] = flag(10) ? bytes_.number(0.5, -2.0, 2.0) : camera.window[i];
  if (!flag(30))
    return;
  camera.eye_offset = bytes_.number(0.1, -1.0, 1.0);
  camera.convergence_distance = bytes_.number(0.0, 0.0, 4.0);
  camera.pole_merge_from = bytes_.number(0.0, 0.0, 1.5);
  camera.pole_merge_to = bytes_.number(0.0, 0.0, 1.6);
}

void Records::widen(lancer_settings &settings) {
  if (!wide_)
    return;
  settings.mattes = bytes_.rarely(2) ? 8 : bytes_.below(8);
  for (uint32_t *count : {&settings.light_groups, &settings.aov_colors, &settings.aov_values})
    *count = bytes_.rarely(4) ? 1023 + bytes_.below(3) : bytes_.below(kMostGroups);
  settings.catchers = bytes_.choice(3);
  settings.fast_bounces = bytes_.rarely(40) ? bytes_.below(4) : 0;
  settings.fast_factor = bytes_.number(1.0f, 0.0f, 2.0f);
  settings.fast_distance = bytes_.number(0.0f, 0.0f, 4.0f);
  settings.ambient = bytes_.number(0.0f, 0.0f, 2.0f);
  settings.sky_vectors = flag();
}

} // namespace lancer_fuzz
