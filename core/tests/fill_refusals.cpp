// Errors and messages of fill calls, except those with tests for nodes and images.
#include "nodes_lab.h"

#include "bsdf/lobe.h"
#include "compile/features.h"
#include "compile/steps.h"
#include "lancer_probes.h"
#include "tiny_scene.h"

#include <cmath>
#include <cstring>

using namespace lancer_test;

namespace {

// Returns the message of an error; an empty string without one.
template <class Fill> std::string refusal(Fill &&fill) {
  Description description;
  try {
    fill(description);
  } catch (const Error &error) {
    EXPECT_EQ(error.fault(), Fault::Argument);
    return error.what();
  }
  return "";
}

TEST(FillRefusals, UnknownBits) {
  const auto world = [](uint32_t hidden_from) {
    return refusal([&](Description &description) {
      lancer_world w = {};
      w.radiance = constant(1.0f);
      w.hidden_from = hidden_from;
      set_world(description, w);
    });
  };
  EXPECT_EQ(world(63), "");
  EXPECT_EQ(world(128), "world: hidden_from 128 has bits beyond the last kind of ray");
  const auto light = [](uint32_t hidden_from) {
    return refusal([&](Description &description) {
      lancer_light l = point_light();
      l.hidden_from = hidden_from;
      add_light(description, l);
    });
  };
  EXPECT_EQ(light(63), "");
  EXPECT_EQ(light(0x80000000u), "light 'lamp': hidden_from 2147483648 has bits beyond the last kind of ray");
  const auto material = [](uint32_t flags) {
    return refusal([&](Description &description) {
      lancer_material m = black();
      m.name = "Wood";
      m.flags = flags;
      lancer::add_material(description, m);
    });
  };
  EXPECT_EQ(material(15), "");
  EXPECT_EQ(material(16), "material 'Wood': flags 16 has bits beyond the last flag");
}

TEST(FillRefusals, TheLongestListOfFeaturesFits) {
  const std::string all = feature_names({UINT32_MAX, UINT32_MAX}) + " lens";
  EXPECT_NE(all.find("glass"), std::string::npos);
  EXPECT_LT(all.size(), sizeof(lancer_statistics::features));
}

TEST(FillRefusals, ProbesWantFiniteDirections) {
  const lancer_scene scene = make_scene();
  const double points[3] = {0, 0, 1};
  float radiance[3], pdf = 0.0f;
  for (const double bad : {double(NAN), double(INFINITY)}) {
    const double wi[3] = {0.0, bad, 0.0};
    EXPECT_EQ(lancer_probe_world(scene, 1, wi, radiance, &pdf), LANCER_ERROR_ARGUMENT);
    EXPECT_EQ(std::string(lancer_last_error()).rfind("probe: direction 0 holds ", 0), 0u) << lancer_last_error();
    EXPECT_EQ(lancer_probe_light_pdf(scene, 0, 1, points, wi, &pdf), LANCER_ERROR_ARGUMENT);
  }
  const double up[3] = {0.0, 0.0, 1.0};
  EXPECT_EQ(lancer_probe_world(scene, 1, up, radiance, &pdf), LANCER_OK);
  lancer_scene_destroy(scene);
}

// Returns a material of lobes of one kind, each with its own normal; commit's messages about it go to the description.
Material many(uint32_t count, const lancer_lobe &lobe, Description &description) {
  std::vector<lancer_lobe> lobes(count, lobe);
  for (uint32_t i = 0; i < count; ++i)
    lobes[i].normal = constant(1.0f, 0.0f, float(i));
  lancer_material material = black();
  material.name = "Wood";
  material.lobes = lobes.data();
  material.lobe_count = count;
  lancer::add_material(description, material);
  report_limits(label("material", material.name, 0), *description.materials.back(), description.made_messages);
  return *description.materials.back();
}

TEST(MaterialRoom, MoreNormalsThanABsdfHoldsAreSaid) {
  // The shading normal is always there.
  Description few;
  EXPECT_EQ(demand_of(many(kMaxFrames - 1, lobe(LANCER_DIFFUSE, 0.5f), few)).frames, size_t(kMaxFrames));
  EXPECT_EQ(few.messages(), "");
  Description description;
  const MaterialDemand demand = demand_of(many(kMaxFrames, lobe(LANCER_GLOSSY, 0.5f), description));
  EXPECT_EQ(demand.frames, size_t(kMaxFrames) + 1);
  EXPECT_EQ(demand.lobes, size_t(kMaxFrames));
  const std::string most = std::to_string(kMaxFrames), more = std::to_string(kMaxFrames + 1);
  EXPECT_EQ(description.messages(), "material 'Wood': " + more + " normals may overlap in one place; lobes beyond the first " +
                                        most + " normals use the shading normal, and fibres among them are left out\n");
}

lancer_principled all_layers(uint32_t rules) {
  lancer_principled p;
  std::memset(&p, 0, sizeof p);
#define LANCER_HALF(kind, name, spoken, given) p.name = constant(0.5f);
  LANCER_PRINCIPLED_PARAMETERS(LANCER_HALF)
#undef LANCER_HALF
  p.rules = rules;
  p.coat_normal = p.thin_wall = constant(0.0f);
  p.coat_ior = p.ior = constant(1.5f);
  return p;
}

TEST(MaterialRoom, PrincipledCountsItsLayers) {
  for (const uint32_t rules : {LANCER_RULES_BLENDER_3, LANCER_RULES_BLENDER_45}) {
    const lancer_principled principled = all_layers(rules);
    lancer_lobe layered = lobe(LANCER_PRINCIPLED, 0.5f);
    layered.rules = rules;
    layered.principled = &principled;
    Description description;
    // Sheen, coat, metal, glass, plastic and matte; 3: matte, sheen, gloss, two of glass, coat. Light below the surface: that
    // which walks and that which does not; 3: also that which returns.
    const size_t count = rules == LANCER_RULES_BLENDER_3 ? 9 : 8;
    EXPECT_EQ(demand_of(many(1, layered, description)).lobes, count);
    EXPECT_EQ(description.messages(), "");
    // Frames: the shading normal; 4: those of cloth, coat, anisotropic and matt lobes; 3: those of coat, anisotropic lobes and
    // glass.
    EXPECT_EQ(demand_of(*description.materials[0]).frames, rules == LANCER_RULES_BLENDER_3 ? 4u : 5u);
    const Material twelve = many(12, layered, description);
    EXPECT_EQ(demand_of(twelve).lobes, 12 * count);
    const std::string told =
        "material 'Wood': " + std::to_string(12 * count) + " lobes may overlap in one place; only the first 64";
    EXPECT_NE(description.messages().find(told + " are used\n"), std::string::npos);
  }
}

} // namespace
