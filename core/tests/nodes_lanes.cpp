// Each formula of a node gives the bits of one place in the lanes of each instruction set, on one instance or on several.
#include "nodes/run.h"
#include "nodes_cases.h"
#include "widths/each_kernel.h"

#include <bit>

namespace lancer_test {
namespace {

// Of numbers; what is none counts as one, whatever its digits.
uint32_t bits_of(float x) { return x != x ? 0x7fc00000u : std::bit_cast<uint32_t>(x); }

class NodesLanes : public ::testing::Test {
protected:
  Random random{7};
  NodeWorld world{random};
  const DescribedGeometry geometry{world.description};
  NodeBlock block{};
  std::vector<NodeContext> places = std::vector<NodeContext>(kBlockLanes);
  std::vector<Surface> surfaces = std::vector<Surface>(kBlockLanes);

  void SetUp() override { block.scene = {&geometry, &world.normalisation, &world.camera}; }

  template <class T> static void put(const glm::vec<3, T> &v, T (&to)[3][kBlockLanes], int lane) {
    for (int axis = 0; axis < 3; ++axis)
      to[axis][lane] = v[axis];
  }

  // Surfaces of one instance or of several, or directions of the world.
  void fill(bool on_surfaces, bool one_instance) {
    block.surface = on_surfaces;
    block.used = random() % 3 ? 0xffff : random() | 1u << random() % 16;
    block.used &= 0xffff;
    block.backfacing = 0;
    const uint32_t instance = random() % 5;
    for (int i = 0; i < kBlockLanes; ++i) {
      NodeContext &at = places[size_t(i)];
      at = {};
      static_cast<NodeScene &>(at) = block.scene;
      at.wo = any_direction(random);
      block.kinds[i] = at.path.kinds = random() & 0xff;
      LightPath<float> &path = at.path;
      const struct {
        float &one, &lane;
      } counts[] = {{path.length, block.length[i]},
                    {path.depth, block.depth[i]},
                    {path.diffuse, block.diffuse[i]},
                    {path.glossy, block.glossy[i]},
                    {path.transmission, block.transmission[i]},
                    {path.transparent, block.transparent[i]},
                    {path.portal, block.portal[i]}};
      for (const auto &count : counts)
        count.one = count.lane = uniform_number(random, 0.0f, 10.0f);
      if (!on_surfaces) {
        put(glm::dvec3(-glm::dvec3(at.wo)), block.p, i);
        put(at.wo, block.wo, i);
        put(at.wo, block.ns, i);
        put(at.wo, block.ng, i);
        block.eye[i] = at.eye = nullptr;
        continue;
      }
      surfaces[size_t(i)] = world.surface(random, one_instance ? instance : random() % 5);
      const Surface &s = surfaces[size_t(i)];
      at.surface = &s;
      at.footprint = random() % 8 ? uniform_number(random, 0.0f, 0.2f) : 0.0f;
      const bool behind = glm::dot(s.ng, at.wo) < 0.0f;
      block.backfacing |= behind ? 1u << i : 0u;
      block.instance[i] = s.instance;
      block.primitive[i] = s.primitive;
      block.bary[0][i] = s.bary.x;
      block.bary[1][i] = s.bary.y;
      block.footprint[i] = at.footprint;
      put(s.p, block.p, i);
      put(behind ? -s.ns : s.ns, block.ns, i);
      put(behind ? -s.ng : s.ng, block.ng, i);
      put(at.wo, block.wo, i);
    }
    // Unused registers may hold anything.
    for (int i = 0; i < kBlockLanes; ++i)
      if (!(block.used >> i & 1)) {
        block.instance[i] = block.primitive[i] = 0xdeadbeef;
        block.bary[0][i] = block.p[1][i] = NAN;
        block.ns[2][i] = INFINITY;
        block.footprint[i] = NAN;
      }
  }

  // Runs the last node on any values of the nodes before it. Every kernel has to agree with one place at a time.
  void compare(const NodeCase &made) {
    const Program program = read_program(world.description.images, "test", made.nodes.data(), uint32_t(made.nodes.size()));
    const Schedule schedule{uint16_t(made.nodes.size() - 1)};
    std::vector<NodeLanes> given(made.nodes.size());
    for (NodeLanes &values : given)
      for (auto &component : values.of)
        for (float &x : component)
          x = any_number(random);
    std::vector<glm::vec4> want;
    for (int i = 0; i < kBlockLanes; ++i) {
      std::vector<glm::vec4> values;
      for (const NodeLanes &of : given)
        values.push_back({of.of[0][i], of.of[1][i], of.of[2][i], of.of[3][i]});
      if (block.used >> i & 1)
        run(program, schedule, places[size_t(i)], values);
      want.push_back(values.back());
    }
    for (const NodeKernel *kernel : LANCER_EACH_KERNEL(node_kernel)) {
      std::vector<NodeLanes> values = given;
      kernel->run(program, schedule, block, values.data());
      for (int i = 0; i < kBlockLanes; ++i)
        for (int k = 0; k < 4; ++k)
          if (block.used >> i & 1) {
            ASSERT_EQ(bits_of(values.back().of[k][i]), bits_of(want[size_t(i)][k]))
                << "lane " << i << ", component " << k << " of " << kernel->name << ": " << values.back().of[k][i] << " for "
                << want[size_t(i)][k];
          }
      // Other nodes keep their values, also those of a bump's height.
      for (size_t of = 0; of + 1 < values.size(); ++of)
        for (int i = 0; i < kBlockLanes; ++i)
          if (block.used >> i & 1) {
            ASSERT_EQ(bits_of(values[of].of[0][i]), bits_of(given[of].of[0][i])) << "node " << of << " of " << kernel->name;
          }
    }
  }
};

TEST_F(NodesLanes, EveryFormulaInEveryKernel) {
  for (const NodeCase &made : all_cases(random)) {
    SCOPED_TRACE(made.name);
    for (int round = 0; round < 6; ++round) {
      fill(round != 3, round % 2);
      ASSERT_NO_FATAL_FAILURE(compare(made));
    }
  }
}

} // namespace
} // namespace lancer_test
