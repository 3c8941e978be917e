// Ray visibility: lamps, the sky and objects hidden from rays of one kind are visible to all others.
#include "picture_lab.h"
#include "roundings.h"

#include <gtest/gtest.h>
#include <numbers>

namespace lancer_test {
namespace {

struct Kind {
  uint32_t ray;
  const char *name;
};
constexpr Kind kKinds[] = {{LANCER_RAY_CAMERA, "camera"},
                           {LANCER_RAY_DIFFUSE, "diffuse"},
                           {LANCER_RAY_GLOSSY, "glossy"},
                           {LANCER_RAY_TRANSMISSION, "transmission"}};

// Adds a plane that sends rays of this kind only; rough enough for light sampling, or in a single direction.
void add_sender(Studio &studio, uint32_t ray, bool single) {
  lancer_lobe sender = lobe(LANCER_LAMBERT, 1.0f);
  if (ray == LANCER_RAY_GLOSSY)
    sender = single ? lobe(LANCER_MIRROR, 1.0f) : lobe(LANCER_GLOSSY, 1.0f, 0.7f);
  if (ray == LANCER_RAY_TRANSMISSION)
    sender = lobe(LANCER_REFRACTION, 1.0f, single ? 0.0f : 0.7f);
  sender.rules = LANCER_RULES_BLENDER_45;
  if (ray != LANCER_RAY_CAMERA)
    studio.place(LANCER_PLANE, studio.add({sender}));
}

// Returns the direction of a ray of this kind from the plane: back up, or straight on.
double way(uint32_t ray) { return ray == LANCER_RAY_CAMERA || ray == LANCER_RAY_TRANSMISSION ? -1.0 : 1.0; }

enum class Shines { Sky, SkyByNodes, Lamp, Sun, Thing };

float level(Shines what, uint32_t ray, uint32_t hidden_from, bool single, uint32_t integrator = LANCER_PATH) {
  Studio studio;
  studio.settings.samples = integrator == LANCER_PATH ? 64 : 1;
  studio.settings.integrator = integrator;
  studio.settings.max_bounces = integrator == LANCER_PATH ? 0 : 1;
  add_sender(studio, ray, single);
  lancer_light lamp = studio.sun({0, 0, way(ray)}, 3.0f);
  lamp.hidden_from = hidden_from;
  switch (what) {
  case Shines::Sky:
  case Shines::SkyByNodes:
    studio.sky(1, 1, 1, hidden_from, what == Shines::SkyByNodes);
    break;
  case Shines::Lamp:
    lamp.kind = LANCER_POINT;
    lamp.radius = 1.0f;
    lamp.soft_falloff = 0;
    to_rows(moved(0, 0, 3 * way(ray)), lamp.matrix);
    studio.add(lamp);
    break;
  case Shines::Sun:
    lamp.sun_angle = 1.0f;
    studio.add(lamp);
    break;
  case Shines::Thing: {
    lancer_material glow = black();
    glow.emission = constant(1.0f);
    studio.place(LANCER_SPHERE, studio.add({}, glow), moved(0, 0, 3 * way(ray))).hidden_from = hidden_from;
  }
  }
  studio.render();
  return studio.color().x;
}

TEST(Visibility, OfWhatShines) {
  for (const Shines what : {Shines::Sky, Shines::SkyByNodes, Shines::Lamp, Shines::Sun, Shines::Thing})
    for (const Kind &by : kKinds)
      for (const bool single : {false, true})
        for (const Kind &hidden : kKinds) {
          const float got = level(what, by.ray, hidden.ray, single);
          const auto where =
              std::string("thing ") + std::to_string(int(what)) + " by " + by.name + " hidden from " + hidden.name;
          if (hidden.ray == by.ray)
            EXPECT_EQ(got, 0.0f) << where;
          else
            EXPECT_GT(got, 0.01f) << where;
        }
}

TEST(Visibility, OfWhatShinesInClassic) {
  for (const Shines what : {Shines::Sky, Shines::Thing})
    for (const uint32_t by : {LANCER_RAY_CAMERA, LANCER_RAY_GLOSSY})
      for (const Kind &hidden : kKinds) {
        const float got = level(what, by, hidden.ray, true, LANCER_CLASSIC);
        EXPECT_EQ(got > 0.5f, hidden.ray != by) << int(what) << " by " << by << " hidden from " << hidden.name;
      }
}

// The centre of a white floor under a sun, with a ball in between that is hidden from these rays.
float under_a_ball(uint32_t hidden_from, bool pane, bool no_shadow = false, uint32_t integrator = LANCER_PATH) {
  Studio studio;
  studio.settings.integrator = integrator;
  studio.settings.transparent_shadows = 8;
  studio.place(LANCER_PLANE, studio.add({lobe(LANCER_LAMBERT, 1.0f)}));
  studio.place(LANCER_SPHERE, studio.add({}, black()), moved(0, 0, 5)).hidden_from = hidden_from;
  lancer_material clear = black();
  clear.transmittance = constant(1.0f);
  if (pane)
    studio.place(LANCER_PLANE, studio.add({}, clear), moved(0, 0, 2));
  lancer_light sun = studio.sun({0, 0, 1}, std::numbers::pi_v<float>);
  sun.no_shadow = no_shadow;
  studio.add(sun);
  studio.render();
  return studio.color().x;
}

TEST(Visibility, OfWhatCastsShadows) {
  for (const bool pane : {false, true}) {
    EXPECT_EQ(under_a_ball(0, pane), 0.0f);
    EXPECT_NEAR(under_a_ball(LANCER_RAY_SHADOW, pane), 1.0f, kWhiteFloor);
    // Hiding it from other rays does not remove the shadow.
    EXPECT_EQ(under_a_ball(LANCER_RAY_CAMERA | LANCER_RAY_DIFFUSE | LANCER_RAY_GLOSSY | LANCER_RAY_TRANSMISSION, pane), 0.0f);
    // A lamp without shadows has no occluders.
    for (const uint32_t integrator : {LANCER_PATH, LANCER_CLASSIC}) {
      EXPECT_EQ(under_a_ball(0, pane, false, integrator), 0.0f);
      EXPECT_NEAR(under_a_ball(0, pane, true, integrator), 1.0f, kWhiteFloor);
    }
  }
}

TEST(Visibility, ClassicMayReflectTheEnvironmentAlone) {
  // A mirror shows an emitting object, or the sky behind it if no ray is traced.
  for (const uint32_t environment : {0u, 1u}) {
    Studio studio;
    studio.settings.integrator = LANCER_CLASSIC;
    studio.settings.max_bounces = 1;
    studio.settings.environment_reflections = environment;
    lancer_material glow = black();
    glow.emission = constant(1.0f);
    add_sender(studio, LANCER_RAY_GLOSSY, true);
    studio.place(LANCER_SPHERE, studio.add({}, glow), moved(0, 0, 5));
    studio.sky(0.25f, 0.25f, 0.25f);
    studio.render();
    EXPECT_EQ(studio.color().x, environment ? 0.25f : 1.0f);
  }
}

TEST(Visibility, GoesWithARayThroughPanes) {
  // Through a transparent pane a camera ray is still a camera ray, and a mirror's ray a mirror's.
  for (const uint32_t ray : {LANCER_RAY_CAMERA, LANCER_RAY_GLOSSY})
    for (const uint32_t hidden_from : {LANCER_RAY_CAMERA, LANCER_RAY_GLOSSY}) {
      Studio studio;
      lancer_material clear = black(), glow = black();
      clear.transmittance = glow.emission = constant(1.0f);
      add_sender(studio, ray, true);
      studio.place(LANCER_PLANE, studio.add({}, clear), moved(0, 0, 1.5 * way(ray)));
      studio.place(LANCER_SPHERE, studio.add({}, glow), moved(0, 0, 5 * way(ray))).hidden_from = hidden_from;
      studio.render();
      EXPECT_EQ(studio.color().x, hidden_from == ray ? 0.0f : 1.0f) << ray << " " << hidden_from;
    }
}

} // namespace
} // namespace lancer_test
