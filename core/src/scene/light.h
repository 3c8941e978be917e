// Lights and the world as the user described them, in the user's units.
#pragma once

#include "scene/affine.h"
#include "scene/light_links.h"
#include "scene/node.h"

#include <cstdint>
#include <optional>
#include <string>

namespace lancer {

enum class LightKind : uint32_t { Point = 0, Spot = 1, Sun = 2, Area = 3 };
enum class AreaShape : uint32_t { Rectangle = 0, Ellipse = 1 };
enum class Falloff : uint32_t { Physical = 0, Constant = 1, Linear = 2, Quadratic = 3, Smooth = 4, Gaussian = 5 };

struct LightDescription {
  std::string name;
  Affine to_world;
  LightKind kind = LightKind::Point;
  glm::vec3 emission{0.0f}; // POINT, SPOT: W/sr; SUN: W/m^2; AREA: radiance
  Program program;
  Parameter strength{glm::vec3(1.0f)}; // factor of emission
  Schedule schedule;                   // of strength
  float radius = 0.0f;
  bool soft_falloff = true;
  float spot_angle = 0.0f, spot_blend = 0.0f;
  bool spot_cosine = false;
  float sun_angle = 0.0f;
  bool sun_flat = false;
  glm::vec2 size{0.0f};
  AreaShape shape = AreaShape::Rectangle;
  float spread = 3.14159265f;
  uint32_t hidden_from = 0; // RayKind bits
  bool no_shadow = false;
  bool no_catchers = false;
  bool opening = false; // AREA: no lamp, see Openings
  uint32_t light_group = 0; // 0 = none
  LightLinks links;
  uint32_t lit_surfaces = 0; // 0: all
  // CLASSIC only.
  Falloff falloff = Falloff::Physical;
  float falloff_radius = 0.0f;
  glm::vec3 ambient_color{1.0f}, diffuse_color{1.0f}, specular_color{1.0f};
};

// The environment as described: one radiance, or nodes that compute the radiance of a direction.
struct WorldView {
  ProgramView program;
  Parameter radiance;
  ScheduleView schedule;            // of radiance
  uint32_t hidden_from = 0;         // RayKind bits
  uint32_t map_resolution = 0;      // 0 = by its images
  uint32_t lit_surfaces = 0;        // 0: all
  std::optional<glm::vec3> ambient; // replaces the mean radiance for Ka
  uint32_t light_group = 0;         // 0 = none
  std::span<const Output> outputs;
  ScheduleView output_nodes;

  bool varies() const { return radiance.varies(); }
};

// The memory of a world.
struct World {
  Program program;
  Parameter radiance;
  Schedule schedule;
  uint32_t hidden_from = 0;
  uint32_t map_resolution = 0;
  uint32_t lit_surfaces = 0;
  std::optional<glm::vec3> ambient;
  uint32_t light_group = 0;
  std::vector<Output> outputs;
  Schedule output_nodes;

  bool varies() const { return radiance.varies(); }
  // Valid until the world changes.
  operator WorldView() const {
    return {program,      radiance, schedule,    hidden_from, map_resolution,
            lit_surfaces, ambient,  light_group, outputs,     output_nodes};
  }
};

} // namespace lancer
