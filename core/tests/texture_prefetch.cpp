// Prefetching of texels before their lookup: which texels, and no other effect.
#include "nodes_lab.h"
#include "tiny_scene.h"

#include "compile/scene.h"
#include "integrator/sample.h"
#include "integrator/stages/texture_prefetch.h"
#include "nodes/image.h"
#include "scene/surface.h"

#include <cmath>
#include <limits>

namespace lancer_test {
namespace {

// Four megabytes are large enough for prefetching.
constexpr uint32_t kSide = 1024;
// Flags of image nodes.
constexpr uint32_t kLinear = LANCER_INTERPOLATE_LINEAR << 4;

enum class Thing { Outside, Wild, NoNumbers, WithoutUvs, Named, Sphere, WithoutSlot, OfAnotherMaterial, OfTheOtherSlot, Count };
constexpr uint32_t kThings = uint32_t(Thing::Count);

// Bytes without a pattern.
void add_picture(Description &description, uint32_t side) {
  std::vector<uint8_t> texels(size_t(side) * side * 4);
  uint32_t state = 1;
  for (uint8_t &texel : texels)
    texel = uint8_t((state = state * 1664525u + 1013904223u) >> 24);
  lancer_image image = image_of(texels, side, side);
  image.alpha = LANCER_ALPHA_NONE;
  add_image(description, image);
}

// A white material with the image as colour. by_hand: the UV map is multiplied by 1, so that the place of the lookup is
// unknown.
void add_painted(Description &description, Extension extension, bool by_hand, const char *uv_map = "") {
  std::vector<lancer_node> nodes = {named(node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_UV), uv_map)};
  if (by_hand)
    nodes.push_back(node(LANCER_NODE_VECTOR_MATH, LANCER_VECTOR_MULTIPLY, {result_of(0), constant(1.0f)}));
  const int32_t last = int32_t(nodes.size()) - 1;
  lancer_node look = flagged(node(LANCER_NODE_IMAGE, LANCER_PROJECT_FLAT, {result_of(last)}), uint32_t(extension) | kLinear);
  look.image_count = 1;
  nodes.push_back(look);
  lancer_lobe white = lobe(LANCER_LAMBERT, 1.0f);
  white.color = result_of(last + 1);
  lancer_material material = black();
  material.name = "painted";
  material.lobes = &white;
  material.lobe_count = 1;
  material.nodes = nodes.data();
  material.node_count = uint32_t(nodes.size());
  add_material(description, material);
}

// Two triangles over -1 ... 1 with these texture coordinates at their corners.
void add_quad(Description &description, const std::vector<glm::vec2> &uvs, const char *attribute_name = nullptr) {
  const float positions[] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
  const uint32_t triangles[] = {0, 1, 2, 0, 2, 3};
  const uint16_t slots[] = {0, 1};
  lancer_mesh mesh = {};
  mesh.name = "quad";
  mesh.positions = positions;
  mesh.triangles = triangles;
  mesh.material_slots = slots;
  mesh.vertex_count = 4;
  mesh.triangle_count = 2;
  lancer_attribute attribute = {};
  if (attribute_name) {
    attribute.name = attribute_name;
    attribute.domain = LANCER_DOMAIN_CORNER;
    attribute.channels = 2;
    attribute.values = &uvs[0].x;
    mesh.attributes = &attribute;
    mesh.attribute_count = 1;
  } else if (!uvs.empty()) {
    mesh.uvs = &uvs[0].x;
  }
  add_mesh(description, mesh);
}

// All objects in a row, 3 apart, under a white sky.
std::shared_ptr<const Scene> row(Extension extension, bool by_hand, uint32_t side = kSide) {
  Description description;
  add_picture(description, side);
  // Materials 0 and 1 have the image, 2 has none.
  add_painted(description, extension, by_hand);
  add_painted(description, extension, by_hand, "map");
  lancer_lobe grey = lobe(LANCER_LAMBERT, 0.5f);
  lancer_material plain = black();
  plain.name = "plain";
  plain.lobes = &grey;
  plain.lobe_count = 1;
  add_material(description, plain);

  constexpr float nan = std::numeric_limits<float>::quiet_NaN(), most = std::numeric_limits<float>::max();
  const std::vector<glm::vec2> outside = {{-2.3f, -1.6f}, {3.1f, -1.2f}, {2.7f, 4.4f},
                                          {-2.3f, -1.6f}, {2.7f, 4.4f},  {-2.9f, 3.8f}};
  add_quad(description, outside);
  add_quad(description, {{1e30f, -1e30f}, {-1e30f, 1e30f}, {1e-30f, most}, {-1e-9f, 1.0f}, {8e6f, -8e6f}, {-most, most}});
  add_quad(description, outside);
  add_quad(description, {});
  add_quad(description, outside, "map");
  // Checked meshes have no NaN; coordinates from computations may be NaN.
  Mesh without_numbers = *description.meshes[uint32_t(Thing::NoNumbers)];
  for (glm::vec2 &uv : without_numbers.uvs)
    uv = {nan, INFINITY};
  description.meshes[uint32_t(Thing::NoNumbers)] = Given<Mesh>(std::move(without_numbers));

  // The last object's second triangle has a material of its own; the slots of each other object share one.
  const uint32_t slots[] = {0, 1, 2, 2, 0};
  std::vector<lancer_instance> instances(kThings);
  for (uint32_t i = 0; i < kThings; ++i) {
    place(instances[i].matrix, 3.0 * i, 0.0, 0.0);
    instances[i].kind = i == uint32_t(Thing::Sphere) ? LANCER_SPHERE : LANCER_MESH;
    instances[i].mesh = i <= uint32_t(Thing::Named) ? i : 0;
    instances[i].slot_count = 1;
  }
  instances[uint32_t(Thing::Named)].first_slot = 1;
  instances[uint32_t(Thing::WithoutSlot)].slot_count = 0;
  instances[uint32_t(Thing::OfAnotherMaterial)].first_slot = 2;
  instances[uint32_t(Thing::OfTheOtherSlot)].first_slot = 3;
  instances[uint32_t(Thing::OfTheOtherSlot)].slot_count = 2;
  add_instances(description, kThings, instances.data(), uint32_t(std::size(slots)), slots, nullptr, 0);
  description.world = constant_sky(glm::vec3(1.0f));
  return commit(std::move(description), AcceleratorKind::Bvh, {});
}

// Looks straight down at this many pixels of each object, in world units.
Camera above(uint32_t pixels) {
  Camera camera;
  camera.kind = CameraKind::Orthographic;
  camera.to_world.translation = {0.0, 0.0, 4.0};
  camera.width = camera.region_width = kThings * pixels;
  camera.height = camera.region_height = pixels;
  camera.left = camera.bottom = -1.5;
  camera.right = 3.0 * kThings - 1.5;
  camera.top = 1.5;
  camera.clip_end = 10.0;
  return camera;
}

constexpr Extension kExtensions[] = {Extension::Repeat, Extension::Extend, Extension::Clip, Extension::Mirror};

TEST(TexturePrefetch, AsksForWhatShadingLooksUp) {
  for (const Extension extension : kExtensions) {
    const auto scene = row(extension, false);
    const TexturePrefetch textures(*scene);
    for (uint32_t instance = 0; instance < kThings; ++instance)
      for (const uint32_t triangle : {0u, 1u}) {
        const Thing thing = static_cast<Thing>(instance);
        if (thing == Thing::Sphere && triangle > 0)
          continue;
        const Hit hit{.t = 1.0, .u = 0.25, .v = 0.5, .instance = instance, .primitive = triangle};
        const ComingLookup next = textures.coming(hit);
        SCOPED_TRACE(testing::Message() << "thing " << instance << ", triangle " << triangle);
        const bool known = instance <= uint32_t(Thing::NoNumbers) || thing == Thing::Named ||
                           (thing == Thing::OfTheOtherSlot && triangle == 1);
        ASSERT_EQ(next.image != nullptr, known);
        if (!known)
          continue;
        EXPECT_EQ(next.image->texels, scene->images[0]->texels);
        EXPECT_EQ(next.extension, extension);
        // Weights of a quarter and a half, of corners 0 1 2 and 0 2 3.
        const MeshView &mesh = scene->geometry.meshes[scene->geometry.instances[instance].mesh];
        const std::span<const glm::vec2> uvs = scene->geometry.meshes[0].uvs;
        const glm::vec2 *uv = (thing == Thing::Named ? uvs : mesh.uvs).data() + 3 * triangle;
        const glm::vec2 expected = 0.25f * uv[0] + 0.25f * uv[1] + 0.5f * uv[2];
        if (thing == Thing::NoNumbers)
          EXPECT_TRUE(std::isnan(next.uv.x) && !std::isfinite(next.uv.y));
        else
          EXPECT_EQ(next.uv, expected);
      }
  }
}

TEST(TexturePrefetch, AsksForNothingElse) {
  for (const auto &[by_hand, side] : {std::pair(true, kSide), {false, kSide - 1}}) {
    const auto scene = row(Extension::Repeat, by_hand, side);
    const TexturePrefetch textures(*scene);
    for (uint32_t instance = 0; instance < kThings; ++instance)
      EXPECT_EQ(textures.coming({.t = 1.0, .instance = instance, .primitive = 0}).image, nullptr) << instance;
  }
}

TEST(TexturePrefetch, ChangesNoPicture) {
  constexpr uint32_t kPixels = 16;
  const auto picture = [](Extension extension, bool by_hand) {
    const auto scene = row(extension, by_hand);
    Camera camera = above(kPixels);
    camera.to_world = scene->normalisation.to_normalised(camera.to_world);
    camera.to_world.linear = glm::dmat3(1.0);
    camera.scale_lengths(scene->normalisation.scale);
    IntegratorSettings settings;
    settings.max_bounces = 2;
    const auto integrator = make_integrator(*scene, camera, settings);
    std::vector<SampleAddress> addresses;
    for (uint32_t y = 0; y < camera.height; ++y)
      for (uint32_t x = 0; x < camera.width; ++x)
        addresses.push_back({x, y, 0});
    std::vector<SampleResult> results(addresses.size());
    integrator->run(addresses, results, nullptr);
    std::vector<glm::vec3> radiance;
    for (const SampleResult &result : results)
      radiance.push_back(result.radiance);
    return radiance;
  };
  std::vector<std::vector<glm::vec3>> seen;
  for (const Extension extension : kExtensions) {
    seen.push_back(picture(extension, false));
    EXPECT_EQ(seen.back(), picture(extension, true)) << uint32_t(extension);
  }
  // The pictures are not empty.
  EXPECT_NE(seen[0], seen[1]);
  EXPECT_NE(seen[1], seen[2]);
  EXPECT_NE(seen[2], seen[3]);
}

TEST(TexturePrefetch, TakesAnyPlaceOfAnyPicture) {
  // Images of every depth and shape, down to one texel.
  for (const uint32_t kind : {LANCER_TEXEL_U8, LANCER_TEXEL_U16, LANCER_TEXEL_FLOAT})
    for (const uint32_t channels : {1u, 3u, 4u})
      for (const auto &[width, height] : {std::pair(1u, 1u), {1u, 7u}, {5u, 1u}, {64u, 3u}}) {
        const std::vector<float> texels(size_t(width) * height * channels, 0.5f);
        lancer_image image = image_of(texels, width, height, channels);
        image.kind = kind;
        const Image asked = kept_image(image);
        constexpr float most = std::numeric_limits<float>::max(), least = std::numeric_limits<float>::denorm_min();
        const float places[] = {0.0f,  -0.0f, 0.5f,   1.0f, -least, least, 1.0f - 0x1p-24f, -1e-9f,   8e6f,
                                -8e6f, 1e30f, -1e30f, most, -most,  NAN,   INFINITY,        -INFINITY};
        for (const Extension extension : kExtensions)
          for (const float u : places)
            for (const float v : places) {
              prefetch(asked, {u, v}, extension);
              // The same texels, all of them in memory and between 0 and 1.
              const float level = lookup(asked, {u, v}, extension, Interpolation::Linear, false).x;
              EXPECT_TRUE(level >= 0.0f && level <= 1.0f) << u << " " << v;
            }
      }
}

} // namespace
} // namespace lancer_test
