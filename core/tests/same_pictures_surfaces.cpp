// Surfaces: small scenes and the bits of all their passes, equal for every instruction set, processor, compiler and system. A
// change of pictures changes these numbers and must be intended; any other change must leave them.
#include "bits_stand.h"

namespace lancer_test {
namespace {

TEST(SamePictures, GlassAndCutOuts) {
  Stand stand;
  stand.floor();
  std::vector<uint32_t> materials;
  for (const uint32_t distribution : {LANCER_DISTRIBUTION_GGX, LANCER_DISTRIBUTION_BECKMANN, LANCER_DISTRIBUTION_MULTI_GGX}) {
    lancer_lobe glass = lobe(LANCER_GLASS, 0.875f, 0.25f * float(distribution));
    glass.distribution = distribution;
    glass.rules = distribution == LANCER_DISTRIBUTION_MULTI_GGX ? LANCER_RULES_BLENDER_45 : LANCER_RULES_BLENDER_3;
    materials.push_back(stand.material({glass}));
  }
  materials.push_back(stand.material({lobe(LANCER_DIELECTRIC, 1.0f)}));
  materials.push_back(stand.material({lobe(LANCER_REFRACTION, 0.75f, 0.5f)}));
  materials.push_back(stand.material({lobe(LANCER_TRANSLUCENT, 0.75f), lobe(LANCER_MIRROR, 0.25f)}));
  materials.push_back(stand.material({newest(LANCER_GLASS, 0.75f, 0.25f)}));
  lancer_material pane = plain();
  pane.transmittance = parameter(0.5f, 0.75f, 0.25f);
  materials.push_back(stand.material({lobe(LANCER_LAMBERT, 0.25f)}, pane));
  pane.holdout = parameter(0.25f);
  materials.push_back(stand.material({lobe(LANCER_GLOSSY, 0.25f)}, pane));
  Dice dice;
  for (uint32_t i = 0; i < 16; ++i)
    tilt(stand
             .place(i % 3 ? LANCER_SPHERE : LANCER_CYLINDER, materials[i % materials.size()],
                    dice.place({-2, -2, 0.25}, {4, 4, 2}))
             .matrix);
  const Sheet sheet(4);
  stand.add(sheet.mesh());
  for (uint32_t i = 0; i < 6; ++i)
    tilt(stand.place(LANCER_MESH, materials[6 + i % 3], dice.place({-0.5, -2, 0.5}, {1, 2, 1})).matrix);
  stand.add(lamp(LANCER_AREA, 0, 0, 4, 8));
  stand.sky(0.25f, 0.5f, 0.75f);
  stand.settings.film_transparent = stand.settings.transparent_glass = 1;
  stand.settings.glass_roughness = 0.0625f;
  stand.settings.clamp_indirect = 8.0f;
  stand.commit();
  stand.render();
  EXPECT_GT(stand.vertices, 0u);
  EXPECT_EQ(stand.hash.value(), 0x5753ce4623e3b017u);
}

TEST(SamePictures, LobesOfAllKinds) {
  Stand stand;
  stand.floor();
  const uint32_t distributions[] = {LANCER_DISTRIBUTION_GGX, LANCER_DISTRIBUTION_BECKMANN,
                                    LANCER_DISTRIBUTION_ASHIKHMIN_SHIRLEY, LANCER_DISTRIBUTION_MULTI_GGX};
  uint32_t number = 0;
  for (uint32_t kind = 0; kind < LANCER_TOON; ++kind)
    for (const uint32_t distribution : distributions) {
      if (kind == LANCER_PRINCIPLED)
        continue;
      lancer_lobe one = lobe(kind, 0.75f, 0.375f);
      one.distribution = distribution;
      one.option = distribution % 2;
      one.rules = number % 3;
      one.anisotropy = parameter(0.5f);
      one.rotation = parameter(0.3125f);
      one.shininess = parameter(kind == LANCER_MINNAERT ? 0.5f : 12.5f);
      one.edge = parameter(0.5f, 0.75f, 1.0f);
      const uint32_t column = number % 10, row = number / 10;
      stand.place(LANCER_SPHERE, stand.material({one, lobe(LANCER_LAMBERT, 0.125f)}), 0.5 * column - 2.25, 0.25 * row,
                  0.5 * row - 0.5, 0.25);
      ++number;
    }
  stand.add(lamp(LANCER_AREA, 0, -3, 4, 8));
  stand.add(lamp(LANCER_POINT, 2, -3, 2, 20));
  stand.sky(0.25f, 0.25f, 0.25f);
  stand.camera = make_camera(40, 24);
  stand.settings.samples = 4;
  stand.commit();
  stand.render();
  EXPECT_EQ(stand.hash.value(), 0x3d904800ea92241du);
}

TEST(SamePictures, Principled) {
  Stand stand;
  stand.floor();
  Dice dice;
  for (uint32_t i = 0; i < 24; ++i) {
    lancer_principled record = {};
    record.rules = i % 3;
    record.distribution = i % 2 ? LANCER_DISTRIBUTION_MULTI_GGX : LANCER_DISTRIBUTION_GGX;
    record.option = i / 3 % 2;
    record.base_color = dice.color();
    for (lancer_parameter lancer_principled::*input :
         {&lancer_principled::metallic, &lancer_principled::roughness, &lancer_principled::diffuse_roughness,
          &lancer_principled::specular, &lancer_principled::anisotropic, &lancer_principled::anisotropic_rotation,
          &lancer_principled::transmission, &lancer_principled::transmission_roughness, &lancer_principled::coat,
          &lancer_principled::coat_roughness, &lancer_principled::sheen, &lancer_principled::sheen_roughness})
      record.*input = parameter(dice() % 3 ? dice.share() : 0.0f);
    record.ior = parameter(1.0f + dice.share());
    record.coat_ior = parameter(1.5f);
    record.coat_tint = i % 4 == 1 ? parameter(1.0f) : dice.color();
    record.specular_tint = record.sheen_tint = parameter(dice.share());
    if (i % 4 == 1) // supported by kernels of many lanes
      record.sheen = record.anisotropic = record.diffuse_roughness = parameter(0.0f);
    record.coat_normal = record.emission = record.film_thickness = parameter(0.0f);
    record.thin_wall = record.wall_scattering = record.wall_forward = parameter(0.0f);
    record.subsurface = record.subsurface_radius = record.subsurface_color = parameter(0.0f);
    record.subsurface_ior = record.subsurface_anisotropy = parameter(0.0f);
    record.film_ior = parameter(1.33f);
    lancer_lobe one = lobe(LANCER_PRINCIPLED, 1.0f);
    one.rules = record.rules;
    one.principled = &record;
    stand.place(LANCER_SPHERE, stand.material({one}), 0.625 * (i % 6) - 1.5, 0.5 * (i / 6), 0.5 * (i / 6) + 0.25, 0.3125);
  }
  stand.add(lamp(LANCER_AREA, 0, -3, 4, 8));
  stand.add(lamp(LANCER_SUN, 0, 0, 0, 1));
  stand.sky(0.25f, 0.25f, 0.25f);
  stand.camera = make_camera(30, 20);
  stand.commit();
  stand.render();
  EXPECT_GT(stand.vertices, 0u);
  EXPECT_EQ(stand.hash.value(), 0x7530525789197742u);
}

// Each method, with and without scattering ahead.
TEST(SamePictures, LightBelowSurfaces) {
  Stand stand;
  stand.floor();
  for (uint32_t i = 0; i < 8; ++i) {
    lancer_lobe wax = lobe(LANCER_SUBSURFACE, 1.0f, 0.5f);
    wax.color = parameter(0.875f, 0.5f, 0.25f);
    wax.edge = parameter(1.0f, 0.5f, 0.125f);
    wax.ior = parameter(1.375f);
    wax.option = i % 4;
    wax.rules = i < 4 ? LANCER_RULES_BLENDER_52 : LANCER_RULES_BLENDER_4;
    wax.anisotropy = parameter(i % 2 ? 0.5f : 0.0f);
    stand.place(LANCER_SPHERE, stand.material({wax, lobe(LANCER_LAMBERT, 0.125f)}), 0.75 * (i % 4) - 1.25, 0.5 * (i / 4),
                0.5 * (i / 4) + 0.25, 0.375);
  }
  stand.add(lamp(LANCER_AREA, 0, -3, 4, 8));
  stand.sky(0.25f, 0.25f, 0.25f);
  stand.camera = make_camera(30, 20);
  stand.commit();
  stand.render();
  EXPECT_EQ(stand.hash.value(), 0x4b02481e699997f3u);
}

TEST(SamePictures, MathsOfNodes) {
  Stand stand;
  std::vector<lancer_node> nodes = {node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_POSITION),
                                    node(LANCER_NODE_VECTOR_MATH, LANCER_VECTOR_MULTIPLY_ADD,
                                         {result_of(0), parameter(3.75f, -2.5f, 1.25f), parameter(0.25f, 1.5f, -0.75f)}),
                                    node(LANCER_NODE_SEPARATE, 0, {result_of(1)}),
                                    node(LANCER_NODE_SEPARATE, 1, {result_of(1)}),
                                    node(LANCER_NODE_SEPARATE, 2, {result_of(0)})};
  const auto last = [&] { return int32_t(nodes.size()) - 1; };
  const int32_t first = last() + 1;
  for (uint32_t option = 0; option < LANCER_MATH_COUNT; ++option)
    nodes.push_back(node(LANCER_NODE_MATH, option, {result_of(2), result_of(3), parameter(0.375f)}));
  for (uint32_t option = 0; option < LANCER_VECTOR_COUNT; ++option)
    nodes.push_back(node(LANCER_NODE_VECTOR_MATH, option, {result_of(1), result_of(0), parameter(0.5f), parameter(1.75f)}));
  for (uint32_t option = 0; option < LANCER_MIX_COUNT; ++option)
    nodes.push_back(node(LANCER_NODE_MIX, option, {parameter(0.625f), result_of(1), result_of(0)}, option % 4));
  for (uint32_t option = 0; option < 4; ++option)
    nodes.push_back(
        node(LANCER_NODE_MAPPING, option,
             {result_of(1), parameter(0.25f, 0.5f, 1.0f), parameter(0.75f, -1.5f, 2.25f), parameter(2.0f, 0.5f, 1.0f)}));
  nodes.push_back(node(LANCER_NODE_FRESNEL, 0, {parameter(1.375f)}));
  nodes.push_back(node(LANCER_NODE_LAYER_WEIGHT, 0, {parameter(0.375f)}));
  nodes.push_back(node(LANCER_NODE_LAYER_WEIGHT, 1, {parameter(0.625f)}));
  nodes.push_back(node(LANCER_NODE_GAMMA, 0, {result_of(1), parameter(2.125f)}));
  nodes.push_back(node(LANCER_NODE_INVERT, 0, {parameter(0.75f), result_of(1)}));
  const int32_t end = last() + 1;
  // All of them in one colour, each by its fraction.
  nodes.push_back(node(LANCER_NODE_VECTOR_MATH, LANCER_VECTOR_FRACTION, {result_of(first)}));
  for (int32_t number = first + 1; number < end; ++number) {
    nodes.push_back(node(LANCER_NODE_VECTOR_MATH, LANCER_VECTOR_FRACTION, {result_of(number)}));
    nodes.push_back(node(LANCER_NODE_VECTOR_MATH, LANCER_VECTOR_ADD, {result_of(last() - 1), result_of(last())}));
  }
  lancer_material shining = plain();
  shining.emission = result_of(last());
  const uint32_t material = stand.material({lobe(LANCER_LAMBERT, 0.5f)}, shining, nodes);
  stand.place(LANCER_PLANE, material, 0, 0, 0);
  tilt(stand.place(LANCER_SPHERE, material, 0, 0, 1).matrix);
  stand.sky(0.5f, 0.5f, 0.5f);
  stand.commit();
  for (int32_t number = first; number < end; ++number)
    stand.look_at(material, uint32_t(number));
  stand.render();
  EXPECT_EQ(stand.hash.value(), 0x0cc900596c1bbdc2u);
}

TEST(SamePictures, PicturesOfAllKinds) {
  Stand stand;
  constexpr uint32_t width = 16, height = 8;
  Dice dice;
  std::vector<uint8_t> bytes;
  std::vector<uint16_t> shorts;
  std::vector<float> floats;
  for (uint32_t i = 0; i < 4 * width * height; ++i) {
    bytes.push_back(uint8_t(dice()));
    shorts.push_back(uint16_t(dice()));
    floats.push_back(1.5f * dice.share());
  }
  uint32_t images = 0;
  for (const uint32_t transfer : {LANCER_TRANSFER_LINEAR, LANCER_TRANSFER_SRGB})
    for (const uint32_t kind : {LANCER_TEXEL_U8, LANCER_TEXEL_U16, LANCER_TEXEL_FLOAT}) {
      lancer_image image = {};
      image.name = "picture";
      image.texels = kind == LANCER_TEXEL_U8    ? static_cast<const void *>(bytes.data())
                     : kind == LANCER_TEXEL_U16 ? static_cast<const void *>(shorts.data())
                                                : floats.data();
      image.width = width;
      image.height = height;
      image.channels = 4;
      image.kind = kind;
      image.transfer = transfer;
      image.alpha = kind;
      image.matrix[0] = image.matrix[4] = image.matrix[8] = 0.875f;
      image.matrix[1] = 0.125f;
      stand.add(image);
      ++images;
    }
  const Sheet sheet(6);
  stand.add(sheet.mesh());
  for (uint32_t i = 0; i < 24; ++i) {
    std::vector<lancer_node> nodes = {
        node(LANCER_NODE_COORDINATE, i % 3 ? LANCER_COORDINATE_UV : LANCER_COORDINATE_GENERATED),
        node(LANCER_NODE_MAPPING, i % 4,
             {result_of(0), parameter(0.25f, 0.125f, 0.0f), parameter(0.25f, 0.5f, 0.75f), parameter(1.5f, 2.5f, 0.75f)}),
        node(LANCER_NODE_IMAGE, i % 4, {result_of(1), parameter(0.25f)}, (i / 4 % 4) | (i % 3) << 4 | (i % 2) << 8),
        node(LANCER_NODE_ALPHA, 0, {result_of(2)})};
    nodes[2].image = i % images;
    nodes[2].image_count = 1;
    lancer_lobe matt = newest(LANCER_DIFFUSE, 1.0f);
    matt.color = result_of(2);
    lancer_material material = plain();
    material.transmittance = result_of(3);
    lancer_instance &instance =
        stand.place(i % 2 ? LANCER_MESH : LANCER_SPHERE, stand.material({matt}, i % 5 ? plain() : material, nodes),
                    0.75 * (i % 6) - 2.0, 0.5 * (i / 6), 0.5 * (i / 6) + 0.25, 0.375);
    instance.shading = i % 4;
  }
  std::vector<lancer_node> sky = {node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_GENERATED),
                                  node(LANCER_NODE_MAPPING, LANCER_MAPPING_POINT,
                                       {result_of(0), parameter(0.0f), parameter(0.25f, 0.5f, 1.25f), parameter(1.0f)}),
                                  node(LANCER_NODE_ENVIRONMENT, LANCER_ENVIRONMENT_EQUIRECTANGULAR, {result_of(1)}),
                                  node(LANCER_NODE_ENVIRONMENT, LANCER_ENVIRONMENT_MIRROR_BALL, {result_of(1)}),
                                  node(LANCER_NODE_ENVIRONMENT, LANCER_ENVIRONMENT_CUBE, {result_of(1)}),
                                  node(LANCER_NODE_VECTOR_MATH, LANCER_VECTOR_ADD, {result_of(2), result_of(3)}),
                                  node(LANCER_NODE_VECTOR_MATH, LANCER_VECTOR_ADD, {result_of(4), result_of(5)})};
  for (const size_t number : {2, 3, 4}) {
    sky[number].image = number == 4 ? 0 : uint32_t(number);
    sky[number].image_count = number == 4 ? 6 : 1;
  }
  lancer_world world = {};
  world.nodes = sky.data();
  world.node_count = uint32_t(sky.size());
  world.radiance = result_of(6);
  world.map_resolution = 64;
  stand.add(world);
  stand.floor();
  stand.commit();
  stand.render();
  stand.camera.matrix[11] = 3.0;
  stand.settings.pixel_filter = LANCER_FILTER_BOX;
  stand.render();
  EXPECT_GT(stand.vertices, 0u);
  EXPECT_EQ(stand.hash.value(), 0xced7bc91e7df344du);
}

TEST(SamePictures, BumpsAndDisplacement) {
  Stand stand;
  stand.floor();
  const Sheet sheet(12);
  stand.add(sheet.mesh());
  const lancer_parameter none = parameter(0.0f);
  const std::vector<lancer_node> waves = {
      node(LANCER_NODE_COORDINATE, LANCER_COORDINATE_POSITION),
      node(LANCER_NODE_VECTOR_MATH, LANCER_VECTOR_SCALE, {result_of(0), none, none, parameter(7.5f)}),
      node(LANCER_NODE_VECTOR_MATH, LANCER_VECTOR_SINE, {result_of(1)}),
      node(LANCER_NODE_SEPARATE, 0, {result_of(2)}),
      node(LANCER_NODE_BUMP, 0, {parameter(0.75f), parameter(0.125f), result_of(3), none, parameter(0.125f)}),
      node(LANCER_NODE_NORMAL_MAP, 0, {parameter(0.75f), parameter(0.625f, 0.375f, 0.875f)}),
      node(LANCER_NODE_DISPLACEMENT, 0, {result_of(3), parameter(0.5f), parameter(0.125f), none}),
      node(LANCER_NODE_TANGENT, 2)};
  for (uint32_t i = 0; i < 12; ++i) {
    lancer_lobe matt = lobe(LANCER_LAMBERT, 0.5f), shiny = lobe(LANCER_GLOSSY, 0.5f, 0.25f);
    matt.normal = i % 3 == 0 ? result_of(4) : none;
    shiny.normal = i % 3 == 1 ? result_of(5) : none;
    shiny.anisotropy = parameter(0.5f);
    shiny.tangent = i % 2 ? result_of(7) : none;
    lancer_material material = plain();
    material.displacement = i % 4 == 0 ? result_of(6) : none;
    lancer_instance &instance =
        stand.place(i % 3 == 2 ? LANCER_SPHERE : LANCER_MESH, stand.material({matt, shiny}, material, waves),
                    1.0 * (i % 4) - 1.5, 0.75 * (i / 4), 0.75 * (i / 4) + 0.375, 0.5);
    tilt(instance.matrix);
    instance.shading = i % 4;
    instance.terminator = 0.125f;
  }
  stand.add(lamp(LANCER_POINT, 2, -4, 4, 40));
  stand.sky(0.25f, 0.5f, 0.5f);
  stand.commit();
  stand.render();
  EXPECT_GT(stand.vertices, 0u);
  EXPECT_EQ(stand.hash.value(), 0xb71b072b3e2c87acu);
}

} // namespace
} // namespace lancer_test
