// Compiled once per instruction set, with LANCER_ISA naming it.
#include "widths/texture_kernel.h"

#include "nodes/noise.h"
#include "nodes/texture_nodes.h"
#include "nodes/voronoi.h"
#include "simd/kernel_lanes.h"

namespace lancer {
namespace {

V3 vector_of(const TextureInputs &in, int row, int first) {
  return {load(in.x[row] + first), load(in.x[row + 1] + first), load(in.x[row + 2] + first)};
}

template <class Formula> void all_lanes(TextureOutputs &out, const Formula &formula) {
  for (int first = 0; first < TextureInputs::kPlaces; first += kLanes) {
    const VoronoiValue<F> value = formula(first);
    store(out.x[0] + first, value.vector.x);
    store(out.x[1] + first, value.vector.y);
    store(out.x[2] + first, value.vector.z);
    store(out.x[3] + first, value.number);
  }
}

VoronoiValue<F> beside(const V3 &vector) { return {vector, vector.x}; }

void noise(uint32_t kind, uint32_t flags, const TextureInputs &in, TextureOutputs &out) {
  all_lanes(out, [&](int first) {
    return beside(noise_texture<F>(kind, flags, vector_of(in, 0, first), vector_of(in, 3, first), vector_of(in, 6, first),
                                   vector_of(in, 8, first)));
  });
}

void voronoi(uint32_t feature, uint32_t flags, const TextureInputs &in, TextureOutputs &out) {
  all_lanes(out, [&](int first) {
    return voronoi_texture<F>(feature, flags, vector_of(in, 0, first), vector_of(in, 3, first), vector_of(in, 6, first),
                              vector_of(in, 8, first));
  });
}

void gradient(uint32_t kind, const TextureInputs &in, TextureOutputs &out) {
  all_lanes(out, [&](int first) { return beside(V3(gradient_texture<F>(kind, vector_of(in, 0, first)))); });
}

void curve(const CurveTable &table, const TextureInputs &in, TextureOutputs &out) {
  all_lanes(out, [&](int first) { return beside(on_curves<F>(table, load(in.x[3] + first), vector_of(in, 0, first))); });
}

} // namespace

namespace LANCER_ISA {
const TextureKernel texture_kernel = {LANCER_ISA_NAME, noise, voronoi, gradient, curve};
}

} // namespace lancer
