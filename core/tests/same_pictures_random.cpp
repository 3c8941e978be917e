// Forty scenes of random lobes, nodes, shapes, lights and settings: the bits of all their passes, the same from every
// instruction set and number of lanes.
#include "bits_stand.h"

namespace lancer_test {
namespace {

// Nodes that make numbers of about 0 ... 1 of the place: a colour, a roughness and a normal.
struct RandomNodes {
  std::vector<lancer_node> nodes;
  lancer_parameter color, number, normal = parameter(0.0f);

  explicit RandomNodes(Dice &dice) {
    const auto add = [&](const lancer_node &one) {
      nodes.push_back(one);
      return result_of(int32_t(nodes.size()) - 1);
    };
    const uint32_t kinds[] = {LANCER_COORDINATE_GENERATED, LANCER_COORDINATE_POSITION, LANCER_COORDINATE_OBJECT};
    const lancer_parameter place = add(node(LANCER_NODE_COORDINATE, kinds[dice() % 3]));
    const lancer_parameter scale = parameter(1.0f + 8.0f * dice.share());
    switch (dice() % 4) {
    case 0:
      color = add(node(LANCER_NODE_NOISE, 0,
                       {place, parameter(dice.share()), scale, parameter(dice.share()), parameter(float(dice() % 4)),
                        parameter(0.5f), parameter(2.0f)},
                       2));
      break;
    case 1:
      color = add(node(LANCER_NODE_VORONOI, 0, {place, parameter(0.0f), scale, parameter(dice.share())}, 2));
      break;
    case 2:
      color = add(node(LANCER_NODE_GRADIENT, dice() % 3, {place}));
      break;
    default:
      color = add(node(LANCER_NODE_MIX, 0, {parameter(dice.share()), place, dice.color()}, 1));
      break;
    }
    const lancer_parameter grey = add(node(LANCER_NODE_SEPARATE, dice() % 3, {color}));
    number = add(node(LANCER_NODE_MATH, LANCER_MATH_MULTIPLY, {grey, parameter(dice.share())}, 1));
    if (dice() % 3 == 0) {
      lancer_node bump =
          node(LANCER_NODE_BUMP, 0, {parameter(dice.share()), parameter(0.125f), grey, parameter(0.0f), parameter(0.125f)});
      bump.first = 0;
      normal = add(bump);
    }
  }
};

// Numbers or results of nodes.
lancer_lobe random_lobe(Dice &dice, const RandomNodes *by, lancer_principled &record) {
  const auto number = [&] { return by && dice() % 3 == 0 ? by->number : parameter(dice() % 3 ? dice.share() : 0.0f); };
  const auto color = [&] { return by && dice() % 2 ? by->color : dice.color(); };
  const uint32_t rules = dice() % 3;
  lancer_lobe one = lobe(dice() % 2 ? uint32_t(LANCER_PRINCIPLED) : dice() % LANCER_LOBE_KIND_COUNT, 0.75f);
  one.rules = rules;
  one.normal = by ? by->normal : parameter(0.0f);
  if (one.kind != LANCER_PRINCIPLED) {
    one.distribution = dice() % 4;
    one.option = dice() % 2;
    one.color = color();
    one.roughness = number();
    one.ior = parameter(1.0f + dice.share());
    one.anisotropy = parameter(dice() % 2 ? dice.share() : 0.0f);
    one.rotation = parameter(dice.share());
    one.shininess = parameter(one.kind == LANCER_MINNAERT ? dice.share() : 32.0f * dice.share());
    one.edge = dice.color();
    return one;
  }
  record.rules = rules;
  record.distribution = dice() % 2 ? LANCER_DISTRIBUTION_MULTI_GGX : LANCER_DISTRIBUTION_GGX;
  record.option = dice() % 2;
  record.base_color = color();
  for (lancer_parameter lancer_principled::*input :
       {&lancer_principled::metallic, &lancer_principled::roughness, &lancer_principled::diffuse_roughness,
        &lancer_principled::specular, &lancer_principled::anisotropic, &lancer_principled::anisotropic_rotation,
        &lancer_principled::transmission, &lancer_principled::transmission_roughness, &lancer_principled::coat,
        &lancer_principled::coat_roughness, &lancer_principled::sheen, &lancer_principled::sheen_roughness})
    record.*input = number();
  record.ior = parameter(1.0f + dice.share());
  record.coat_ior = parameter(1.5f);
  record.coat_tint = dice() % 2 ? parameter(1.0f) : dice.color();
  record.specular_tint = record.sheen_tint = dice.color();
  record.coat_normal = record.emission = parameter(0.0f);
  one.principled = &record;
  return one;
}

uint32_t random_material(Stand &stand, Dice &dice) {
  const RandomNodes nodes(dice);
  const RandomNodes *by = dice() % 2 ? &nodes : nullptr;
  lancer_principled records[2] = {};
  std::vector<lancer_lobe> lobes;
  for (uint32_t i = 0, count = 1 + dice() % 2; i < count; ++i)
    lobes.push_back(random_lobe(dice, by, records[i]));
  lancer_material material = plain();
  if (dice() % 6 == 0)
    material.emission = by ? by->color : dice.color();
  if (dice() % 5 == 0)
    material.transmittance = by && dice() % 2 ? by->color : dice.color();
  return stand.material(lobes, material, by ? by->nodes : std::vector<lancer_node>());
}

uint64_t random_scene(uint32_t seed) {
  Dice dice;
  for (uint32_t i = 0; i < 7 * seed; ++i)
    dice();
  Stand stand;
  stand.floor();
  const Sheet sheet(5);
  stand.add(sheet.mesh());
  std::vector<uint32_t> materials;
  for (int i = 0; i < 4; ++i)
    materials.push_back(random_material(stand, dice));
  for (int i = 0; i < 10; ++i) {
    const uint32_t kinds[] = {LANCER_MESH, LANCER_SPHERE, LANCER_CYLINDER, LANCER_CONE};
    lancer_instance &instance = stand.place(kinds[dice() % 4], materials[dice() % 4], dice.place({-2, -2, 0.25}, {4, 4, 2}));
    tilt(instance.matrix);
    instance.hidden_from = dice() % 5 ? 0 : dice() & 63;
  }
  for (uint32_t i = 0, count = dice() % 5; i < count; ++i) {
    const std::array<double, 3> at = dice.place({-3, -3, 2}, {6, 6, 3});
    stand.add(lamp(dice() % 4, at[0], at[1], at[2], 1.0f + 16.0f * dice.share()));
  }
  stand.sky(dice.share(), dice.share(), dice.share());
  stand.settings.samples = 2;
  stand.settings.seed = seed;
  stand.settings.max_bounces = dice() % 6;
  stand.settings.integrator = dice() % 5 ? uint32_t(LANCER_PATH) : uint32_t(LANCER_CLASSIC);
  stand.settings.clamp_indirect = dice() % 3 ? 0.0f : 4.0f;
  stand.settings.occlusion_distance = dice() % 2 ? 0.0f : 1.5f;
  stand.settings.film_transparent = dice() % 2;
  stand.camera = make_camera(24, 16);
  stand.commit();
  stand.render();
  return stand.hash.value();
}

TEST(SamePictures, FortyRandomScenes) {
  constexpr uint64_t kPictures[40] = {
      0x852cc6866d078227u, 0xe4febe3cd0645e2fu, 0x33a80605137b218fu, 0x7b6ea49a8e269ddcu, 0x872736322913d2b2u,
      0xb39de91bd08b4fc1u, 0xbd25a0b4404f6b2eu, 0x1c2204db3ad74635u, 0x2a9faa1a62553d4eu, 0x57276b5821523580u,
      0xf1454057b300f2dfu, 0xd2125e339f06da41u, 0x12386a6d38b5bbb5u, 0xc95ff35caf37e005u, 0x8753c59e5e28c325u,
      0xeef2294d36913b77u, 0xdd699a9183b6639eu, 0xed0000bcfd41c689u, 0x62bdd026f4994325u, 0xc1f9b87be6c4e13du,
      0x5edd6fee58dd8824u, 0x8f4b1964459a99e2u, 0xac98e8a932f95a05u, 0xa108c4b1e1c59f67u, 0x6363f551b24be5d8u,
      0x5e0eb716474c04f9u, 0xd9d78d4ccad4c62au, 0xc5873a8f26078354u, 0x6e448d68eb7c8b7bu, 0x1e81c44fdac3b354u,
      0xaede97e28c7858eeu, 0x8e44c385789407e0u, 0xb954abd2fa309fdu,  0xf2d0692ebe3ea138u, 0x7274cf6bc8988393u,
      0x2a147cdb246098aeu, 0xc66216631754e8c0u, 0x4a6987d98b8dd455u, 0xe03446c219e94414u, 0x82154e381583ec1bu};
  for (uint32_t seed = 0; seed < 40; ++seed)
    EXPECT_EQ(random_scene(seed), kPictures[seed]) << "scene " << seed;
}

} // namespace
} // namespace lancer_test
