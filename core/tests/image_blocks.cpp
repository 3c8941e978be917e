// Images in blocks: each look-up has the bits of the same image in rows, and what cannot be blocks is refused.
#include "nodes_lab.h"

#include "compile/scene.h"
#include "nodes/image.h"

#include <cstring>
#include <random>

namespace lancer_test {
namespace {

using Random = std::mt19937;

// Blocks begin at a multiple of 64 bytes.
struct alignas(64) Line {
  std::byte bytes[64];
};

constexpr uint32_t kSide = 64;

uint32_t blocks_along_side(uint32_t side) { return (side + kSide - 1) / kSide; }

// The texels of image in the order of LANCER_LAYOUT_BLOCKS. Texels beyond the image have no number that a look-up returns.
std::vector<Line> blocks_of(const lancer_image &image) {
  const size_t texel = image.channels * (size_t(1) << image.kind), across = blocks_along_side(image.width);
  const size_t bytes = across * blocks_along_side(image.height) * kSide * kSide * texel;
  std::vector<Line> lines(bytes / sizeof(Line) + 1);
  auto *to = reinterpret_cast<std::byte *>(lines.data());
  std::memset(to, 0xa5, bytes);
  const auto *from = static_cast<const std::byte *>(image.texels);
  for (size_t y = 0; y < image.height; ++y)
    for (size_t x = 0; x < image.width; ++x) {
      const size_t block = y / kSide * across + x / kSide, inside = y % kSide * kSide + x % kSide;
      std::memcpy(to + (block * kSide * kSide + inside) * texel, from + (y * image.width + x) * texel, texel);
    }
  return lines;
}

// An image in rows and in blocks.
struct Both {
  std::vector<Line> lines;
  Description rows, blocks;

  explicit Both(lancer_image image) {
    add_image(rows, image);
    lines = blocks_of(image);
    image.texels = lines.data();
    image.layout = LANCER_LAYOUT_BLOCKS;
    add_image(blocks, image);
  }
};

void expect_same_bits(const void *a, const void *b, size_t bytes, float u, float v) {
  ASSERT_EQ(std::memcmp(a, b, bytes), 0) << u << " " << v;
}

// Compares look-ups at random coordinates, beside the borders of blocks and of the image, and at numbers that are not finite.
void expect_same_looks(Random &random, const Both &both, uint32_t flags) {
  const Image &rows = *both.rows.images[0], &blocks = *both.blocks.images[0];
  std::uniform_real_distribution<float> somewhere(-2.0f, 3.0f), near(-1.5f, 1.5f);
  const auto place = [&](uint32_t side) {
    const float special[] = {0.0f, 1.0f, -1e-9f, 1e30f, NAN, INFINITY, 1.0f - 0x1p-24f};
    const uint32_t border = kSide * uint32_t(random() % (side / kSide + 1));
    const uint32_t choice = random() % 8;
    return choice == 0 ? special[random() % 7] : choice < 5 ? (float(border) + near(random)) / float(side) : somewhere(random);
  };
  // Coordinates are world positions.
  Program program;
  Node position, look;
  position.kind = LANCER_NODE_COORDINATE;
  position.option = LANCER_COORDINATE_POSITION;
  look.kind = LANCER_NODE_IMAGE;
  look.option = LANCER_PROJECT_FLAT;
  look.flags = flags;
  look.image_count = 1;
  look.inputs[0].node = 0;
  program.nodes = {position, look};
  NodeBlock block{};
  block.surface = false;
  block.used = 0xffff;
  for (int lane = 0; lane < kBlockLanes; ++lane) {
    block.p[0][lane] = double(place(rows.width));
    block.p[1][lane] = double(place(rows.height));
  }
  NodeLanes of_rows[2], of_blocks[2];
  program.images = {rows};
  node_kernel().run(program, Schedule{0, 1}, block, of_rows);
  program.images = {blocks};
  node_kernel().run(program, Schedule{0, 1}, block, of_blocks);
  const auto extension = static_cast<Extension>(flags & 0xf);
  const auto interpolation = static_cast<Interpolation>(flags >> 4 & 0xf);
  for (int lane = 0; lane < kBlockLanes; ++lane) {
    const glm::vec2 uv(float(block.p[0][lane]), float(block.p[1][lane]));
    for (int k = 0; k < 4; ++k)
      ASSERT_NO_FATAL_FAILURE(expect_same_bits(&of_rows[1].of[k][lane], &of_blocks[1].of[k][lane], sizeof(float), uv.x, uv.y));
    const glm::vec4 a = lookup(rows, uv, extension, interpolation, flags & 256);
    const glm::vec4 b = lookup(blocks, uv, extension, interpolation, flags & 256);
    ASSERT_NO_FATAL_FAILURE(expect_same_bits(&a, &b, sizeof a, uv.x, uv.y));
    const float alpha = lookup_alpha(rows, uv, extension, interpolation);
    const float again = lookup_alpha(blocks, uv, extension, interpolation);
    ASSERT_NO_FATAL_FAILURE(expect_same_bits(&alpha, &again, sizeof alpha, uv.x, uv.y));
  }
}

// The name of the suite is that of image_lanes.cpp, which is repeated in each instruction set.
TEST(ImageLanes, BlocksHaveTheBitsOfRows) {
  Random random(5);
  const uint32_t sides[] = {1, 2, 63, 64, 65, 130};
  for (const uint32_t width : sides)
    for (const uint32_t height : sides)
      for (const uint32_t kind : {LANCER_TEXEL_U8, LANCER_TEXEL_U16, LANCER_TEXEL_FLOAT})
        for (const uint32_t channels : {1u, 3u, 4u}) {
          std::vector<uint16_t> words(size_t(width) * height * channels);
          for (uint16_t &word : words)
            word = uint16_t(random());
          std::vector<uint8_t> bytes(words.begin(), words.end());
          std::vector<float> floats;
          for (const uint16_t word : words)
            floats.push_back(float(word) / 30000.0f);
          lancer_image image = kind == LANCER_TEXEL_U8    ? image_of(bytes, width, height, channels)
                               : kind == LANCER_TEXEL_U16 ? image_of(words, width, height, channels)
                                                          : image_of(floats, width, height, channels);
          image.transfer = random() % 2 ? LANCER_TRANSFER_SRGB : LANCER_TRANSFER_LINEAR;
          image.alpha = random() % 2 ? LANCER_ALPHA_ASSOCIATED : LANCER_ALPHA_CHANNEL_PACKED;
          const Both both(image);
          ASSERT_FALSE(both.blocks.images[0]->memory);
          for (uint32_t extension = 0; extension < 4; ++extension)
            for (uint32_t interpolation = 0; interpolation < 3; ++interpolation) {
              SCOPED_TRACE(testing::Message() << width << " x " << height << ", kind " << kind << ", channels " << channels
                                              << ", extension " << extension << ", interpolation " << interpolation);
              for (int i = 0; i < 4; ++i)
                ASSERT_NO_FATAL_FAILURE(
                    expect_same_looks(random, both, extension | interpolation << 4 | (random() % 2 ? 256u : 0u)));
            }
        }
}

// 2^29 floats, of which the test writes two: offsets in bytes exceed 32 bits.
TEST(ImageLanes, BlocksOfTwoGigabytes) {
  const uint32_t width = 1u << 15, height = (1u << 14) + 1;
  const size_t across = width / kSide, bytes = across * blocks_along_side(height) * kSide * kSide * sizeof(float);
  ASSERT_GT(bytes, size_t(1) << 31);
  const Texels memory = allocate_texels(bytes);
  auto *texels = reinterpret_cast<float *>(memory.get());
  const size_t last_block = across * (blocks_along_side(height) - 1) + across - 1;
  texels[last_block * kSide * kSide + kSide - 1] = 0.25f;    // the last texel of the top row
  texels[(across - 1) * kSide * kSide + kSide - 1] = 0.125f; // the last of the bottom row
  lancer_image image = image_of(std::vector<float>(), width, height, 1);
  image.texels = texels;
  image.layout = LANCER_LAYOUT_BLOCKS;
  Program program;
  hold(program, kept_image(image));
  Node position, look;
  position.kind = LANCER_NODE_COORDINATE;
  position.option = LANCER_COORDINATE_POSITION;
  look.kind = LANCER_NODE_IMAGE;
  look.option = LANCER_PROJECT_FLAT;
  look.flags = LANCER_INTERPOLATE_CLOSEST << 4;
  look.image_count = 1;
  look.inputs[0].node = 0;
  program.nodes = {position, look};
  NodeBlock block{};
  block.surface = false;
  block.used = 0xffff;
  for (int lane = 0; lane < kBlockLanes; ++lane) {
    block.p[0][lane] = (width - 0.5) / width;
    block.p[1][lane] = lane % 2 ? (height - 0.5) / height : 0.5 / height;
  }
  NodeLanes values[2];
  node_kernel().run(program, Schedule{0, 1}, block, values);
  for (int lane = 0; lane < kBlockLanes; ++lane)
    EXPECT_EQ(values[1].of[0][lane], lane % 2 ? 0.25f : 0.125f) << lane;
}

TEST(ImageBlocks, TheCallerCountsGaps) {
  const std::vector<float> texels = {1, NAN, 3, 1, 2, 3};
  lancer_image image = image_of(texels, 2, 1, 3);
  image.name = "holes";
  image.gaps = 1;
  const Both both(image);
  for (const Description *description : {&both.rows, &both.blocks}) {
    EXPECT_TRUE(description->images[0]->has_gaps);
    EXPECT_EQ(description->messages(), "image 'holes': 1 texels are not finite, look-ups that read one give black\n");
  }
  Random random(1);
  for (uint32_t interpolation = 0; interpolation < 3; ++interpolation)
    expect_same_looks(random, both, interpolation << 4);
}

TEST(ImageBlocks, RefusesWhatCannotBeReadInPlace) {
  std::vector<Line> lines(kSide * kSide * 4 * sizeof(float) / sizeof(Line) + 1);
  lancer_image good = image_of(std::vector<float>(), 2, 2);
  good.name = "bad";
  good.texels = lines.data();
  good.layout = LANCER_LAYOUT_BLOCKS;
  const auto refusal = [&](auto change) -> std::string {
    lancer_image image = good;
    change(image);
    Description description;
    try {
      add_image(description, image);
    } catch (const Error &error) {
      EXPECT_EQ(error.fault(), Fault::Argument);
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal([](lancer_image &) {}), "");
  EXPECT_EQ(refusal([](lancer_image &image) { image.layout = 2; }), "image 'bad': layout 2 is not one of 0, 1");
  EXPECT_EQ(refusal([](lancer_image &image) { image.mipmaps = 2; }), "image 'bad': mipmaps 2 is not one of 0, 1");
  const auto beside = reinterpret_cast<uintptr_t>(lines.data()) + 4;
  EXPECT_EQ(refusal([&](lancer_image &image) { image.texels = reinterpret_cast<const void *>(beside); }),
            "image 'bad': address of the blocks " + std::to_string(beside) + " is not a multiple of 64");
  EXPECT_EQ(refusal([](lancer_image &image) { image.alpha = LANCER_ALPHA_STRAIGHT; }),
            "image 'bad': blocks have straight alpha, but are read in place: multiply their colour by alpha");
  EXPECT_EQ(refusal([](lancer_image &image) {
              image.alpha = LANCER_ALPHA_STRAIGHT;
              image.channels = 3;
            }),
            "");
}

TEST(ImageBlocks, NoTableIsBlocks) {
  Description description;
  std::vector<Line> lines(kSide * kSide * 3 * sizeof(float) / sizeof(Line) + 1);
  lancer_image table = image_of(std::vector<float>(), 256, 1, 3);
  table.name = "curve";
  lines.resize(4 * lines.size());
  table.texels = lines.data();
  table.layout = LANCER_LAYOUT_BLOCKS;
  add_image(description, table);
  const lancer_node curves = node(LANCER_NODE_CURVES, 0, {constant(1.0f), constant(0.5f)});
  lancer_material material = black();
  material.name = "painted";
  material.nodes = &curves;
  material.node_count = 1;
  try {
    add_material(description, material);
    ADD_FAILURE();
  } catch (const Error &error) {
    EXPECT_EQ(std::string(error.what()), "material 'painted': node 0: image 'curve' is a table, but its texels are blocks");
  }
}

} // namespace
} // namespace lancer_test
