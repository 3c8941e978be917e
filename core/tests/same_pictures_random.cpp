// Forty scenes of random lobes, nodes, shapes, lights and settings: the bits of all their passes, equal for every instruction
// set and number of lanes.
#include "bits_stand.h"

namespace lancer_test {
namespace {

// Nodes that compute numbers of about 0 ... 1 from the position: a colour, a roughness and a normal.
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

// Numbers, or results of nodes.
lancer_lobe random_lobe(Dice &dice, const RandomNodes *by, lancer_principled &record) {
  const auto number = [&] { return by && dice() % 3 == 0 ? by->number : parameter(dice() % 3 ? dice.share() : 0.0f); };
  const auto color = [&] { return by && dice() % 2 ? by->color : dice.color(); };
  const uint32_t rules = dice() % 3;
  lancer_lobe one = lobe(dice() % 2 ? uint32_t(LANCER_PRINCIPLED) : dice() % LANCER_TOON, 0.75f);
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
  record.film_thickness = record.thin_wall = record.wall_scattering = record.wall_forward = parameter(0.0f);
  record.subsurface = record.subsurface_radius = record.subsurface_color = parameter(0.0f);
  record.subsurface_ior = record.subsurface_anisotropy = parameter(0.0f);
  record.film_ior = parameter(1.33f);
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
    // In sequence: compilers evaluate the arguments of a call in any order.
    const std::array<double, 3> at = dice.place({-2, -2, 0.25}, {4, 4, 2});
    const uint32_t material = materials[dice() % 4];
    lancer_instance &instance = stand.place(kinds[dice() % 4], material, at);
    tilt(instance.matrix);
    instance.hidden_from = dice() % 5 ? 0 : dice() & 63;
  }
  for (uint32_t i = 0, count = dice() % 5; i < count; ++i) {
    const std::array<double, 3> at = dice.place({-3, -3, 2}, {6, 6, 3});
    const float strength = 1.0f + 16.0f * dice.share();
    stand.add(lamp(dice() % 4, at[0], at[1], at[2], strength));
  }
  const float blue = dice.share(), green = dice.share();
  stand.sky(dice.share(), green, blue);
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
      0x80248a50fc018f98u, 0x90f88230617539a9u, 0x466ed42558c79e84u, 0xaee3a769c81d9676u, 0xc3905834d7626590u,
      0xc138698a5d399608u, 0x8bfeabb84e00cebau, 0x9029df34d23ebd1cu, 0xd9581b9b8a8c6f32u, 0x26d65f493d4193c3u,
      0xe493fafcac3edcabu, 0xa96b4cd5a60e185au, 0x58f257093dd2c29bu, 0x2b549aaf7a9966e7u, 0x5c9e11f2566b883fu,
      0xe2300d907a7dd1fcu, 0xc6788f15840e859cu, 0x4c7467dc645970f2u, 0x8337b26abc1e2e9cu, 0x902459e486f5e628u,
      0xa04aa378f31a99b5u, 0x399b026ab31ab7e2u, 0x9f3921ba100356dcu, 0xd79aaee9c8115696u, 0x12070b5d0d2ebe59u,
      0xb988b67c7ce4c106u, 0x58924c2d37a20a97u, 0x6ae709c3f6c369e3u, 0x4bb27e8187c54937u, 0x3693526d51c13d93u,
      0xf7a31171d6bcfbc4u, 0x65a0a0afe1143f89u, 0x90f66bd6f9933140u, 0x296406a55e5822deu, 0x86ebfc4f07c6a560u,
      0xdb9d741d0a1fda06u, 0x62bb6f138c156c9cu, 0xda11681ef063a848u, 0xd26a91d2873ac9ffu, 0x138d2000e929a07bu};
  for (uint32_t seed = 0; seed < 40; ++seed)
    EXPECT_EQ(random_scene(seed), kPictures[seed]) << "scene " << seed;
}

} // namespace
} // namespace lancer_test
