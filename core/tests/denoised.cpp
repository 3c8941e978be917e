// The combination of a picture with denoised versions of it, for denoisers that are known: picture, error, and what is refused.
#include "lancer.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <vector>

namespace {

constexpr uint32_t kWidth = 160, kHeight = 120;
constexpr double kStep = 0.5, kSigma = 0.2;

using Picture = std::vector<float>;

double level(size_t pixel) { return 0.75 + 0.25 * std::sin(0.05 * double(pixel % kWidth)); }

// A smooth picture with independent Gaussian noise, and noise like it.
struct Noisy {
  Picture truth, picture, noise;

  explicit Noisy(uint32_t seed = 1, double sigma = kSigma) {
    std::mt19937 random(seed);
    std::normal_distribution<double> gaussian(0.0, sigma);
    for (size_t pixel = 0; pixel < kWidth * kHeight; ++pixel)
      for (int channel = 0; channel < 3; ++channel) {
        truth.push_back(float(level(pixel)));
        picture.push_back(float(level(pixel) + gaussian(random)));
        noise.push_back(float(gaussian(random)));
      }
  }
};

struct Result {
  lancer_status status;
  Picture picture = Picture(3 * kWidth * kHeight), bars;
  lancer_denoised_error error = {};
};

// denoise: returns the denoised picture.
template <class Denoise>
Result combined(const Noisy &noisy, Denoise &&denoise, uint32_t combines = 1, uint32_t block = 1,
                const float *errors = nullptr) {
  Picture first, second;
  for (size_t i = 0; i < noisy.picture.size(); ++i) {
    first.push_back(float(double(noisy.picture[i]) + kStep * double(noisy.noise[i])));
    second.push_back(float(double(noisy.picture[i]) - kStep * double(noisy.noise[i])));
  }
  first = denoise(first);
  second = denoise(second);
  Result result;
  result.bars.resize(size_t((kWidth + block - 1) / block) * ((kHeight + block - 1) / block));
  result.status =
      lancer_combine_denoised(kWidth, kHeight, noisy.picture.data(), noisy.noise.data(), errors, first.data(), second.data(),
                              kStep, combines, 0.95, block, result.picture.data(), result.bars.data(), &result.error);
  return result;
}

// Returns a denoiser that changes each number alone.
template <class Change> auto each(Change &&change) {
  return [change](const Picture &picture) {
    Picture result;
    for (size_t i = 0; i < picture.size(); ++i)
      result.push_back(float(change(i, double(picture[i]))));
    return result;
  };
}

// Returns the mean over 7 x 7 pixels, or over those that there are.
Picture blurred(const Picture &picture) {
  constexpr int kReach = 3;
  Picture result(picture.size());
  for (int y = 0; y < int(kHeight); ++y)
    for (int x = 0; x < int(kWidth); ++x)
      for (int c = 0; c < 3; ++c) {
        double sum = 0.0, count = 0.0;
        for (int v = std::max(y - kReach, 0); v <= std::min(y + kReach, int(kHeight) - 1); ++v)
          for (int u = std::max(x - kReach, 0); u <= std::min(x + kReach, int(kWidth) - 1); ++u, count += 1.0)
            sum += double(picture[size_t(3 * (v * int(kWidth) + u) + c)]);
        result[size_t(3 * (y * int(kWidth) + x) + c)] = float(sum / count);
      }
  return result;
}

// Returns the relative root mean square of the error of luminance, where the three channels of the truth are equal.
double true_error(const Noisy &noisy, const Picture &picture) {
  double sum = 0.0, light = 0.0;
  for (const float value : noisy.truth)
    light += double(value);
  for (size_t pixel = 0; pixel < kWidth * kHeight; ++pixel) {
    const auto apart = [&](size_t c) { return double(picture[3 * pixel + c]) - double(noisy.truth[3 * pixel + c]); };
    const double unit = double(noisy.truth[3 * pixel]) + 0.01 * light / double(noisy.truth.size());
    const double error = (0.2126 * apart(0) + 0.7152 * apart(1) + 0.0722 * apart(2)) / unit;
    sum += error * error;
  }
  return std::sqrt(sum / (kWidth * kHeight));
}

TEST(Denoised, ADenoiserThatDoesNothingChangesNothing) {
  const Noisy noisy(1, 0.02);
  const Result result = combined(noisy, each([](size_t, double value) { return value; }));
  ASSERT_EQ(result.status, LANCER_OK);
  for (size_t i = 0; i < noisy.picture.size(); ++i)
    EXPECT_NEAR(result.picture[i], noisy.picture[i], 1e-6);
  // The error is that of the noise: the picture's 19 200 squares have a spread of sqrt(2 / 19200) = 1 %, the noise's too. It is
  // relative to noisy pixels and to the lower one of a pixel and its surroundings: with noise of a fiftieth, 1 % too low.
  EXPECT_NEAR(result.error.error, true_error(noisy, noisy.picture), 0.03 * result.error.error);
  EXPECT_EQ(result.error.moved, 0.0);
}

TEST(Denoised, ADenoiserThatKnowsTheTruthIsBelieved) {
  const Noisy noisy;
  const Result result = combined(noisy, each([&](size_t i, double) { return noisy.truth[i]; }));
  const double before = true_error(noisy, noisy.picture), after = true_error(noisy, result.picture);
  EXPECT_LT(after, 0.1 * before);
  // Noise beyond its estimate counts as bias: over neighbourhoods of some 100 numbers, a tenth of the noise's power.
  EXPECT_LT(result.error.error, 0.35 * before);
}

TEST(Denoised, LightThatADenoiserMovesComesBack) {
  // The denoiser darkens the left half by 4 %, a fifth of a pixel's noise.
  const Noisy noisy;
  const auto dark = [](size_t i) { return (i / 3) % kWidth < kWidth / 2; };
  const auto denoise = each([&](size_t i, double) { return double(noisy.truth[i]) * (dark(i) ? 0.96 : 1.0); });
  const Result kept = combined(noisy, denoise, 0), result = combined(noisy, denoise);
  EXPECT_NEAR(true_error(noisy, kept.picture), 0.04 / std::sqrt(2.0), 0.002);
  EXPECT_LT(true_error(noisy, result.picture), 0.5 * true_error(noisy, kept.picture));
  // The told movement is that of blocks, whose own noise is subtracted.
  EXPECT_NEAR(kept.error.moved, 0.04 / std::sqrt(2.0), 0.004);
}

TEST(Denoised, NoDenoiserIsWorseThanManySamples) {
  // Noise of a thousandth: any bias beyond it comes back, to within the shares that doubt keeps.
  const Noisy noisy(3, 0.001);
  const Result result = combined(noisy, each([](size_t i, double) { return 0.75 + 0.1 * std::sin(0.7 * double(i / 3)); }));
  EXPECT_LT(true_error(noisy, result.picture), 1.1 * true_error(noisy, noisy.picture));
}

TEST(Denoised, APixelThatHasMissedTheLightAroundItIsDenoised) {
  // A tenth of the pixels has met a flash of light; the others and their surroundings have not, and tell no error.
  Noisy noisy(13);
  std::mt19937 random(13);
  for (size_t pixel = 0; pixel < kWidth * kHeight; ++pixel) {
    const uint32_t number = uint32_t(random());
    const float flash = number % 10 == 0 ? 1.0f : 0.0f;
    for (size_t c = 0; c < 3; ++c) {
      noisy.truth[3 * pixel + c] = 0.1f;
      noisy.picture[3 * pixel + c] = flash;
      noisy.noise[3 * pixel + c] = number & 1024 ? flash : -flash;
    }
  }
  const std::vector<float> errors(kWidth * kHeight, 0.0f);
  const Result result = combined(noisy, each([](size_t, double) { return 0.1; }), 1, 1, errors.data());
  for (size_t pixel = 0; pixel < kWidth * kHeight; ++pixel)
    EXPECT_GT(result.picture[3 * pixel], 0.03f);
}

TEST(Denoised, BrightPixelsHaveNoRingsAroundThem) {
  // Two flashes whose noise partly cancels in coarse bands: the bands of the pyramid keep different shares of them.
  Noisy noisy(17, 0.01);
  const size_t first = kWidth * 60 + 60, second = first + 4;
  for (size_t c = 0; c < 3; ++c) {
    noisy.picture[3 * first + c] += 20.0f;
    noisy.noise[3 * first + c] += 10.0f;
    noisy.picture[3 * second + c] += 20.0f;
    noisy.noise[3 * second + c] -= 15.0f;
  }
  const Result result = combined(noisy, each([&](size_t i, double) { return noisy.truth[i]; }));
  for (size_t y = 40; y <= 80; ++y)
    for (size_t x = 40; x <= 84; ++x)
      if (const size_t pixel = y * kWidth + x; pixel != first && pixel != second) {
        EXPECT_NEAR(result.picture[3 * pixel], noisy.truth[3 * pixel], 0.05f);
      }
}

TEST(Denoised, TheErrorOfAThinLightIsRelativeToTheLight) {
  // A light one pixel wide, 10 000 times as bright as its surroundings, with noise of a hundredth everywhere.
  Noisy noisy(9, 0.01);
  std::vector<float> errors(kWidth * kHeight);
  for (size_t i = 0; i < noisy.picture.size(); ++i) {
    const double light = (i / 3) % kWidth == 80 ? 100.0 : 0.01, before = double(noisy.truth[i]);
    noisy.picture[i] = float(light * (1.0 + double(noisy.picture[i]) - before));
    noisy.noise[i] = float(light * double(noisy.noise[i]));
    noisy.truth[i] = float(light);
    errors[i / 3] = float(0.01 * light);
  }
  const Result result = combined(noisy, each([](size_t, double value) { return value; }), 1, 1, errors.data());
  const double real = true_error(noisy, result.picture);
  // 19 200 squares have a spread of 1 %, those of the noise as well; the known part of the light is three errors, 3 %, lower.
  EXPECT_NEAR(result.error.error, real, 0.05 * real);
  EXPECT_LT(result.error.high, 2.0 * real);
}

TEST(Denoised, TheIntervalHoldsTheErrorOfASingleBrightPixel) {
  // A sample of 200 that the denoiser leaves may be a small light or an error: relative to itself it is 1, to the truth 200.
  Noisy noisy(11, 0.001);
  for (size_t c = 0; c < 3; ++c)
    noisy.picture[3 * (kWidth * 60 + 61) + c] += noisy.noise[3 * (kWidth * 60 + 61) + c] = 200.0f;
  const std::vector<float> errors(kWidth * kHeight, 0.1f);
  const Result result = combined(noisy, each([](size_t, double value) { return value; }), 1, 1, errors.data());
  const double as_error = true_error(noisy, result.picture), as_light = std::sqrt(1.0 / (kWidth * kHeight));
  EXPECT_GT(as_error, 1.0);
  EXPECT_LT(result.error.low, as_light);
  EXPECT_GT(result.error.high, as_error);
  EXPECT_NEAR(result.error.error, std::sqrt(as_error * as_light), 0.3 * result.error.error);
}

TEST(Denoised, BarsHoldTheTruth) {
  // A filter whose result has as much noise as is common to it and to the picture, like a network's: a 49th of the power.
  double pixels = 0.0, blocks = 0.0;
  constexpr uint32_t kBlock = 8;
  const Noisy noisy(7);
  const Result result = combined(noisy, blurred), of_blocks = combined(noisy, blurred, 1, kBlock);
  std::vector<double> apart(of_blocks.bars.size());
  for (size_t pixel = 0; pixel < kWidth * kHeight; ++pixel) {
    const float *color = result.picture.data() + 3 * pixel;
    const double error =
        0.2126 * double(color[0]) + 0.7152 * double(color[1]) + 0.0722 * double(color[2]) - double(float(level(pixel)));
    pixels += std::abs(error) <= 1.96 * double(result.bars[pixel]);
    apart[pixel / kWidth / kBlock * (kWidth / kBlock) + pixel % kWidth / kBlock] += error / (kBlock * kBlock);
  }
  for (size_t i = 0; i < apart.size(); ++i)
    blocks += std::abs(apart[i]) <= 1.96 * double(of_blocks.bars[i]);
  EXPECT_GT(pixels / (kWidth * kHeight), 0.92);
  EXPECT_GT(blocks / double(apart.size()), 0.92);
  // Squared errors are not negative, so that noise of their estimate counts as error: it is told twice as large at most.
  EXPECT_GT(result.error.error, true_error(noisy, result.picture));
  EXPECT_LT(result.error.error, 2.0 * true_error(noisy, result.picture));
}

TEST(Denoised, ScaleDoesNotMatter) {
  const auto scaled = [](double scale) {
    Noisy noisy;
    for (Picture *picture : {&noisy.truth, &noisy.picture, &noisy.noise})
      for (float &value : *picture)
        value = float(double(value) * scale);
    return combined(noisy,
                    each([&](size_t i, double value) { return noisy.truth[i] + 0.2 * (value - double(noisy.truth[i])); }));
  };
  const Result one = scaled(1.0);
  for (const double scale : {0x1p-100, 0x1p100}) {
    const Result other = scaled(scale);
    EXPECT_EQ(other.error.error, one.error.error);
    EXPECT_EQ(other.picture[1234], float(double(one.picture[1234]) * scale));
    EXPECT_EQ(other.bars[1234], float(double(one.bars[1234]) * scale));
  }
  Noisy black;
  for (Picture *picture : {&black.truth, &black.picture, &black.noise})
    std::fill(picture->begin(), picture->end(), 0.0f);
  const Result result = combined(black, each([](size_t, double value) { return value; }));
  EXPECT_EQ(result.error.error, 0.0);
  EXPECT_EQ(result.error.high, 0.0);
}

TEST(Denoised, WrongInputsAreRefused) {
  Noisy noisy;
  Picture out(noisy.picture.size());
  std::vector<float> bars(kWidth * kHeight);
  lancer_denoised_error error;
  const auto refused = [&](uint32_t width, const float *first, double step, uint32_t combines, double confidence,
                           uint32_t block) {
    return lancer_combine_denoised(width, kHeight, noisy.picture.data(), noisy.noise.data(), nullptr, first, first, step,
                                   combines, confidence, block, out.data(), bars.data(), &error);
  };
  const float *const first = noisy.truth.data();
  EXPECT_EQ(refused(kWidth, first, kStep, 1, 0.95, 1), LANCER_OK);
  EXPECT_EQ(refused(0, first, kStep, 1, 0.95, 1), LANCER_ERROR_ARGUMENT);
  EXPECT_EQ(refused(~0u, first, kStep, 1, 0.95, 1), LANCER_ERROR_ARGUMENT);
  EXPECT_EQ(refused(kWidth, nullptr, kStep, 1, 0.95, 1), LANCER_ERROR_ARGUMENT);
  for (const double step : {0.0, -1.0, 1.5, std::nan("")})
    EXPECT_EQ(refused(kWidth, first, step, 1, 0.95, 1), LANCER_ERROR_ARGUMENT) << step;
  EXPECT_EQ(refused(kWidth, first, kStep, 2, 0.95, 1), LANCER_ERROR_ARGUMENT);
  EXPECT_EQ(refused(kWidth, first, kStep, 1, 1.0, 1), LANCER_ERROR_ARGUMENT);
  EXPECT_EQ(refused(kWidth, first, kStep, 1, 0.95, 0), LANCER_ERROR_ARGUMENT);
  noisy.noise[17] = INFINITY;
  EXPECT_EQ(refused(kWidth, first, kStep, 1, 0.95, 1), LANCER_ERROR_ARGUMENT);
  EXPECT_STREQ(lancer_last_error(), "combine_denoised: noise is not finite everywhere");
}

} // namespace
