// Images: texels, neighbours, edges, curves and alpha, against the stored values.
#include "nodes_lab.h"

#include "nodes/image.h"

#include <cmath>

using namespace lancer_test;

namespace {

template <class Texel>
Image picture(uint32_t width, uint32_t height, uint32_t channels, const std::vector<Texel> &texels,
              uint32_t transfer = LANCER_TRANSFER_LINEAR, uint32_t alpha = LANCER_ALPHA_STRAIGHT) {
  lancer_image image = image_of(texels, width, height, channels);
  image.transfer = transfer;
  image.alpha = alpha;
  return kept_image(image);
}

float grey(const Image &image, float u, float v, Extension extension, Interpolation interpolation) {
  return lookup(image, {u, v}, extension, interpolation, false).x;
}

// Three roundings of 2^-24 before a power of 2.4, and one after it.
constexpr float kCurve = 5e-7f;

double srgb(double c) { return c < 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); }

// 4 x 2 greys, all different.
const std::vector<float> kGreys = {1, 2, 4, 8, 16, 32, 64, 128};

TEST(ImagesLookup, TexelsStandInTheirMiddle) {
  const Image image = picture<float>(4, 2, 1, kGreys);
  for (uint32_t y = 0; y < 2; ++y)
    for (uint32_t x = 0; x < 4; ++x)
      for (const Extension extension : {Extension::Repeat, Extension::Extend, Extension::Clip, Extension::Mirror}) {
        const float u = (float(x) + 0.5f) / 4.0f, v = (float(y) + 0.5f) / 2.0f;
        EXPECT_EQ(grey(image, u, v, extension, Interpolation::Closest), kGreys[4 * y + x]);
        EXPECT_EQ(grey(image, u, v, extension, Interpolation::Linear), kGreys[4 * y + x]);
      }
  // Halfway between two texels, and between four.
  EXPECT_EQ(grey(image, 0.25f, 0.25f, Extension::Repeat, Interpolation::Linear), 1.5f);
  EXPECT_EQ(grey(image, 0.25f, 0.5f, Extension::Repeat, Interpolation::Linear), 12.75f);
  // The closest texel changes at the border of two texels.
  EXPECT_EQ(grey(image, 0.2499f, 0.25f, Extension::Repeat, Interpolation::Closest), 1.0f);
  EXPECT_EQ(grey(image, 0.25f, 0.25f, Extension::Repeat, Interpolation::Closest), 2.0f);
}

// Returns the texel at index i of an infinite row.
float texel_of(int i, Extension extension) {
  const int row[] = {1, 2, 4, 8};
  if (extension == Extension::Clip && (i < 0 || i > 3))
    return 0.0f;
  if (extension == Extension::Extend)
    return float(row[i < 0 ? 0 : i > 3 ? 3 : i]);
  const int period = extension == Extension::Mirror ? 8 : 4, k = ((i % period) + period) % period;
  return float(row[k < 4 ? k : 7 - k]);
}

TEST(ImagesLookup, EveryExtensionAndInterpolationBeyondTheEdges) {
  const Image image = picture<float>(4, 1, 1, {1, 2, 4, 8});
  for (const Extension extension : {Extension::Repeat, Extension::Extend, Extension::Clip, Extension::Mirror})
    for (int step = -75; step < 115; ++step) {
      // Off the grid, so that rounding cannot select another texel.
      const float x = float(step) * 0.1f + 0.03f, u = x / 4.0f;
      SCOPED_TRACE(testing::Message() << "extension " << uint32_t(extension) << " at " << x);
      EXPECT_EQ(grey(image, u, 0.5f, extension, Interpolation::Closest), texel_of(int(std::floor(x)), extension));
      const double place = double(x) - 0.5, i = std::floor(place), t = place - i;
      const auto at = [&](int k) { return double(texel_of(int(i) + k, extension)); };
      // u has a rounding of 2^-24 of up to 3, times 4 texels, times a slope of 8.
      EXPECT_NEAR(grey(image, u, 0.5f, extension, Interpolation::Linear), (1.0 - t) * at(0) + t * at(1), 2e-5);
      const double w[] = {(1 - t) * (1 - t) * (1 - t) / 6, (4 - 6 * t * t + 3 * t * t * t) / 6,
                          (1 + 3 * t + 3 * t * t - 3 * t * t * t) / 6, t * t * t / 6};
      // Two of the four rows have weight 1/6, the one of the image 2/3; only Clip makes them black.
      const double share = extension == Extension::Clip ? 2.0 / 3.0 : 1.0;
      EXPECT_NEAR(grey(image, u, 0.5f, extension, Interpolation::Cubic),
                  share * (w[0] * at(-1) + w[1] * at(0) + w[2] * at(1) + w[3] * at(2)), 2e-5);
    }
}

TEST(ImagesLookup, NoNumberIsBlack) {
  const Image image = picture<float>(4, 2, 1, kGreys);
  for (const float bad : {NAN, INFINITY, -INFINITY})
    for (const Extension extension : {Extension::Repeat, Extension::Extend, Extension::Clip, Extension::Mirror}) {
      EXPECT_EQ(lookup(image, {bad, 0.5f}, extension, Interpolation::Linear, false), glm::vec4(0.0f));
      EXPECT_EQ(lookup(image, {0.5f, bad}, extension, Interpolation::Cubic, false), glm::vec4(0.0f));
      EXPECT_TRUE(std::isfinite(lookup(image, {1e30f, -1e30f}, extension, Interpolation::Cubic, false).x));
    }
}

// A single texel is its own neighbour, and the next one.
TEST(ImagesLookup, OneTexelIsSeenEverywhere) {
  const Image image = picture<float>(1, 1, 1, {0.75f});
  for (const Extension extension : {Extension::Repeat, Extension::Extend, Extension::Mirror})
    for (const Interpolation interpolation : {Interpolation::Closest, Interpolation::Linear, Interpolation::Cubic})
      // A float below 0 whose distance from the whole number below rounds to 1.
      for (const float u : {-1e-9f, 0.0f, 0.25f, 0.5f, 0.75f, 1.0f, 1.25f, 1.75f, 2.0f, -0.3f})
        // Weights of the spline round four times, along two axes.
        EXPECT_NEAR(grey(image, u, u, extension, interpolation), 0.75f, 8.0f * 0x1p-24f) << u;
}

TEST(ImagesLookup, ChannelsAndDepths) {
  const glm::vec2 uv(0.5f);
  const auto look = [&](const Image &image) { return lookup(image, uv, Extension::Repeat, Interpolation::Linear, false); };
  // One rounding of the step, one of the product.
  expect_near(glm::vec3(look(picture<uint8_t>(1, 1, 1, {51}))), glm::vec3(0.2f), 1.2e-7f * 0.2f);
  expect_near(glm::vec3(look(picture<uint16_t>(1, 1, 3, {13107, 26214, 65535}))), glm::vec3(0.2f, 0.4f, 1.0f), 1.2e-7f);
  EXPECT_EQ(look(picture<uint8_t>(1, 1, 1, {51})).w, 1.0f);
  EXPECT_EQ(lookup(picture<float>(1, 1, 4, {3, -2, 1, 1}), uv, Extension::Repeat, Interpolation::Linear, false),
            glm::vec4(3, -2, 1, 1));
  // Outside a clipped image: transparent with three channels, black and opaque with a single channel.
  EXPECT_EQ(lookup(picture<uint8_t>(1, 1, 3, {9, 9, 9}), glm::vec2(2.0f), Extension::Clip, Interpolation::Linear, false),
            glm::vec4(0.0f));
  EXPECT_EQ(lookup(picture<uint8_t>(1, 1, 1, {9}), glm::vec2(2.0f), Extension::Clip, Interpolation::Linear, false),
            glm::vec4(0, 0, 0, 1));
}

TEST(ImagesLookup, CurveIsDecodedAfterInterpolation) {
  const Image image = picture<uint8_t>(2, 1, 3, {0, 50, 100, 255, 150, 10}, LANCER_TRANSFER_SRGB);
  const glm::vec4 middle = lookup(image, {0.5f, 0.5f}, Extension::Extend, Interpolation::Linear, false);
  expect_near(glm::vec3(middle), glm::vec3(glm::dvec3(srgb(0.5), srgb(100.0 / 255.0), srgb(55.0 / 255.0))), kCurve);
  // Every byte: the table equals the curve.
  for (int i = 0; i < 256; ++i) {
    const Image one = picture<uint8_t>(1, 1, 3, {uint8_t(i), 0, 255}, LANCER_TRANSFER_SRGB);
    const glm::vec4 closest = lookup(one, glm::vec2(0.5f), Extension::Repeat, Interpolation::Closest, false);
    // Between bytes the curve is linear segments, at most 7.4e-8 from it, which the curve's own rounding near white exceeds.
    const glm::vec4 linear = lookup(one, glm::vec2(0.5f), Extension::Repeat, Interpolation::Linear, false);
    EXPECT_NEAR(closest.x, linear.x, kCurve);
    EXPECT_NEAR(closest.x, srgb(i / 255.0), kCurve);
    EXPECT_EQ(closest.z, 1.0f);
  }
}

TEST(ImagesLookup, CurveComesAfterInterpolationInEveryDepth) {
  const auto looks_like = [](const Image &image, double encoded) {
    for (const Interpolation interpolation : {Interpolation::Linear, Interpolation::Cubic})
      EXPECT_NEAR(grey(image, 0.5f, 0.5f, Extension::Extend, interpolation), srgb(std::max(encoded, 0.0)),
                  kCurve * std::max(1.0, srgb(encoded)));
  };
  // Halfway between two texels both interpolations return their mean, also below 0, where the curve ends, and above 1.
  looks_like(picture<uint16_t>(2, 1, 1, {13107, 39321}, LANCER_TRANSFER_SRGB), 0.4);
  looks_like(picture<float>(2, 1, 1, {0.1f, 0.7f}, LANCER_TRANSFER_SRGB), 0.4);
  looks_like(picture<float>(2, 1, 1, {-0.5f, 1.0f}, LANCER_TRANSFER_SRGB), 0.25);
  looks_like(picture<float>(2, 1, 1, {-0.5f, 0.25f}, LANCER_TRANSFER_SRGB), -0.125);
  looks_like(picture<float>(2, 1, 1, {0.5f, 5.5f}, LANCER_TRANSFER_SRGB), 3.0);
}

TEST(ImagesLookup, CurveIsFarthestFromItsLinesWhereItsPartsMeet) {
  for (const float c : {0.04045f, std::nextafter(0.04045f, 0.0f), 0.0404f, 0.0405f}) {
    const float got =
        grey(picture<float>(1, 1, 1, {c}, LANCER_TRANSFER_SRGB), 0.5f, 0.5f, Extension::Repeat, Interpolation::Linear);
    // The deviation of the segments, and for numbers near 0.0033 the roundings of the curve and of three steps along a segment.
    EXPECT_NEAR(got, srgb(double(c)), 7.4e-8 + 0.0033 * (kCurve + 3 * 0x1p-24)) << c;
  }
}

TEST(ImagesLookup, AlphaModes) {
  const auto look = [](uint32_t mode, uint32_t transfer, bool straight) {
    const Image image = picture<uint8_t>(1, 1, 4, {200, 100, 50, 128}, transfer, mode);
    return lookup(image, glm::vec2(0.5f), Extension::Repeat, Interpolation::Linear, straight);
  };
  const auto color = [](double r, double g, double b) { return glm::vec3(glm::dvec3(r, g, b) / 255.0); };
  // Straight: multiplied in bytes, truncated: 200 128 / 255 = 100.39.
  expect_near(glm::vec3(look(LANCER_ALPHA_STRAIGHT, LANCER_TRANSFER_LINEAR, false)), color(100, 50, 25));
  // Divided again, including the rounding.
  expect_near(glm::vec3(look(LANCER_ALPHA_STRAIGHT, LANCER_TRANSFER_LINEAR, true)), color(100, 50, 25) * float(255.0 / 128.0));
  expect_near(glm::vec3(look(LANCER_ALPHA_ASSOCIATED, LANCER_TRANSFER_LINEAR, false)), color(200, 100, 50));
  expect_near(glm::vec3(look(LANCER_ALPHA_ASSOCIATED, LANCER_TRANSFER_LINEAR, true)),
              color(200, 100, 50) * float(255.0 / 128.0));
  for (const uint32_t mode : {LANCER_ALPHA_CHANNEL_PACKED, LANCER_ALPHA_NONE})
    for (const bool straight : {false, true})
      expect_near(glm::vec3(look(mode, LANCER_TRANSFER_LINEAR, straight)), color(200, 100, 50));
  for (const uint32_t mode : {LANCER_ALPHA_STRAIGHT, LANCER_ALPHA_ASSOCIATED, LANCER_ALPHA_CHANNEL_PACKED})
    EXPECT_EQ(look(mode, LANCER_TRANSFER_LINEAR, false).w, 128.0f / 255.0f);
  EXPECT_EQ(look(LANCER_ALPHA_NONE, LANCER_TRANSFER_LINEAR, false).w, 1.0f);
  // Floats and 16 bits are multiplied as bytes are.
  const auto one = [&](const Image &image) {
    return lookup(image, glm::vec2(0.5f), Extension::Repeat, Interpolation::Linear, false);
  };
  const Image floats = picture<float>(1, 1, 4, {0.5f, 0.25f, 2.0f, 0.5f}, LANCER_TRANSFER_LINEAR, LANCER_ALPHA_STRAIGHT);
  EXPECT_EQ(one(floats), glm::vec4(0.25f, 0.125f, 1.0f, 0.5f));
  const Image words = picture<uint16_t>(1, 1, 4, {40000, 20000, 10000, 32768}, LANCER_TRANSFER_LINEAR, LANCER_ALPHA_STRAIGHT);
  expect_near(glm::vec3(one(words)), glm::vec3(20000, 10000, 5000) / 65535.0f);
  // The curve is applied after alpha, and does not change alpha.
  const glm::vec4 encoded = look(LANCER_ALPHA_STRAIGHT, LANCER_TRANSFER_SRGB, true);
  EXPECT_NEAR(encoded.x, srgb(100.0 / 128.0), kCurve);
  EXPECT_EQ(encoded.w, 128.0f / 255.0f);
  // An alpha of 0 divides nothing.
  const Image clear = picture<float>(1, 1, 4, {0.5f, 0.5f, 0.5f, 0.0f}, LANCER_TRANSFER_LINEAR, LANCER_ALPHA_ASSOCIATED);
  EXPECT_EQ(lookup(clear, glm::vec2(0.5f), Extension::Repeat, Interpolation::Linear, true), glm::vec4(0.5f, 0.5f, 0.5f, 0.0f));
}

TEST(ImagesLookup, MatrixIsOfRows) {
  const std::vector<float> texels = {1, 2, 4};
  lancer_image image = {};
  image.texels = texels.data();
  image.width = image.height = 1;
  image.channels = 3;
  image.kind = LANCER_TEXEL_FLOAT;
  const float rows[9] = {0, 1, 0, 0, 0, 1, 1, 1, 1};
  std::copy(rows, rows + 9, image.matrix);
  EXPECT_EQ(glm::vec3(lookup(kept_image(image), glm::vec2(0.5f), Extension::Repeat, Interpolation::Linear, false)),
            glm::vec3(2, 4, 7));
}

TEST(ImagesLookup, RefusesWhatCannotBeRead) {
  const std::vector<float> texels(16);
  lancer_image good = {};
  good.name = "bad";
  good.texels = texels.data();
  good.width = good.height = 2;
  good.channels = 4;
  good.kind = LANCER_TEXEL_FLOAT;
  const auto refused = [&](auto change) {
    lancer_image image = good;
    change(image);
    Description description;
    try {
      add_image(description, image);
    } catch (const std::exception &error) {
      EXPECT_EQ(std::string(error.what()).rfind("image 'bad': ", 0), 0u) << error.what();
      return description.images.empty();
    }
    return false;
  };
  EXPECT_FALSE(refused([](lancer_image &) {}));
  EXPECT_TRUE(refused([](lancer_image &image) { image.width = 0; }));
  EXPECT_TRUE(refused([](lancer_image &image) { image.height = 1u << 31; }));
  // Kernels depend on it.
  EXPECT_TRUE(refused([](lancer_image &image) { image.width = (1u << 20) + 1; }));
  EXPECT_TRUE(refused([](lancer_image &image) { image.channels = 2; }));
  EXPECT_TRUE(refused([](lancer_image &image) { image.kind = 3; }));
  EXPECT_TRUE(refused([](lancer_image &image) { image.transfer = 2; }));
  EXPECT_TRUE(refused([](lancer_image &image) { image.alpha = 4; }));
  EXPECT_TRUE(refused([](lancer_image &image) { image.texels = nullptr; }));
  EXPECT_TRUE(refused([](lancer_image &image) { image.matrix[4] = NAN; }));
  // 2^40 texels of 16 bytes: no machine has the memory, and the message states the number.
  lancer_image huge = good;
  huge.width = huge.height = 1u << 20;
  Description description;
  try {
    add_image(description, huge);
    ADD_FAILURE();
  } catch (const Error &error) {
    EXPECT_EQ(error.fault(), Fault::Memory);
    EXPECT_EQ(std::string(error.what()).rfind("image 'bad': 1048576 x 1048576 texels need 17592186 MB", 0), 0u) << error.what();
  }
}

TEST(ImagesLookup, WhatReadsATexelThatIsNoNumberIsBlack) {
  Description description;
  const std::vector<float> texels = {1, NAN, 3, 1, 1, 2, 3, 1, 1, 2, 3, INFINITY, 1, 2, 3, 1};
  lancer_image image = image_of(texels, 4, 1);
  image.name = "holes";
  add_image(description, image);
  const Image &kept = *description.images[0];
  const auto at = [&](float u, Interpolation interpolation) {
    return lookup(kept, {u, 0.5f}, Extension::Extend, interpolation, false);
  };
  EXPECT_EQ(at(0.125f, Interpolation::Closest), glm::vec4(0, 0, 0, 1));
  EXPECT_EQ(at(0.375f, Interpolation::Closest), glm::vec4(1, 2, 3, 1));
  EXPECT_EQ(at(0.625f, Interpolation::Closest), glm::vec4(1, 2, 3, 0));
  EXPECT_EQ(lookup_alpha(kept, {0.625f, 0.5f}, Extension::Extend, Interpolation::Closest), 0.0f);
  // Between a texel that is a number and one that is none.
  EXPECT_EQ(at(0.25f, Interpolation::Linear), glm::vec4(0, 0, 0, 1));
  EXPECT_EQ(at(0.5f, Interpolation::Linear), glm::vec4(1, 2, 3, 0));
  EXPECT_EQ(at(0.875f, Interpolation::Linear), glm::vec4(1, 2, 3, 1));
  EXPECT_EQ(description.messages(), "image 'holes': 2 texels are not finite, look-ups that read one give black\n");
}

TEST(ImagesLookup, TheAlphaAloneIsThatOfTheWhole) {
  std::vector<float> texels;
  for (uint32_t i = 0; i < 5 * 3 * 4; ++i)
    texels.push_back(float(i * 37 % 61) / 60.0f);
  std::vector<uint8_t> bytes;
  for (const float texel : texels)
    bytes.push_back(uint8_t(texel * 255.0f));
  bool varied = false;
  for (const uint32_t channels : {1u, 3u, 4u})
    for (const uint32_t alpha :
         {LANCER_ALPHA_ASSOCIATED, LANCER_ALPHA_STRAIGHT, LANCER_ALPHA_CHANNEL_PACKED, LANCER_ALPHA_NONE})
      for (const bool small : {false, true}) {
        const Image image = small ? picture<uint8_t>(5, 3, channels, bytes, LANCER_TRANSFER_SRGB, alpha)
                                  : picture<float>(5, 3, channels, texels, LANCER_TRANSFER_LINEAR, alpha);
        for (const Extension extension : {Extension::Repeat, Extension::Extend, Extension::Clip, Extension::Mirror})
          for (const Interpolation interpolation : {Interpolation::Linear, Interpolation::Closest, Interpolation::Cubic})
            for (const glm::vec2 uv :
                 {glm::vec2(0.3f, 0.7f), {0.01f, 0.99f}, {1.3f, -0.4f}, {9e9f, 0.5f}, {NAN, 0.5f}, {0.5f, INFINITY}}) {
              const float a = lookup_alpha(image, uv, extension, interpolation);
              EXPECT_EQ(a, lookup(image, uv, extension, interpolation, true).w);
              varied |= a > 0.0f && a < 1.0f;
            }
      }
  EXPECT_TRUE(varied);
}

} // namespace
