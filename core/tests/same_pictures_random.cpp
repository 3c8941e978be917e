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
      0xef70cbabb5e7740eu, 0xd8d76513e88c6271u, 0x6e79bbb3de436ec6u, 0xcf9323c97511ab64u, 0x4ba8b7695a915563u,
      0xa11aa724b8a93017u, 0xac00ccfe12925d2au, 0x9129240e56453518u, 0xe245836561efe844u, 0xaf8dc5e2c1c46082u,
      0x5af99690608fe7f8u, 0xf091c999c69d8b75u, 0xa2d6b4e7513a3aa0u, 0x9c4f34ea7cc0c269u, 0x8eab788b75da19d6u,
      0xdc0dd892b80b989du, 0x63d08b2a8779b8b7u, 0x5b1549944dbed5ddu, 0x454d9b1dad06295au, 0xe5d667c0abfc2ffbu,
      0x022901f6cfd80742u, 0xaf83791ae86433d3u, 0x403d189b0bbfb428u, 0xd94cc22ecf678c93u, 0xf286c1d9dc4bb010u,
      0x2ebcb22365a9400bu, 0x3cccb9f329f4539au, 0xe3e21092a8d12d31u, 0xff572a576437cfb8u, 0x5c8fb52f5c05410fu,
      0xe6bf0123a21a33b4u, 0x3f2f5da42c0db094u, 0xecf23841f9411b8au, 0x597316eea38a8073u, 0xb2a5ed5a491bc40eu,
      0xb0e12dca08f5a5e5u, 0x6c416148d7a809a2u, 0x19984bbf37f6722eu, 0xfc4340722100c990u, 0x4b6e97a1a261c9c6u};
  for (uint32_t seed = 0; seed < 40; ++seed)
    EXPECT_EQ(random_scene(seed), kPictures[seed]) << "scene " << seed;
}

} // namespace
} // namespace lancer_test
