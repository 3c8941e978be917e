// The node VOXELS: cubes of voxels against sums in double precision, and what is no cube.
#include "nodes_cases.h"

#include "nodes/voxels.h"

#include <array>
#include <cmath>

namespace lancer_test {
namespace {

using Voxel = std::array<double, 4>;

// A cube of any values from 0 to 1, as an image.
struct Cube {
  uint32_t side;
  std::vector<float> texels;

  Cube(uint32_t n, Random &random) : side(n), texels(size_t(n) * n * n * 4) {
    for (float &x : texels)
      x = uniform_number(random, 0.0f, 1.0f);
  }

  Image image() const { return kept_image(image_of(texels, side, side * side)); }

  // The voxel at any indices; 0 outside.
  Voxel at(int x, int y, int z) const {
    const int n = int(side);
    if (std::min({x, y, z}) < 0 || std::max({x, y, z}) >= n)
      return {};
    const float *found = &texels[size_t((z * n + y) * n + x) * 4];
    return {found[0], found[1], found[2], found[3]};
  }
};

// The weights of the voxels from floor(place) - 1 on.
std::array<double, 4> weights(double part, Interpolation interpolation) {
  const double s = 1.0 - part;
  if (interpolation == Interpolation::Linear)
    return {0.0, s, part, 0.0};
  return {s * s * s / 6.0, (4.0 - 6.0 * part * part + 3.0 * part * part * part) / 6.0,
          (4.0 - 6.0 * s * s + 3.0 * s * s * s) / 6.0, part * part * part / 6.0};
}

Voxel expected(const Cube &cube, const glm::vec3 &p, Interpolation interpolation) {
  const glm::dvec3 place = glm::dvec3(p) * double(cube.side);
  if (interpolation == Interpolation::Closest)
    return cube.at(int(std::floor(place.x)), int(std::floor(place.y)), int(std::floor(place.z)));
  const glm::dvec3 low = glm::floor(place - 0.5), part = place - 0.5 - low;
  std::array<double, 4> along[3];
  for (int axis = 0; axis < 3; ++axis)
    along[axis] = weights(part[axis], interpolation);
  Voxel sum{};
  for (int z = 0; z < 4; ++z)
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 4; ++x) {
        const Voxel voxel = cube.at(int(low.x) + x - 1, int(low.y) + y - 1, int(low.z) + z - 1);
        for (size_t c = 0; c < 4; ++c)
          sum[c] += along[0][size_t(x)] * along[1][size_t(y)] * along[2][size_t(z)] * voxel[c];
      }
  return sum;
}

Voxel found(const Image &image, const glm::vec3 &p, Interpolation interpolation) {
  const Texel<float> texel = look_up_voxels<float>(voxel_level(image, uint32_t(interpolation)), Vector3<float>{p.x, p.y, p.z});
  return {texel.color.x, texel.color.y, texel.color.z, texel.alpha};
}

const Interpolation kInterpolations[] = {Interpolation::Closest, Interpolation::Linear, Interpolation::Cubic};

TEST(NodesVoxels, InterpolateAlongThreeAxes) {
  Random random{3};
  for (const uint32_t side : {1u, 2u, 5u}) {
    Cube cube(side, random);
    const Image image = cube.image();
    for (int i = 0; i < 2000; ++i) {
      // Inside, across each border, and beyond.
      glm::vec3 p;
      for (int axis = 0; axis < 3; ++axis)
        p[axis] = uniform_number(random, -0.6f, 1.6f);
      for (const Interpolation interpolation : kInterpolations) {
        const Voxel want = expected(cube, p, interpolation), got = found(image, p, interpolation);
        for (size_t c = 0; c < 4; ++c)
          // A place of at most 8 voxels has two roundings of 2^-22, along each axis, where values change by at most 1; 64
          // terms of at most 1 in all have fewer than 8 roundings of 2^-24 each.
          EXPECT_NEAR(got[c], want[c], 6.0 * 0x1p-22 + 8.0 * 0x1p-24) << side << " at " << p.x << ", " << p.y << ", " << p.z;
      }
    }
  }
}

TEST(NodesVoxels, OutsideAndNowhereIsNothing) {
  Random random{4};
  Cube cube(4, random);
  const Image image = cube.image();
  for (const Interpolation interpolation : kInterpolations)
    for (int axis = 0; axis < 3; ++axis)
      for (const float away : {-1.0f, 2.0f, 1e30f, -1e30f, NAN, INFINITY, -INFINITY}) {
        glm::vec3 p(0.4f, 0.5f, 0.6f);
        EXPECT_NE(found(image, p, interpolation), Voxel{});
        p[axis] = away;
        EXPECT_EQ(found(image, p, interpolation), Voxel{}) << away;
      }
}

TEST(NodesVoxels, VoxelsThatAreNoNumbersHideTheirNeighboursAlone) {
  Random random{5};
  Cube cube(4, random);
  cube.texels[0] = NAN;
  const Image image = cube.image();
  for (const Interpolation interpolation : kInterpolations) {
    EXPECT_EQ(found(image, glm::vec3(0.125f), interpolation), Voxel{});
    EXPECT_NE(found(image, glm::vec3(0.875f), interpolation), Voxel{});
  }
}

TEST(NodesVoxels, ReturnColorAndDensity) {
  Random random{6};
  Cube cube(3, random);
  Stage stage;
  add_image(stage.description, image_of(cube.texels, 3, 9));
  const glm::vec4 got = stage.value({node(LANCER_NODE_VOXELS, LANCER_INTERPOLATE_CLOSEST, {constant(0.5f, 0.9f, 0.1f)})});
  const Voxel want = cube.at(1, 2, 0);
  for (int c = 0; c < 4; ++c)
    EXPECT_EQ(double(got[c]), want[size_t(c)]);
}

TEST(NodesVoxels, RefuseWhatIsNoCube) {
  const auto refused = [](uint32_t width, uint32_t height, uint32_t channels) {
    Stage stage;
    const std::vector<float> texels(size_t(width) * height * channels);
    add_image(stage.description, image_of(texels, width, height, channels));
    try {
      stage.value({node(LANCER_NODE_VOXELS)});
    } catch (const Error &error) {
      EXPECT_NE(std::string(error.what()).find("is not a cube"), std::string::npos) << error.what();
      return true;
    }
    return false;
  };
  EXPECT_FALSE(refused(1, 1, 4));
  EXPECT_FALSE(refused(2, 4, 4));
  EXPECT_TRUE(refused(2, 2, 4));
  EXPECT_TRUE(refused(4, 2, 4));
  EXPECT_TRUE(refused(2, 4, 3));
}

} // namespace
} // namespace lancer_test
