// Schedules of nodes, and rejected programs.
#include "nodes_lab.h"

#include <cmath>

using namespace lancer_test;

namespace {

Schedule schedule_of(const std::vector<lancer_node> &nodes, std::vector<int32_t> wanted) {
  const Program program = read_program({}, "test", nodes.data(), uint32_t(nodes.size()));
  std::vector<Parameter> parameters;
  for (const int32_t number : wanted) {
    parameters.emplace_back();
    parameters.back().node = number;
  }
  return program.schedule(parameters);
}

lancer_node add(lancer_parameter a, lancer_parameter b = constant(1.0f)) {
  return node(LANCER_NODE_MATH, LANCER_MATH_ADD, {a, b});
}

TEST(NodesProgram, RunsOnlyWhatIsNeededInOrder) {
  const std::vector<lancer_node> nodes = {node(LANCER_NODE_COORDINATE), add(result_of(0)), add(result_of(0)),
                                          add(result_of(1), result_of(1)), add(constant(2.0f))};
  EXPECT_EQ(schedule_of(nodes, {3}), (Schedule{0, 1, 3}));
  EXPECT_EQ(schedule_of(nodes, {2}), (Schedule{0, 2}));
  EXPECT_EQ(schedule_of(nodes, {4}), (Schedule{4}));
  EXPECT_EQ(schedule_of(nodes, {2, 3}), (Schedule{0, 1, 2, 3}));
  EXPECT_EQ(schedule_of(nodes, {-1}), Schedule{});
  EXPECT_EQ(schedule_of(nodes, {}), Schedule{});
}

TEST(NodesProgram, ABumpKeepsItsHeightToItself) {
  lancer_node bump = node(LANCER_NODE_BUMP, 0, {constant(1.0f), result_of(1), result_of(3), constant(0.0f), constant(1.0f)});
  bump.first = 2;
  // 0 is an input of the height from outside, 1 the distance; 2 and 3 belong to the bump.
  const std::vector<lancer_node> nodes = {add(constant(0.0f)), add(constant(0.0f)), node(LANCER_NODE_COORDINATE),
                                          add(result_of(2), result_of(0)), bump};
  EXPECT_EQ(schedule_of(nodes, {4}), (Schedule{0, 1, 4}));
  EXPECT_EQ(schedule_of(nodes, {3, 4}), (Schedule{0, 1, 2, 3, 4}));
  const Program program = read_program({}, "test", nodes.data(), 5);
  const ScheduleView heights = ProgramView(program).heights_of(program.nodes[4]);
  ASSERT_EQ(program.height_nodes.size(), heights.size());
  EXPECT_EQ(Schedule(heights.begin(), heights.end()), (Schedule{2, 3}));
}

TEST(NodesProgram, InputsThatAKindDoesNotReadAreNotRun) {
  const std::vector<lancer_node> nodes = {add(constant(0.0f)), node(LANCER_NODE_SEPARATE, 0, {constant(1.0f), result_of(0)})};
  EXPECT_EQ(schedule_of(nodes, {1}), (Schedule{1}));
}

// Returns the error message of a program of one valid and one given node; an empty string if it is accepted.
std::string refusal(const lancer_node &bad) {
  Description description;
  add_gradient(description, 2, 2);
  const std::vector<lancer_node> nodes = {node(LANCER_NODE_COORDINATE), bad};
  try {
    read_program(description.images, "material 'Wood'", nodes.data(), 2);
  } catch (const Error &error) {
    EXPECT_EQ(error.fault(), Fault::Argument);
    return error.what();
  }
  return "";
}

TEST(NodesProgram, RefusalsNameMaterialNodeAndValue) {
  EXPECT_EQ(refusal(add(result_of(0))), "");
  EXPECT_EQ(refusal(node(LANCER_NODE_COUNT)),
            "material 'Wood': node 1: kind " + std::to_string(LANCER_NODE_COUNT) + " is unknown");
  EXPECT_EQ(refusal(node(LANCER_NODE_MATH, LANCER_MATH_COUNT)), "material 'Wood': node 1: option 41 >= 41 options");
  for (const uint32_t kind : {LANCER_NODE_OCCLUSION, LANCER_NODE_BEVEL}) {
    EXPECT_EQ(refusal(node(kind, LANCER_MOST_NODE_RAYS)), "");
    EXPECT_EQ(refusal(node(kind, 129)), "material 'Wood': node 1: option 129 >= 129 options");
  }
  EXPECT_EQ(refusal(add(result_of(1))), "material 'Wood': node 1: input 0 refers to node 1, which does not precede it");
  EXPECT_EQ(refusal(add(result_of(-2))), "material 'Wood': node 1: input 0 refers to node -2, which does not precede it");
  EXPECT_EQ(refusal(add(constant(0.0f), constant(0.0f, NAN, 0.0f))), "material 'Wood': node 1: input 1 is nan");
  EXPECT_EQ(refusal(add(constant(INFINITY))), "material 'Wood': node 1: input 0 is inf");
  lancer_node bad = node(LANCER_NODE_TRANSFORM);
  bad.matrix[7] = INFINITY;
  EXPECT_EQ(refusal(bad), "material 'Wood': node 1: matrix contains inf");
  bad = node(LANCER_NODE_IMAGE);
  bad.image = 1;
  bad.image_count = 1;
  EXPECT_EQ(refusal(bad), "material 'Wood': node 1: images 1 + 1 > 1 images");
  bad.image = UINT32_MAX;
  EXPECT_NE(refusal(bad), "");
  EXPECT_NE(refusal(flagged(node(LANCER_NODE_IMAGE), 4)), "");
  EXPECT_NE(refusal(flagged(node(LANCER_NODE_IMAGE), 3 << 4)), "");
  bad = node(LANCER_NODE_ENVIRONMENT, LANCER_ENVIRONMENT_CUBE);
  bad.image_count = 1;
  EXPECT_EQ(refusal(bad), "material 'Wood': node 1: 1 images for the 6 sides of a cube");
  EXPECT_EQ(refusal(flagged(node(LANCER_NODE_IMAGE), 1024)),
            "material 'Wood': node 1: flags 1024 has bits beyond the last flag");
  EXPECT_NE(refusal(flagged(node(LANCER_NODE_BUMP), 8)), "");
  EXPECT_NE(refusal(flagged(node(LANCER_NODE_SEPARATE), 1)), "");
  bad = node(LANCER_NODE_BUMP);
  bad.first = 2;
  EXPECT_EQ(refusal(bad), "material 'Wood': node 1: first 2 is a later node");
  EXPECT_THROW(read_program({}, "x", nullptr, 1), Error);
  EXPECT_THROW(read_program({}, "x", &bad, 4097), Error);
}

lancer_material plain(const lancer_lobe &lobe) {
  lancer_material material = black();
  material.name = "Wood";
  material.lobes = &lobe;
  material.lobe_count = 1;
  return material;
}

lancer_lobe diffuse() {
  lancer_lobe lobe = {};
  lobe.kind = LANCER_DIFFUSE;
  lobe.weight = constant(1.0f);
  lobe.color = constant(0.5f);
  lobe.roughness = lobe.ior = lobe.shininess = lobe.edge = lobe.anisotropy = lobe.rotation = lobe.normal = lobe.tangent =
      lobe.roughness_across = lobe.offset = lobe.film_thickness = constant(0.0f);
  lobe.film_ior = constant(1.33f);
  return lobe;
}

TEST(NodesProgram, MaterialsScheduleByQuestion) {
  const std::vector<lancer_node> nodes = {node(LANCER_NODE_COORDINATE), add(result_of(0)), add(constant(1.0f)),
                                          add(constant(2.0f)), add(constant(3.0f))};
  lancer_lobe lobe = diffuse();
  lobe.color = result_of(1);
  lancer_material source = plain(lobe);
  source.nodes = nodes.data();
  source.node_count = 5;
  source.emission = result_of(2);
  source.transmittance = result_of(3);
  source.displacement = result_of(4);
  Description description;
  add_material(description, source);
  const Material &material = *description.materials[0];
  EXPECT_EQ(material.surface_nodes, (Schedule{0, 1, 2, 3}));
  EXPECT_EQ(material.emission_nodes, (Schedule{2}));
  EXPECT_EQ(material.transmittance_nodes, (Schedule{3}));
  EXPECT_EQ(material.displacement_nodes, (Schedule{4}));
  EXPECT_TRUE(material.emits() && material.is_transparent() && material.displaces());
}

TEST(NodesProgram, MaterialsThatAreRefused) {
  const auto refused = [](const lancer_lobe &lobe) {
    Description description;
    const lancer_material material = plain(lobe);
    try {
      add_material(description, material);
    } catch (const Error &) {
      return description.materials.empty();
    }
    return false;
  };
  EXPECT_FALSE(refused(diffuse()));
  lancer_lobe lobe = diffuse();
  lobe.color = result_of(0);
  EXPECT_TRUE(refused(lobe));
  lobe = diffuse();
  lobe.kind = LANCER_LOBE_KIND_COUNT;
  EXPECT_TRUE(refused(lobe));
  lobe = diffuse();
  lobe.kind = LANCER_PRINCIPLED;
  EXPECT_TRUE(refused(lobe));
  lobe = diffuse();
  lobe.distribution = 4;
  EXPECT_TRUE(refused(lobe));
}

TEST(NodesProgram, ARefusedMaterialSaysNothing) {
  lancer_lobe lobes[2] = {diffuse(), diffuse()};
  lobes[0].roughness = constant(7.0f);
  lobes[1].color = result_of(3);
  lancer_material material = plain(lobes[0]);
  material.lobe_count = 2;
  Description description;
  EXPECT_THROW(add_material(description, material), Error);
  EXPECT_EQ(description.messages(), "");
  material.lobe_count = 1;
  add_material(description, material);
  EXPECT_EQ(description.messages(), "material 'Wood': roughness 7 was replaced by 1\n");
}

TEST(NodesProgram, ValuesOfNodesAreBroughtIntoRange) {
  LobeDescription lobe;
  lobe.kind = LobeKind::Glossy;
  for (Parameter *parameter : {&lobe.weight, &lobe.color, &lobe.roughness, &lobe.ior, &lobe.anisotropy, &lobe.normal})
    parameter->node = 0;
  const auto at = [&](float value) {
    const glm::vec4 values(value);
    return evaluate(lobe, std::span(&values, 1));
  };
  const LobeInputs<float> low = at(-3.0f), high = at(7.0f), none = at(NAN);
  EXPECT_EQ(low.color, glm::vec3(0.0f));
  EXPECT_EQ(low.roughness, 0.0f);
  EXPECT_EQ(low.ior, 1e-5f);
  EXPECT_EQ(low.anisotropy, -0.99f);
  EXPECT_EQ(high.color, glm::vec3(7.0f));
  EXPECT_EQ(high.roughness, 1.0f);
  EXPECT_EQ(high.anisotropy, 0.99f);
  EXPECT_NEAR(glm::length(high.normal), 1.0f, 1e-6f);
  EXPECT_EQ(none.color, glm::vec3(0.0f));
  EXPECT_EQ(none.weight, glm::vec3(0.0f));
  EXPECT_EQ(none.roughness, 0.0f);
  EXPECT_EQ(none.normal, glm::vec3(0.0f));
}

TEST(NodesProgram, MeshAttributesThatAreRefused) {
  const float values[12] = {};
  const auto refused = [&](const lancer_attribute &attribute) {
    lancer_mesh mesh = Stage::triangle();
    mesh.attributes = &attribute;
    mesh.attribute_count = 1;
    Description description;
    try {
      add_mesh(description, mesh);
    } catch (const Error &) {
      return description.meshes.empty();
    }
    return false;
  };
  EXPECT_FALSE(refused({"a", values, LANCER_DOMAIN_CORNER, 4}));
  EXPECT_TRUE(refused({"a", values, 3, 4}));
  EXPECT_TRUE(refused({"a", values, LANCER_DOMAIN_CORNER, 0}));
  EXPECT_TRUE(refused({"a", values, LANCER_DOMAIN_CORNER, 5}));
  EXPECT_TRUE(refused({"a", nullptr, LANCER_DOMAIN_CORNER, 4}));
  EXPECT_TRUE(refused({nullptr, values, LANCER_DOMAIN_CORNER, 4}));
  EXPECT_TRUE(refused({"", values, LANCER_DOMAIN_CORNER, 4}));
}

} // namespace
