// Lamps, lenses and crowds: small scenes and the bits of all their passes, equal for every instruction set, processor, compiler
// and system. A change of pictures changes these numbers and must be intended; any other change must leave them.
#include "bits_stand.h"

namespace lancer_test {
namespace {

TEST(SamePictures, LampsOfAllKinds) {
  Stand stand;
  stand.place(LANCER_PLANE, stand.material({newest(LANCER_DIFFUSE, 0.5f), newest(LANCER_GLOSSY, 0.25f, 0.375f)}), 0, 0, 0);
  stand.place(LANCER_SPHERE, stand.material({newest(LANCER_DIFFUSE, 0.75f)}), -0.5, 0.5, 1.0, 0.75);
  stand.place(LANCER_SPHERE, stand.glow(2.0f), 1.5, 1.0, 0.5, 0.25);
  stand.place(LANCER_CYLINDER, stand.glow(1.0f), -2.0, 1.0, 0.5, 0.25);
  stand.place(LANCER_CONE, stand.glow(3.0f), 0.5, -1.0, 0.25, 0.25);
  const Sheet sheet(3);
  stand.add(sheet.mesh());
  tilt(stand.place(LANCER_MESH, stand.glow(1.5f), 2.0, 2.0, 2.0, 0.5).matrix);
  lancer_light light = lamp(LANCER_POINT, 1, -2, 4, 20);
  stand.add(light);
  light.soft_falloff = 0;
  light.matrix[3] = -2;
  stand.add(light);
  light.radius = 0;
  light.matrix[7] = 3;
  stand.add(light);
  light = lamp(LANCER_SPOT, 0, 0, 4, 40);
  light.size[1] = 0.5f;
  stand.add(light);
  light.spot_cosine = 1;
  light.matrix[3] = 1;
  tilt(light.matrix);
  stand.add(light);
  light = lamp(LANCER_SUN, 0, 0, 0, 1);
  tilt(light.matrix);
  stand.add(light);
  light.sun_angle = 0.125f;
  stand.add(light);
  light.sun_flat = 1;
  light.sun_angle = 0.5f;
  stand.add(light);
  light = lamp(LANCER_AREA, -1, 1, 3, 4);
  stand.add(light);
  light.shape = LANCER_ELLIPSE;
  light.size[0] = 0.5f;
  light.matrix[3] = 2;
  light.spread = 1.5f;
  stand.add(light);
  stand.commit();
  stand.render();
  EXPECT_GT(stand.vertices, 0u);
  EXPECT_EQ(stand.hash.value(), 0xd10887dec5123297u);
}

TEST(SamePictures, LensesAndPanoramas) {
  Stand stand;
  stand.floor();
  const uint32_t kinds[] = {LANCER_SPHERE, LANCER_CYLINDER, LANCER_CONE};
  for (uint32_t i = 0; i < 8; ++i)
    tilt(
        stand.place(kinds[i % 3], stand.material({lobe(LANCER_BECKMANN, 0.75f, 0.25f)}), 1.0 * i - 3.5, 2.0 - 0.5 * i, 0.5, 0.5)
            .matrix);
  stand.add(lamp(LANCER_AREA, 0, 0, 4, 8));
  stand.sky(0.5f, 0.5f, 0.75f);
  stand.commit();
  stand.settings.samples = 4;
  stand.settings.mist_start = 1.0f;
  stand.settings.mist_depth = 8.0f;
  stand.settings.mist_falloff = 0.5f;
  stand.settings.occlusion_distance = 2.0f;
  stand.camera.lens_radius = 0.25;
  for (uint32_t blades = 0; blades < 7; blades += 3) {
    stand.camera.aperture_blades = blades;
    stand.camera.aperture_rotation = 0.375;
    stand.camera.aperture_ratio = 1.5;
    stand.render();
  }
  const double whole[4] = {0.0, 1.0, 0.0, 1.0};
  std::copy(whole, whole + 4, stand.camera.window);
  const double panoramas[][8] = {{-1.5, 1.5, -3.0, 3.0},
                                 {3.0},
                                 {10.5, 3.0, 36.0, 24.0},
                                 {3.0, 36.0, 24.0, 0.0625, -0.0625, 0.0009765625, 0.0, 0.0},
                                 {},
                                 {-2.0, 2.0, -1.0, 1.0, 1.0}};
  for (uint32_t kind = LANCER_EQUIRECTANGULAR; kind <= LANCER_CYLINDRICAL; ++kind) {
    stand.camera.kind = kind;
    std::copy(panoramas[kind - 2], panoramas[kind - 2] + 8, stand.camera.panorama);
    stand.render();
  }
  EXPECT_GT(stand.vertices, 0u);
  EXPECT_EQ(stand.hash.value(), 0x665d8a08b11b25cau);
}

// kind: the accelerator. All have equal hits; each is built by sorting.
uint64_t crowd(uint32_t kind) {
  Stand stand;
  stand.floor();
  const Sheet sheet(9);
  stand.add(sheet.mesh());
  const uint32_t matt = stand.material({newest(LANCER_DIFFUSE, 0.5f), newest(LANCER_GLOSSY, 0.25f, 0.5f)}),
                 shining = stand.glow(0.5f);
  Dice dice;
  for (uint32_t i = 0; i < 96; ++i) {
    lancer_instance &instance = stand.place(i % 5, i % 7 ? matt : shining, dice.place({-4, -2, 0.25}, {8, 8, 2}));
    if (instance.kind == LANCER_PLANE)
      instance.kind = LANCER_MESH;
    tilt(instance.matrix);
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column)
        instance.matrix[4 * row + column] *= 0.125 + 0.125 * column;
  }
  for (uint32_t i = 0; i < 24; ++i) {
    const std::array<double, 3> at = dice.place({-4, -2, 4}, {8, 8, 0});
    lancer_light light = lamp(i % 4, at[0], at[1], at[2], i % 4 == LANCER_SUN ? 0.03125f : 4.0f);
    tilt(light.matrix);
    stand.add(light);
  }
  stand.settings.samples = 4;
  stand.commit(kind);
  stand.render(3);
  EXPECT_GT(stand.vertices, 0u);
  return stand.hash.value();
}

TEST(SamePictures, Crowd) {
  for (const uint32_t kind : {LANCER_BVH, LANCER_KDTREE, LANCER_BRUTE_FORCE})
    EXPECT_EQ(crowd(kind), 0xf347112f83b4c0bbu) << kind;
}

TEST(SamePictures, Classic) {
  Stand stand;
  const Sheet sheet(6);
  stand.add(sheet.mesh());
  const uint32_t kinds[] = {LANCER_LAMBERT,  LANCER_BECKMANN, LANCER_PHONG,     LANCER_BLINN_PHONG,
                            LANCER_MINNAERT, LANCER_MIRROR,   LANCER_DIELECTRIC};
  stand.place(LANCER_PLANE, stand.material({lobe(LANCER_LAMBERT, 0.5f)}), 0, 0, 0);
  for (uint32_t i = 0; i < 21; ++i) {
    lancer_lobe gloss = lobe(kinds[i % 7], 0.5f, 0.25f);
    gloss.shininess = parameter(i % 7 == 4 ? 1.5f : 17.5f);
    lancer_instance &instance =
        stand.place(i % 2 ? LANCER_MESH : LANCER_SPHERE, stand.material({lobe(LANCER_LAMBERT, 0.25f), gloss}),
                    0.75 * (i % 6) - 2.0, 0.5 * (i / 6), 0.5 * (i / 6) + 0.25, 0.375);
    tilt(instance.matrix);
    instance.shading = i % 4;
  }
  for (uint32_t falloff = 0; falloff < 6; ++falloff) {
    lancer_light light = lamp(falloff % 4, 1.0 * falloff - 2.5, -2.0, 3.0, 2.0f);
    light.falloff = falloff;
    light.falloff_radius = 8.0f;
    tilt(light.matrix);
    stand.add(light);
  }
  stand.sky(0.25f, 0.5f, 0.75f);
  stand.settings.integrator = LANCER_CLASSIC;
  stand.camera = make_camera(24, 16);
  stand.commit();
  stand.render();
  stand.settings.samples = 1;
  stand.settings.integrator = LANCER_NORMALS;
  stand.render();
  EXPECT_GT(stand.vertices, 0u);
  EXPECT_EQ(stand.hash.value(), 0xc1d253a2b2289ed3u);
}

} // namespace
} // namespace lancer_test
