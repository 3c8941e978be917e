// Textures and tables as the node machine asks for them, one place at a time.
#include "nodes/curves.h"
#include "nodes/gradient.h"
#include "nodes/noise.h"
#include "nodes/voronoi.h"
#include "scene/node_site.h"

namespace lancer {

namespace {

Vector3<float> input(const Inputs &in, int i) { return Vector3<float>(in[i]); }

} // namespace

glm::vec4 noise(const Inputs &in) {
  return solid(noise_texture<float>(in.node.option, in.node.flags, input(in, 0), input(in, 1), input(in, 2), input(in, 3)));
}

glm::vec4 voronoi(const Inputs &in) {
  const VoronoiValue<float> value =
      voronoi_texture<float>(in.node.option, in.node.flags, input(in, 0), input(in, 1), input(in, 2), input(in, 3));
  return {glm::vec3(value.vector), value.number};
}

glm::vec4 gradient(const Inputs &in) { return scalar(gradient_texture<float>(in.node.option, input(in, 0))); }

glm::vec4 curves(const Inputs &in, const Site &site) {
  const Image &image = (*site.context->images)[in.node.image];
  const CurveTable table{reinterpret_cast<const float *>(image.texels.get()),
                         image.width,
                         image.channels,
                         in.node.matrix[0],
                         in.node.matrix[1],
                         (in.node.flags & 1) != 0,
                         (in.node.flags & 2) == 0};
  if (in.node.option == 0)
    return solid(on_curves<float>(table, in.scalar(0), input(in, 1)));
  const float x = in.scalar(1);
  const uint32_t step = image.channels < 3 ? 0 : 1;
  const glm::vec3 color{on_curve(table, 0, x), on_curve(table, step, x), on_curve(table, 2 * step, x)};
  return {color, image.channels == 4 ? on_curve(table, 3, x) : 1.0f};
}

} // namespace lancer
