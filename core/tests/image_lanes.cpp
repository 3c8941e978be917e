// Image lookups in lanes, of the environment and on surfaces: each lane has the bits of a single lookup.
#include "integrator/stages/light.h"
#include "lights/environment.h"
#include "nodes/image.h"
#include "nodes_lab.h"

#include <cstring>
#include <random>

namespace lancer_test {
namespace {

using Random = std::mt19937;

// Storage of texels.
struct Form {
  uint32_t kind, channels, transfer, alpha;
};
constexpr uint32_t kKinds[] = {LANCER_TEXEL_U8, LANCER_TEXEL_U16, LANCER_TEXEL_FLOAT}, kChannels[] = {1, 3, 4};

// Floats are also above 1 and negative, unless unit limits them to 0 ... 1.
Image random_image(Random &random, uint32_t width, uint32_t height, bool matrix, const Form &form, bool unit = false) {
  std::vector<uint8_t> bytes(size_t(width) * height * form.channels);
  std::vector<uint16_t> words(bytes.size());
  std::vector<float> floats(bytes.size());
  for (size_t i = 0; i < bytes.size(); ++i) {
    // White often, where sums of weights round to more than 1.
    words[i] = uint16_t(random() % 3 ? random() : 65535);
    bytes[i] = uint8_t(words[i]);
    floats[i] = float(words[i]) / (unit || random() % 5 ? 65535.0f : -100.0f);
  }
  lancer_image image = form.kind == LANCER_TEXEL_U8    ? image_of(bytes, width, height, form.channels)
                       : form.kind == LANCER_TEXEL_U16 ? image_of(words, width, height, form.channels)
                                                       : image_of(floats, width, height, form.channels);
  image.transfer = form.transfer;
  image.alpha = form.alpha;
  for (int i = 0; i < 9; ++i)
    image.matrix[i] = matrix ? float(random() % 1000) / 500.0f - 0.5f : i % 4 == 0 ? 1.0f : 0.0f;
  return kept_image(image);
}

// Compares lookups at random coordinates, at and beside texel centres and borders, and at coordinates that are not finite.
void expect_looks(Random &random, const Image &image, uint32_t flags) {
  std::uniform_real_distribution<float> somewhere(-3.0f, 4.0f);
  const float special[] = {0.5f / float(image.height), 1.0f, 0.0f, -1e-9f, 1e30f, NAN, INFINITY, 1.0f - 0x1p-24f};
  // Image coordinates as world positions.
  Program program;
  Node place, look;
  place.kind = LANCER_NODE_COORDINATE;
  place.option = LANCER_COORDINATE_POSITION;
  look.kind = LANCER_NODE_IMAGE;
  look.option = LANCER_PROJECT_FLAT;
  look.flags = flags;
  look.image_count = 1;
  look.inputs[0].node = 0;
  program.nodes = {place, look};
  program.images = {image};
  NodeBlock block{};
  block.surface = false;
  block.used = random() & 0xffff;
  for (int lane = 0; lane < kBlockLanes; ++lane) {
    block.p[0][lane] = double(somewhere(random));
    block.p[1][lane] = double(random() % 2 ? somewhere(random) : special[random() % 8]);
  }
  NodeLanes values[2];
  node_kernel().run(program, Schedule{0, 1}, block, values);
  const auto extension = static_cast<Extension>(flags & 0xf);
  for (int lane = 0; lane < kBlockLanes; ++lane) {
    if (!(block.used >> lane & 1))
      continue;
    const glm::vec2 uv(float(block.p[0][lane]), float(block.p[1][lane]));
    const glm::vec4 want = lookup(image, uv, extension, Interpolation::Linear, flags & 256);
    ASSERT_EQ(lookup_alpha(image, uv, extension, Interpolation::Linear), want.w);
    for (int k = 0; k < 4; ++k)
      ASSERT_EQ(values[1].of[k][lane], want[k]) << uv.x << " " << uv.y;
  }
}

TEST(ImageLanes, LookUpsAreThoseOfOnePlace) {
  Random random(11);
  // Every storage, and every lookup mode.
  for (const uint32_t kind : kKinds)
    for (const uint32_t channels : kChannels)
      for (const uint32_t transfer : {LANCER_TRANSFER_LINEAR, LANCER_TRANSFER_SRGB})
        for (const uint32_t alpha_mode :
             {LANCER_ALPHA_NONE, LANCER_ALPHA_STRAIGHT, LANCER_ALPHA_ASSOCIATED, LANCER_ALPHA_CHANNEL_PACKED})
          for (int look = 0; look < 64; ++look) {
            const Form form{kind, channels, transfer, alpha_mode};
            const bool straight = look & 1, matrix = look & 4, unit = look & 16;
            const Extension extensions[] = {Extension::Extend, Extension::Repeat, Extension::Clip, Extension::Mirror};
            const Extension extension = extensions[(look >> 3 & 1) + (look >> 4 & 2)];
            SCOPED_TRACE(testing::Message() << kind << " " << channels << " " << transfer << " " << alpha_mode << " " << look);
            const Image image = random_image(random, 1 + random() % 37, 1 + random() % 37, matrix, form, unit);
            for (int i = 0; i < 30; ++i)
              ASSERT_NO_FATAL_FAILURE(expect_looks(random, image, uint32_t(extension) | (straight ? 256u : 0u)));
          }
}

// An environment image, rotated or not, times a colour or not.
struct Sky {
  World world;
  Normalisation normalisation;

  Sky(Random &random, bool mapped, bool multiplied, bool maximum) {
    const uint32_t kind = kKinds[random() % 3], channels = kChannels[random() % 3];
    const bool curve = kind != LANCER_TEXEL_FLOAT && random() % 2;
    hold(world.program,
         random_image(random, 2 * (4 + random() % 60), 4 + random() % 60, false,
                      {kind, channels, uint32_t(curve ? LANCER_TRANSFER_SRGB : LANCER_TRANSFER_LINEAR), LANCER_ALPHA_NONE}));
    Node direction, mapping, environment, product;
    direction.kind = LANCER_NODE_COORDINATE;
    direction.option = random() % 2 ? LANCER_COORDINATE_GENERATED : LANCER_COORDINATE_POSITION;
    mapping.kind = LANCER_NODE_MAPPING;
    mapping.option = random() % 2 ? LANCER_MAPPING_POINT : LANCER_MAPPING_VECTOR;
    mapping.inputs[0].node = 0;
    mapping.inputs[1].value = {0.1f, -0.2f, 0.05f};
    mapping.inputs[2].value = {0.4f, 1.1f, -2.0f};
    mapping.inputs[3].value = {1.0f, random() % 4 ? 0.8f : 0.0f, 1.2f};
    environment.kind = LANCER_NODE_ENVIRONMENT;
    environment.image_count = 1;
    environment.inputs[0].node = mapped ? 1 : 0;
    product.kind = LANCER_NODE_VECTOR_MATH;
    product.option = maximum ? LANCER_VECTOR_MAXIMUM : LANCER_VECTOR_MULTIPLY;
    product.inputs[0].node = 2;
    product.inputs[1].value = {0.5f, 2.0f, 0.25f};
    if (random() % 2)
      std::swap(product.inputs[0], product.inputs[1]);
    world.program.nodes = {direction, mapping, environment, product};
    world.radiance.node = multiplied ? 3 : 2;
    world.schedule = world.program.schedule(std::span(&world.radiance, 1));
    world.map_resolution = random() % 2 ? 0 : 4 + random() % 300;
  }
};

TEST(SkyLanes, TheSkyIsThatOfOneDirection) {
  Random random(3);
  std::normal_distribution<double> normal;
  for (int round = 0; round < 60; ++round) {
    const Sky sky(random, random() % 2, random() % 2, random() % 2);
    const Environment environment(sky.world, sky.normalisation, BuildContext{.threads = 1}, true);
    std::vector<glm::vec4> values(4);
    for (int i = 0; i < 400; ++i) {
      const bool transmits = i % 2;
      SkyBlock samples{}, seen{};
      NodeBlock nodes{};
      nodes.scene.normalisation = &sky.normalisation;
      nodes.surface = false;
      nodes.used = 0xffff;
      for (int lane = 0; lane < kBlockLanes; ++lane) {
        samples.u[0][lane] = float(random() >> 8) * 0x1p-24f;
        samples.u[1][lane] = random() % 8 ? float(random() >> 8) * 0x1p-24f : float(random() % 3) * 0x1p-24f;
        glm::dvec3 d(normal(random), normal(random), normal(random));
        // Poles, the horizon, the seam.
        if (random() % 4 == 0)
          d[int(random() % 3)] = 0.0;
        if (random() % 4 == 0)
          d[int(random() % 3)] *= 1e-9;
        d = glm::normalize(d);
        for (int axis = 0; axis < 3; ++axis) {
          seen.wi[axis][lane] = d[axis];
          nodes.p[axis][lane] = double(float(d[axis]));
          nodes.wo[axis][lane] = nodes.ns[axis][lane] = nodes.ng[axis][lane] = -float(d[axis]);
        }
      }
      light_kernel().sample_sky(environment.table(transmits), samples);
      light_kernel().sky_density(environment.table(transmits), seen);
      NodeLanes of_nodes[4];
      node_kernel().run(sky.world.program, sky.world.schedule, nodes, of_nodes);
      for (int lane = 0; lane < kBlockLanes; ++lane) {
        const glm::dvec3 wi(seen.wi[0][lane], seen.wi[1][lane], seen.wi[2][lane]);
        ASSERT_EQ(seen.pdf[lane], environment.pdf(wi, transmits)) << wi.x << " " << wi.y << " " << wi.z;
        const glm::vec3 radiance = environment.radiance(wi, values, nullptr);
        const LightSample sample = environment.sample({samples.u[0][lane], samples.u[1][lane]}, values, nullptr, transmits);
        ASSERT_EQ(samples.pdf[lane], sample.pdf);
        for (int axis = 0; axis < 3; ++axis) {
          ASSERT_EQ(of_nodes[sky.world.radiance.node].of[axis][lane], radiance[axis]);
          ASSERT_EQ(samples.wi[axis][lane], sample.wi[axis]);
        }
      }
    }
  }
}

} // namespace
} // namespace lancer_test
