#include "records.h"

#include <algorithm>
#include <cmath>
#include <new>

namespace lancer_fuzz {

namespace {

constexpr uint32_t kMostVertices = 12, kMostTriangles = 20, kMostInstances = 6;
constexpr uint32_t kMostSide = 8; // of images
constexpr uint32_t kWideSide = 5; // of those images that become wide
const char *const kNames[] = {"thing", "", "UVMap", "generated", "tangent:", "tangent:UVMap", "\xff\xfe%s%n", nullptr};

} // namespace

const char *Records::name() {
  const uint32_t which = bytes_.below(uint32_t(std::size(kNames)) + 1);
  if (which < std::size(kNames))
    return kNames[which];
  // Longer than the space for text in a message.
  std::vector<char> text(2000, 'x');
  text.push_back('\0');
  return keep(std::move(text));
}

void Records::matrix(double rows[12], double away) {
  std::fill(rows, rows + 12, 0.0);
  const uint32_t kind = bytes_.below(8);
  const double scale = bytes_.number(1.0, 0.2, 3.0);
  for (int i = 0; i < 3; ++i)
    rows[5 * i] = scale;
  if (kind >= 4) // rotated about x, like objects that face along -z
    rows[5] = rows[10] = 0.0, rows[6] = -scale, rows[9] = scale;
  if (kind == 3)
    rows[0] = -rows[0];
  if (kind == 7)
    for (int i = 0; i < 12; ++i)
      rows[i] = bytes_.number(rows[i], -2.0, 2.0);
  for (int i = 0; i < 3; ++i)
    rows[4 * i + 3] = bytes_.number(i == 2 ? away : 0.0, -4.0, 4.0);
}

float *Records::floats(size_t count, float low, float high) {
  std::vector<float> values(count);
  for (size_t i = 0; i < count; ++i)
    values[i] = bytes_.any() ? bytes_.number(0.5f, low, high) : 0.3f + 0.1f * float(i * 7 % 5);
  return keep(std::move(values));
}

lancer_attribute Records::attribute(uint32_t vertices, uint32_t triangles) {
  lancer_attribute attribute = {};
  attribute.name = name();
  attribute.domain = bytes_.choice(3);
  attribute.channels = 1 + bytes_.choice(4);
  attribute.values = bytes_.rarely(3) ? nullptr : floats(4 * size_t(std::max(vertices, 3 * triangles)), -1.0f, 1.0f);
  return attribute;
}

lancer_mesh Records::mesh() {
  lancer_mesh mesh = {};
  mesh.name = name();
  mesh.vertex_count = bytes_.below(kMostVertices + 1);
  mesh.triangle_count = bytes_.below(kMostTriangles + 1);
  mesh.positions = floats(3 * size_t(mesh.vertex_count), -1.5f, 1.5f);
  std::vector<uint32_t> triangles(3 * size_t(mesh.triangle_count));
  for (size_t i = 0; i < triangles.size(); ++i)
    triangles[i] = bytes_.any() ? bytes_.reference(mesh.vertex_count) : uint32_t((i / 3 + i % 3) % (mesh.vertex_count + 1));
  mesh.triangles = keep(std::move(triangles));
  const uint32_t corners = 3 * mesh.triangle_count, most = std::max(corners, mesh.vertex_count);
  mesh.normal_domain = bytes_.rarely(130) ? bytes_.choice(3) : 0u;
  mesh.normals = mesh.normal_domain && !bytes_.rarely(4) ? floats(3 * size_t(most), -1.0f, 1.0f) : nullptr;
  mesh.uvs = flag(130) ? floats(2 * size_t(corners), -1.0f, 2.0f) : nullptr;
  mesh.colors = flag() ? floats(3 * size_t(corners), 0.0f, 1.0f) : nullptr;
  if (flag()) {
    std::vector<uint16_t> slots(mesh.triangle_count);
    for (uint16_t &slot : slots)
      slot = uint16_t(bytes_.reference(3));
    mesh.material_slots = keep(std::move(slots));
    // Pairs of triangles are polygons, and sometimes one is out of range; this reads no bytes.
    std::vector<uint32_t> polygons(mesh.triangle_count);
    for (uint32_t i = 0; i < mesh.triangle_count; ++i)
      polygons[i] = (i + mesh.triangle_count % 2) / 2 + (mesh.vertex_count == 1 ? mesh.triangle_count : 0);
    mesh.polygons = keep(std::move(polygons));
  }
  std::vector<lancer_attribute> attributes(bytes_.rarely(80) ? bytes_.below(4) : 0);
  for (lancer_attribute &attribute : attributes)
    attribute = this->attribute(mesh.vertex_count, mesh.triangle_count);
  mesh.attribute_count = uint32_t(attributes.size());
  mesh.attributes = keep(std::move(attributes));
  // Missing arrays.
  if (bytes_.rarely(2))
    mesh.positions = nullptr;
  if (bytes_.rarely(2))
    mesh.triangles = nullptr;
  if (bytes_.rarely(2))
    mesh.attributes = nullptr;
  widen(mesh);
  return mesh;
}

lancer_image Records::image() {
  lancer_image image = {};
  image.name = name();
  image.width = 1 + bytes_.below(kMostSide);
  image.height = 1 + bytes_.below(kMostSide);
  const uint32_t channels = bytes_.choice(4);
  image.channels = channels == 1 ? 4 : channels;
  image.kind = bytes_.choice(3);
  image.transfer = bytes_.choice(2);
  image.alpha = bytes_.choice(4);
  image.tile = bytes_.rarely(60) ? 1001 + bytes_.below(25) : bytes_.rarely(4) ? ~0u : 0u;
  // The bytes of floats are valid texels of the other kinds, too.
  image.texels = bytes_.rarely(2) ? nullptr : floats(size_t(image.width) * image.height * 4, 0.0f, 1.0f);
  if (image.texels && image.width == kWideSide)
    make_wide(image);
  for (int i = 0; i < 9; ++i)
    image.matrix[i] = i % 4 == 0 ? 1.0f : 0.0f;
  if (flag(20))
    for (float &value : image.matrix)
      value = bytes_.number(0.5f, -1.0f, 1.0f);
  // A size beyond any memory: rejected before the texels are read.
  if (bytes_.rarely(2))
    image.width = image.height = 1u << (19 + bytes_.below(13));
  else if (image.texels && image.channels <= 4 && bytes_.rarely(40) && !image.mipmaps)
    make_blocks(image);
  return image;
}

// Repeats the texels along one row, so that the image has levels.
void Records::make_wide(lancer_image &image) {
  constexpr uint32_t kTimes = 40;
  const size_t given = size_t(image.width) * image.height * 4;
  std::vector<float> texels(given * kTimes);
  for (size_t i = 0; i < texels.size(); ++i)
    texels[i] = static_cast<const float *>(image.texels)[i % given];
  image.texels = keep(std::move(texels));
  image.width *= image.height * kTimes;
  image.height = image.mipmaps = 1;
}

// Replaces the texels by blocks, with no byte more than the library may read.
void Records::make_blocks(lancer_image &image) {
  constexpr size_t kSide = 64, kAlignment = 64, kReadBeyond = 3;
  static_assert(kMostSide <= kSide);
  image.layout = 1 + bytes_.choice(1);
  image.gaps = bytes_.below(3);
  const size_t channel = image.kind == LANCER_TEXEL_U8 ? 1 : image.kind == LANCER_TEXEL_U16 ? 2 : 4;
  const size_t size = kSide * kSide * image.channels * channel + kReadBeyond, given = size_t(image.width) * image.height * 4;
  const auto free = [](std::byte *blocks) { ::operator delete(blocks, std::align_val_t(kAlignment)); };
  const std::shared_ptr<std::byte> blocks(static_cast<std::byte *>(::operator new(size, std::align_val_t(kAlignment))), free);
  for (size_t i = 0; i < size; ++i)
    blocks.get()[i] = static_cast<const std::byte *>(image.texels)[i % (given * sizeof(float))];
  kept_.push_back(blocks);
  image.texels = blocks.get() + (bytes_.rarely(10) ? 1 : 0);
}

lancer_light Records::light(const Filled &filled) {
  lancer_light light = {};
  light.name = name();
  matrix(light.matrix, 3.0);
  light.kind = bytes_.choice(4);
  const float power = bytes_.number(10.0f, 0.0f, 50.0f);
  for (int i = 0; i < 3; ++i) {
    light.emission[i] = power;
    light.ambient_color[i] = light.diffuse_color[i] = light.specular_color[i] = bytes_.number(1.0f, 0.0f, 1.0f);
  }
  light.radius = bytes_.number(0.1f, 0.0f, 2.0f);
  light.soft_falloff = flag(128);
  light.spot_angle = bytes_.number(1.0f, 0.0f, 4.0f);
  light.spot_blend = bytes_.number(0.2f, 0.0f, 1.0f);
  light.spot_cosine = flag();
  light.sun_angle = bytes_.number(0.01f, 0.0f, 4.0f);
  light.sun_flat = flag();
  light.size[0] = bytes_.number(1.0f, 0.0f, 4.0f);
  light.size[1] = bytes_.number(1.0f, 0.0f, 4.0f);
  light.shape = bytes_.choice(2);
  light.spread = bytes_.number(3.1415927f, 0.0f, 3.1415927f);
  light.hidden_from = hidden_from();
  light.no_shadow = flag();
  light.falloff = bytes_.choice(6);
  light.falloff_radius = bytes_.number(10.0f, 0.0f, 20.0f);
  light.node_count = nodes(filled, light.nodes);
  light.strength = parameter(1.0f, -1.0f, 2.0f);
  widen(light);
  node_count_ = 0;
  return light;
}

lancer_world Records::world(const Filled &filled) {
  lancer_world world = {};
  world.node_count = nodes(filled, world.nodes);
  world.hidden_from = hidden_from();
  world.radiance = parameter(0.5f);
  world.use_ambient = world.radiance.node < 0 && world.hidden_from & 1u;
  for (int i = 0; i < 3; ++i)
    world.ambient[i] = world.radiance.value[i];
  world.output_count = outputs(world.outputs);
  world.light_group = wide_ ? group() : 0;
  // A map of width 0, or of a large width, would take long if the radiance varies.
  world.map_resolution = bytes_.rarely(2) ? 65537 + bytes_.byte() : 1 + bytes_.below(32);
  node_count_ = 0;
  return world;
}

Records::Instances Records::instances(const Filled &filled) {
  Instances out;
  out.slots.resize(bytes_.below(4) + (filled.materials > 0));
  for (uint32_t &slot : out.slots)
    slot = bytes_.reference(filled.materials);
  out.rows.resize(1 + bytes_.below(kMostInstances));
  for (lancer_instance &row : out.rows) {
    row = {};
    matrix(row.matrix);
    row.kind = bytes_.choice(5);
    row.mesh = bytes_.reference(filled.meshes);
    if (filled.meshes == 0 && row.kind == LANCER_MESH && !bytes_.rarely(20))
      row.kind = LANCER_SPHERE;
    row.first_slot = out.slots.empty() ? 0 : bytes_.below(uint32_t(out.slots.size()));
    row.slot_count = out.slots.empty() ? 0 : 1 + bytes_.below(uint32_t(out.slots.size()) - row.first_slot);
    if (bytes_.rarely(2))
      row.slot_count = ~0u;
    row.object_index = bytes_.byte();
    row.shading = bytes_.choice(4);
    row.name = bytes_.rarely(2) ? ~0u : bytes_.below(8);
    row.hidden_from = hidden_from();
    row.flags = flag(20);
    row.terminator = bytes_.number(0.0f, 0.0f, 1.0f);
    widen(row);
  }
  out.names = bytes_.rarely(4) ? "no end" : "one\0two";
  out.names_size = bytes_.rarely(4) ? 6 : 8;
  if (out.names[2] == ' ')
    out.names_size = std::min<size_t>(out.names_size, 6);
  return out;
}

lancer_camera Records::camera() {
  lancer_camera camera = {};
  // From 6 above, downwards to the origin.
  for (int i = 0; i < 3; ++i)
    camera.matrix[5 * i] = 1.0;
  camera.matrix[11] = 6.0;
  if (bytes_.rarely(20))
    matrix(camera.matrix, 6.0);
  for (int i = 0; i < 3; ++i)
    if (bytes_.rarely(40))
      camera.matrix[4 * i + 3] = bytes_.number(0.0, -3.0, 8.0);
  camera.kind = bytes_.rarely(80) ? bytes_.choice(8) : 0u;
  camera.region_width = 1 + (bytes_.byte() + 5u) % 8;
  camera.region_height = 1 + (bytes_.byte() + 3u) % 8;
  camera.x = bytes_.rarely(20) ? bytes_.word() >> bytes_.below(32) : 0u;
  camera.y = bytes_.rarely(20) ? bytes_.word() >> bytes_.below(32) : 0u;
  camera.width = camera.x + camera.region_width + bytes_.below(2);
  camera.height = camera.y + camera.region_height;
  const double window[4] = {-0.4, 0.4, -0.4, 0.4}, whole[4] = {0.0, 1.0, 0.0, 1.0};
  std::copy_n(camera.kind < 2 ? window : whole, 4, camera.window);
  if (bytes_.rarely(20))
    for (double &edge : camera.window)
      edge = bytes_.number(0.5, -2.0, 2.0);
  const double panorama[8] = {3.0, 3.0, 36.0, 24.0, 1.0, 0.1, 0.1, 0.1}, globe[8] = {-1.5, 1.5, -3.1, 3.1, 1.0};
  const bool angles = camera.kind == LANCER_EQUIRECTANGULAR || camera.kind == LANCER_CYLINDRICAL;
  std::copy_n(angles ? globe : panorama, 8, camera.panorama);
  if (bytes_.rarely(40))
    for (double &value : camera.panorama)
      value = bytes_.number(value, -4.0, 40.0);
  camera.clip_start = bytes_.number(0.01, 0.0, 8.0);
  camera.clip_end = bytes_.number(1000.0, 1.0, 10.0);
  camera.lens_radius = bytes_.rarely(60) ? bytes_.number(0.1, 0.0, 1.0) : 0.0;
  camera.focal_distance = bytes_.number(6.0, 0.1, 10.0);
  camera.aperture_blades = bytes_.rarely(30) ? bytes_.choice(9) : 0u;
  camera.aperture_rotation = bytes_.number(0.0, -7.0, 7.0);
  camera.aperture_ratio = bytes_.number(1.0, 0.1, 3.0);
  widen(camera);
  return camera;
}

lancer_settings Records::settings() {
  lancer_settings settings = {};
  settings.integrator = bytes_.choice(3);
  settings.samples = bytes_.rarely(4) ? ~0u : 1 + bytes_.below(8);
  settings.seed = bytes_.byte();
  // The rays of CLASSIC double with every depth.
  settings.max_bounces = settings.integrator == LANCER_CLASSIC ? bytes_.below(4) : bytes_.below(12);
  if (bytes_.rarely(2))
    settings.max_bounces = 1025;
  for (uint32_t *limit : {&settings.diffuse_bounces, &settings.glossy_bounces, &settings.transmission_bounces})
    *limit = bytes_.rarely(20) ? bytes_.below(4) : 1024;
  settings.contribution_threshold = bytes_.number(0.0f, 0.0f, 1.0f);
  settings.clamp_indirect = bytes_.number(0.0f, 0.0f, 10.0f);
  settings.clamp_direct = bytes_.number(0.0f, 0.0f, 10.0f);
  settings.no_reflections = flag();
  settings.no_refractions = flag();
  settings.filter_glossy = bytes_.number(0.0f, 0.0f, 4.0f);
  settings.exposure = bytes_.number(1.0f, 0.0f, 4.0f);
  settings.pixel_filter = bytes_.choice(2);
  settings.filter_width = bytes_.number(1.5f, 0.1f, 4.0f);
  settings.film_transparent = flag();
  settings.transparent_glass = flag();
  settings.glass_roughness = bytes_.number(0.1f, 0.0f, 1.0f);
  settings.transparent_bounces = bytes_.rarely(4) ? 1025 : bytes_.below(16);
  settings.transparent_shadows = bytes_.rarely(4) ? ~0u : bytes_.below(16);
  settings.alpha_threshold = bytes_.number(0.5f, 0.0f, 1.0f);
  settings.environment_reflections = flag();
  settings.occlusion_distance = bytes_.number(0.0f, 0.0f, 4.0f);
  settings.mist_start = bytes_.number(1.0f, 0.0f, 8.0f);
  settings.mist_depth = bytes_.number(8.0f, 0.0f, 8.0f);
  settings.mist_falloff = bytes_.number(2.0f, 0.0f, 4.0f);
  settings.blended_features = flag();
  settings.features = bytes_.rarely(80) ? bytes_.choice(2) : 0u;
  settings.passes = bytes_.rarely(128) ? (1u << LANCER_PASS_COUNT) - 1 : 1u;
  if (bytes_.rarely(20))
    settings.passes = bytes_.word() >> (9 - bytes_.below(2));
  settings.threads = bytes_.rarely(2) ? 1025 : 1 + bytes_.below(2);
  settings.tile_size = bytes_.rarely(60) ? bytes_.choice(9) : 0u;
  settings.refines = bytes_.rarely(80) ? 1u : 0u;
  widen(settings);
  return settings;
}

} // namespace lancer_fuzz
