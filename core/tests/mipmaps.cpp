// Levels of images: what they average, which one a ray reads, and the same bits in lanes and in blocks.
#include "nodes_lab.h"

#include "nodes/image.h"
#include "nodes/mipmaps.h"
#include "widths/each_kernel.h"

#include <cmath>
#include <cstring>
#include <random>

namespace lancer_test {
namespace {

using Random = std::mt19937;

Image made(lancer_image image, uint32_t transfer = LANCER_TRANSFER_LINEAR) {
  image.mipmaps = 1;
  image.transfer = transfer;
  Image kept = kept_image(image);
  make_mipmaps(kept);
  return kept;
}

template <class Texel> const Texel *level_of(const Image &image, uint32_t level) {
  return reinterpret_cast<const Texel *>(image.texels + image.level_offset(level));
}
size_t texels_of(const Image &image, uint32_t level) {
  return size_t(level_side(image.width, level)) * level_side(image.height, level);
}

TEST(Mipmaps, EndWhereBothSidesFitABlock) {
  const auto levels = [](uint32_t width, uint32_t height) {
    const std::vector<uint8_t> texels(size_t(width) * height);
    return made(image_of(texels, width, height, 1)).levels;
  };
  EXPECT_EQ(levels(64, 64), 1u);
  EXPECT_EQ(levels(65, 1), 2u);
  EXPECT_EQ(levels(128, 127), 2u);
  EXPECT_EQ(levels(40, 1000), 5u);
}

// A constant stays what it is: the weights of its neighbours sum to 1 exactly, and 254 bytes of sRGB come back exactly.
TEST(Mipmaps, OfAConstant) {
  for (const uint32_t transfer : {LANCER_TRANSFER_LINEAR, LANCER_TRANSFER_SRGB})
    for (int value = 0; value < 256; ++value) {
      std::vector<uint8_t> texels(size_t(130) * 67 * 3, uint8_t(value));
      const Image image = made(image_of(texels, 130, 67, 3), transfer);
      ASSERT_EQ(image.levels, 3u);
      for (uint32_t level = 1; level < image.levels; ++level)
        for (size_t i = 0; i < 3 * texels_of(image, level); ++i)
          ASSERT_EQ(level_of<uint8_t>(image, level)[i], value) << "level " << level << ", transfer " << transfer;
    }
}

// Where all sides are even, each level keeps the mean: 4^4 texels round at 2^-24 each.
TEST(Mipmaps, KeepTheMean) {
  Random random(3);
  std::uniform_real_distribution<float> number(0.0f, 1.0f);
  std::vector<float> texels(size_t(512) * 256);
  double sum = 0.0;
  for (float &texel : texels)
    sum += double(texel = number(random));
  const Image image = made(image_of(texels, 512, 256, 1));
  ASSERT_EQ(image.levels, 4u);
  for (uint32_t level = 1; level < image.levels; ++level) {
    double of_level = 0.0;
    for (size_t i = 0; i < texels_of(image, level); ++i)
      of_level += double(level_of<float>(image, level)[i]);
    EXPECT_NEAR(of_level / double(texels_of(image, level)), sum / double(texels.size()), 4.0 * 0x1p-24);
  }
}

// A slope stays the slope, along odd sides, too: texel i of n stands for (i + 1/2) / n.
TEST(Mipmaps, OfASlope) {
  const uint32_t width = 333, height = 201;
  std::vector<float> texels;
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x)
      for (const float number : {(float(x) + 0.5f) / width, (float(y) + 0.5f) / height, 0.0f})
        texels.push_back(number);
  const Image image = made(image_of(texels, width, height, 3));
  for (uint32_t level = 1; level < image.levels; ++level) {
    const uint32_t across = level_side(width, level), up = level_side(height, level);
    for (uint32_t y = 0; y < up; ++y)
      for (uint32_t x = 0; x < across; ++x) {
        const float *texel = level_of<float>(image, level) + (size_t(y) * across + x) * 3;
        // A few roundings for each level.
        EXPECT_NEAR(texel[0], (float(x) + 0.5f) / float(across), 1e-6f);
        EXPECT_NEAR(texel[1], (float(y) + 0.5f) / float(up), 1e-6f);
      }
  }
}

// Stripes of dark and bright: bytes 64 and 192 of sRGB are 0.0513 and 0.5271 of the light, of whose mean the byte is 146. With
// alpha, colours count as much as their alpha.
TEST(Mipmaps, AverageLight) {
  std::vector<uint8_t> texels;
  for (int i = 0; i < 128 * 128; ++i)
    for (int c = 0; c < 3; ++c)
      texels.push_back(i % 2 ? 192 : 64);
  const Image stripes = made(image_of(texels, 128, 128, 3), LANCER_TRANSFER_SRGB);
  EXPECT_EQ(level_of<uint8_t>(stripes, 1)[0], 146);
  texels.clear();
  for (int i = 0; i < 128 * 128; ++i)
    for (const int number : {i % 2 ? 255 : 0, 0, 0, i % 2 ? 255 : 0})
      texels.push_back(uint8_t(number));
  const Image veil = made(image_of(texels, 128, 128, 4), LANCER_TRANSFER_SRGB);
  const uint8_t *texel = level_of<uint8_t>(veil, 1);
  // Red of half the alpha: its colour is divided by alpha before the curve, and multiplied after. 127.5 may round either way.
  EXPECT_NEAR(texel[0], 127.5, 0.5);
  EXPECT_EQ(texel[3], 128);
  // The same stripes of words: 146.41 of 255, as near as a word tells it.
  std::vector<uint16_t> words;
  for (int i = 0; i < 128 * 128; ++i)
    words.push_back(uint16_t(257 * (i % 2 ? 192 : 64)));
  const Image fine = made(image_of(words, 128, 128, 1), LANCER_TRANSFER_SRGB);
  EXPECT_NEAR(level_of<uint16_t>(fine, 1)[0] / 257.0, 146.41, 0.01);
}

// The mean light of any two bytes is the nearest byte of its curve; the float of the mean moves the curve by less than 1e-4.
TEST(Mipmaps, BytesAreTheNearestOfTheCurve) {
  const auto to_linear = [](double c) { return c < 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); };
  const auto to_srgb = [](double c) { return c < 0.0031308 ? c * 12.92 : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055; };
  // Column pairs of each row: the row's number and that of the pair.
  std::vector<uint8_t> texels;
  for (uint32_t y = 0; y < 256; ++y)
    for (uint32_t x = 0; x < 512; ++x)
      texels.push_back(uint8_t(x % 2 ? y & ~1u : x / 2));
  const Image image = made(image_of(texels, 512, 256, 1), LANCER_TRANSFER_SRGB);
  for (uint32_t y = 0; y < 128; ++y)
    for (uint32_t x = 0; x < 256; ++x) {
      const double mean = 0.5 * (to_linear(x / 255.0) + to_linear(2 * y / 255.0));
      EXPECT_NEAR(level_of<uint8_t>(image, 1)[y * 256 + x], 255.0 * to_srgb(mean), 0.5 + 1e-4);
    }
}

TEST(Mipmaps, TexelsThatAreNotFiniteAreBlack) {
  std::vector<float> texels(size_t(128) * 128 * 3, 1.0f);
  texels[1] = NAN;
  const Image image = made(image_of(texels, 128, 128, 3));
  for (int c = 0; c < 3; ++c)
    EXPECT_EQ(level_of<float>(image, 1)[c], 0.75f);
}

// An image each of whose levels has the level's number as its texels.
void add_numbered(Description &description, uint32_t width, uint32_t height) {
  const std::vector<float> texels(size_t(width) * height);
  lancer_image image = image_of(texels, width, height, 1);
  image.mipmaps = 1;
  Image numbered = kept_image(image);
  for (uint32_t level = 0; level < numbered.levels; ++level)
    std::fill_n(reinterpret_cast<float *>(numbered.memory.get() + numbered.level_offset(level)), texels_of(numbered, level),
                float(level));
  description.images.emplace_back(std::move(numbered));
}

lancer_node shown(int32_t where, uint32_t extension = LANCER_EXTEND_REPEAT) {
  lancer_node n = node(LANCER_NODE_IMAGE, LANCER_PROJECT_FLAT, {result_of(where)});
  n.flags = extension;
  n.image_count = 1;
  return n;
}

class MipmapLevels : public ::testing::Test {
protected:
  Stage stage;
  Random random{11};

  // The mean level over places of the triangle, whose edges of length 2 are the unit of its UV map.
  double mean_level(const std::vector<lancer_node> &nodes, float width) {
    const Program program = read_program(stage.description.images, "test", nodes.data(), uint32_t(nodes.size()));
    Parameter last;
    last.node = int32_t(nodes.size()) - 1;
    const Schedule schedule = program.schedule(std::span(&last, 1));
    std::vector<glm::vec4> values(program.value_count());
    const DescribedGeometry geometry(stage.description);
    std::uniform_real_distribution<double> place(0.1, 0.4);
    double sum = 0.0;
    const int count = 4000;
    for (int i = 0; i < count; ++i) {
      const Surface s = stage.surface(place(random), place(random));
      NodeContext context;
      context.geometry = &geometry;
      context.normalisation = &stage.normalisation;
      context.surface = &s;
      context.path.width = width;
      run(program, schedule, context, values);
      sum += double(values[nodes.size() - 1].x);
    }
    return sum / count;
  }
};

// Between -1/4 and 1/4 of a whole number, all rays read that level; from there to 3/4 the share of the next grows evenly. The
// mean of 4000 choices is within 4 standard deviations, 4 * 0.5 / sqrt(4000) = 0.032.
TEST_F(MipmapLevels, FollowTheWidth) {
  add_numbered(stage.description, 1024, 1024);
  const std::vector<lancer_node> nodes = {node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_UV), shown(0)};
  for (double exact = -2.0; exact < 6.0; exact += 0.125) {
    const double texels = std::exp2(exact), whole = std::floor(exact + 0.25), part = exact - whole;
    const double wanted = std::clamp(whole + (part > 0.25 ? 2.0 * (part - 0.25) : 0.0), 0.0, 4.0);
    EXPECT_NEAR(mean_level(nodes, float(2.0 * texels / 1024.0)), wanted, 0.032) << exact;
  }
}

// The smaller change decides, but not below a sixteenth of the larger one.
TEST_F(MipmapLevels, OfStretchedImages) {
  add_numbered(stage.description, 1024, 1024);
  const auto level = [&](float across, float up) {
    const lancer_node scaled =
        node(LANCER_NODE_VECTOR_MATH, LANCER_VECTOR_MULTIPLY, {result_of(0), constant(across, up, 1.0f)});
    return mean_level({node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_UV), scaled, shown(1)}, 2.0f / 1024.0f);
  };
  EXPECT_EQ(level(8.0f, 2.0f), 1.0);
  EXPECT_EQ(level(2.0f, 8.0f), 1.0);
  EXPECT_EQ(level(64.0f, 1.0f), 2.0);
  EXPECT_EQ(level(64.0f, 0.0f), 2.0);
}

// Numbers and steady nodes do not change from pixel to pixel.
TEST_F(MipmapLevels, OfWhatDoesNotChange) {
  add_numbered(stage.description, 1024, 1024);
  const lancer_node uv = node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_UV);
  const lancer_node doubled = node(LANCER_NODE_VECTOR_MATH, LANCER_VECTOR_MULTIPLY, {result_of(0), constant(2.0f)});
  EXPECT_EQ(mean_level({uv, doubled, shown(1)}, 0.1f), 4.0);
  EXPECT_EQ(mean_level({uv, flagged(doubled, LANCER_NODE_STEADY), shown(1)}, 0.1f), 0.0);
  const lancer_node math = node(LANCER_NODE_MATH, LANCER_MATH_MULTIPLY, {result_of(0), constant(2.0f)});
  EXPECT_EQ(mean_level({uv, math, shown(1)}, 0.1f), 0.0);
  EXPECT_EQ(mean_level({uv, shown(0)}, 0.0f), 0.0);
}

TEST_F(MipmapLevels, ClippedImagesEndAtTheirBorder) {
  const std::vector<float> texels(size_t(128) * 128, 1.0f);
  stage.description.images.emplace_back(made(image_of(texels, 128, 128, 1)));
  const auto at = [&](float u) {
    return stage.value(
        {node(LANCER_NODE_COMBINE, 0, {constant(u), constant(0.5f), constant(0.0f)}), shown(0, LANCER_EXTEND_CLIP)});
  };
  EXPECT_EQ(at(0.0f), glm::vec4(0.5f, 0.5f, 0.5f, 1.0f));
  EXPECT_EQ(at(-0x1p-20f), glm::vec4(0.0f));
  EXPECT_EQ(at(1.0f + 0x1p-20f), glm::vec4(0.0f));
}

// Chains of all nodes whose changes count, in each kernel, in rows and in blocks.
TEST_F(MipmapLevels, LanesAndBlocksHaveTheSameBits) {
  std::vector<uint8_t> texels(size_t(300) * 200 * 4);
  for (uint8_t &texel : texels)
    texel = uint8_t(random());
  std::vector<Given<Image>> rows, blocks;
  rows.emplace_back(made(image_of(texels, 300, 200, 4), LANCER_TRANSFER_SRGB));
  const Image &of_rows = *rows[0];
  // The same levels in blocks.
  Image of_blocks;
  of_blocks.width = 300, of_blocks.height = 200, of_blocks.levels = of_rows.levels;
  of_blocks.transfer = of_rows.transfer, of_blocks.alpha = of_rows.alpha;
  of_blocks.in_blocks = true;
  of_blocks.keep(allocate_texels(of_blocks.bytes()));
  for (uint32_t level = 0; level < of_rows.levels; ++level) {
    const uint32_t across = level_side(300, level), up = level_side(200, level);
    for (uint32_t y = 0; y < up; ++y)
      for (uint32_t x = 0; x < across; ++x) {
        const size_t block = size_t(y / 64) * blocks_along(across) + x / 64, inside = size_t(y % 64) * 64 + x % 64;
        std::memcpy(of_blocks.memory.get() + of_blocks.level_offset(level) + (block * 64 * 64 + inside) * 4,
                    of_rows.texels + of_rows.level_offset(level) + (size_t(y) * across + x) * 4, 4);
      }
  }
  blocks.emplace_back(std::move(of_blocks));
  const DescribedGeometry geometry(stage.description);
  std::uniform_real_distribution<float> number(-3.0f, 3.0f), width(0.0f, 0.5f);
  const auto any = [&] { return constant(number(random), number(random), number(random)); };
  const uint32_t places[] = {LANCER_COORDINATE_UV,         LANCER_COORDINATE_OBJECT,   LANCER_COORDINATE_GENERATED,
                             LANCER_COORDINATE_NORMAL,     LANCER_COORDINATE_POSITION, LANCER_COORDINATE_REFLECTION,
                             LANCER_COORDINATE_PARAMETRIC, LANCER_COORDINATE_INCOMING, LANCER_COORDINATE_WINDOW};
  for (int round = 0; round < 600; ++round) {
    std::vector<lancer_node> nodes = {node(LANCER_NODE_COORDINATE, places[random() % std::size(places)])};
    switch (random() % 5) {
    case 0:
      nodes.push_back(node(LANCER_NODE_MAPPING, uint32_t(random() % 4), {result_of(0), any(), any(), any()}));
      break;
    case 1:
      nodes.push_back(node(LANCER_NODE_TRANSFORM, 0, {result_of(0)}));
      for (float &x : nodes.back().matrix)
        x = number(random);
      break;
    case 2:
      nodes.push_back(node(LANCER_NODE_SEPARATE, uint32_t(random() % 3), {result_of(0)}));
      nodes.push_back(node(LANCER_NODE_COMBINE, 0, {result_of(1), any(), result_of(0)}));
      break;
    default:
      nodes.push_back(node(LANCER_NODE_VECTOR_MATH, uint32_t(random() % LANCER_VECTOR_COUNT),
                           {result_of(0), random() % 3 ? any() : result_of(0), any(), any()}));
    }
    const bool sky = random() % 4 == 0;
    lancer_node look = shown(int32_t(nodes.size()) - 1, uint32_t(random() % 4));
    look.kind = sky ? LANCER_NODE_ENVIRONMENT : LANCER_NODE_IMAGE;
    look.option = uint32_t(random() % (sky ? 2 : 4));
    if (!sky && look.option == LANCER_PROJECT_BOX)
      look.inputs[1] = constant(0.5f);
    look.flags |= uint32_t(random() % 3) << 4;
    nodes.push_back(look);
    const Program program = read_program(rows, "test", nodes.data(), uint32_t(nodes.size()));
    const Program in_blocks = read_program(blocks, "test", nodes.data(), uint32_t(nodes.size()));
    ASSERT_TRUE(program.mipmapped);
    Parameter last;
    last.node = int32_t(nodes.size()) - 1;
    const Schedule schedule = program.schedule(std::span(&last, 1));
    NodeBlock block{};
    block.scene = {&geometry, &stage.normalisation, nullptr};
    block.used = 0xffff;
    std::vector<NodeContext> contexts(kBlockLanes);
    std::vector<Surface> surfaces(kBlockLanes);
    std::uniform_real_distribution<double> place(0.0, 0.5);
    for (int lane = 0; lane < kBlockLanes; ++lane) {
      Surface &s = surfaces[size_t(lane)] = stage.surface(place(random), place(random));
      NodeContext &context = contexts[size_t(lane)];
      static_cast<NodeScene &>(context) = block.scene;
      context.surface = &s;
      context.wo = glm::normalize(glm::vec3(number(random), number(random), 4.0f));
      context.path.width = width(random);
      context.path.spread = width(random);
      put(context.path, block, uint32_t(lane));
      block.bary[0][lane] = s.bary.x;
      block.bary[1][lane] = s.bary.y;
      for (int axis = 0; axis < 3; ++axis) {
        block.p[axis][lane] = s.p[axis];
        block.ns[axis][lane] = s.ns[axis];
        block.ng[axis][lane] = s.ng[axis];
        block.wo[axis][lane] = context.wo[axis];
      }
    }
    std::vector<glm::vec4> one(program.value_count());
    std::vector<NodeLanes> many(program.value_count());
    for (const Program *of : {&program, &in_blocks})
      for (const NodeKernel *kernel : LANCER_EACH_KERNEL(node_kernel)) {
        kernel->run(*of, schedule, block, many.data());
        for (int lane = 0; lane < kBlockLanes; ++lane) {
          run(program, schedule, contexts[size_t(lane)], one);
          for (int k = 0; k < 4; ++k) {
            const float a = many[nodes.size() - 1].of[k][lane], b = one[nodes.size() - 1][k];
            ASSERT_TRUE(a == b || (std::isnan(a) && std::isnan(b)))
                << kernel->name << ", round " << round << ": " << a << ", " << b;
          }
        }
      }
  }
}

} // namespace
} // namespace lancer_test
