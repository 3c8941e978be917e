// The readers of the user's records, where the interface ends: checked copies, and the checks that all readers share.
#pragma once

#include "lancer.h"
#include "scene/camera.h"
#include "scene/description.h"
#include "scene/messages.h"

#include <cstdio>

namespace lancer {

inline std::string to_text(float value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", double(value));
  return text;
}

// Whether a map can place a shape without a stand-in: finite, invertible, of a size that the tracer can bear.
bool is_placement(const Affine &map);

// Throws an Error for a number of keys that motion cannot have.
void check_key_count(const std::string &object, uint32_t key_count);

inline void check_rays(const std::string &object, uint32_t hidden_from) {
  if (hidden_from >= 2 * LANCER_RAY_RAYCAST)
    bad_argument(object + ": hidden_from " + std::to_string(hidden_from) + " has bits beyond the last kind of ray");
}

// where: start of the message, "object: ".
inline void check_flags(const std::string &where, uint32_t flags, uint32_t known) {
  if (flags & ~known)
    bad_argument(where + "flags " + std::to_string(flags) + " has bits beyond the last flag");
}

// Each function checks one record and copies it. Throws Error, which names the object and the value. number: names an object
// without a name. images: those that nodes refer to by number.
using Images = std::span<const Given<Image>>;
Mesh read_mesh(const lancer_mesh &source, size_t number, Messages &messages);
Image read_image(const lancer_image &source, size_t number, Messages &messages);
Material read_material(const lancer_material &source, size_t number, Images images, Messages &messages);
LightDescription read_light(const lancer_light &source, size_t number, Images images, Messages &messages);
World read_world(const lancer_world &source, Images images);

// Each function checks one record and copies it into the description, which stays unchanged if it throws Error.
void add_mesh(Description &description, const lancer_mesh &mesh);
void add_instances(Description &description, uint32_t count, const lancer_instance *instances, uint32_t slot_count,
                   const uint32_t *slots, const char *names, size_t names_size);
void move_instances(Description &description, uint32_t count, const uint32_t *instances, uint32_t key_count,
                    const double *matrices);
void set_motion(Description &description, const lancer_motion &motion);
void set_vectors(Description &description, uint32_t count, const uint32_t *instances, const double *matrices);
void set_object_infos(Description &description, uint32_t count, const float *infos);
void add_object_attribute(Description &description, const char *name, uint32_t count, const float *values);
void add_material(Description &description, const lancer_material &material);
void add_light(Description &description, const lancer_light &light);
void add_image(Description &description, const lancer_image &image);
void set_world(Description &description, const lancer_world &world);

// Throws an Error if an instance refers to a mesh or a material that is not there.
void check_references(const Description &description);

// Checks and copies the nodes of an owner ("material 'Wood'"); check_reference() checks a parameter that may refer to one of
// them.
Program read_program(Images images, const std::string &owner, const lancer_node *nodes, uint32_t count);
void check_reference(const std::string &owner, const char *what, const lancer_parameter &parameter, const Program &program);
// Checks and copies the outputs of an owner, whose nodes are those of the program.
std::vector<Output> read_outputs(const std::string &owner, const lancer_output *outputs, uint32_t count,
                                 const Program &program);
// Returns the nodes that outputs depend on, in order of evaluation.
Schedule schedule_of(std::span<const Output> outputs, const Program &program);

// Checks and copies a camera; throws an Error for invalid values.
Camera read_camera(const lancer_camera &source);
// Does the same for a camera at the moments of the pass Vector.
CameraMoments read_camera_moments(const lancer_camera &source);
// Throws an Error if the camera, in the normalised world, is too far from the scene.
void check_reach(const Camera &camera);

} // namespace lancer
