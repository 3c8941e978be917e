// Compiled once per instruction set, with LANCER_ISA naming it. This file may emit no shared (weak) symbol: see bvh_kernel.cpp.
#include "integrator/course_kernel.h"

#include "accel/kernel_name.h"
#include "bsdf/coating.h"
#include "bsdf/frame.h"
#include "bsdf/normals.h"
#include "scene/hit_surface.h"
#include "simd/kernel_lanes.h"

namespace lancer {
namespace {

// Where a ray towards d leaves the surface: leave().
LANCER_LANE D3 origin(const CourseBlock &block, int first, const D3 &d) {
  const D3 ng = widen(load3(block.ng, first));
  const D side = select(dot(ng, d) < D(0.0), D(-1.0), D(1.0));
  return load3(block.p, first) + side * load(block.offset + first) * ng;
}

// Surfaces of spheres and planes, beside those that are given.
LANCER_LANE void find_surfaces(CourseBlock &block, int first) {
  const M plane = some(block.plane, first), exact = plane | some(block.sphere, first);
  if (!any(exact))
    return;
  const QuadricKinds<F> kinds{plane, mask_of(0), mask_of(0)};
  const SurfaceLanes<F> surface = quadric_surface(Placements<F>(block.placement + first), kinds, load3(block.o, first),
                                                  load3(block.d, first), load(block.t + first));
  store3(block.p, first, exact, surface.p);
  store(block.offset + first, exact, surface.offset);
  store3(block.ng, first, exact, surface.ng);
  store3(block.ns, first, exact, surface.ns);
}

[[gnu::flatten]] void look(CourseBlock &block) {
  const F zero(0.0f);
  block.odd = block.goes_on = 0;
  for (int first = 0; first < static_cast<int>(block.count); first += kLanes) {
    find_surfaces(block, first);
    // Back along the ray, and both normals to the viewer's side.
    const D3 d = load3(block.d, first);
    const V3 wo_world = -narrow(d * (D(1.0) / sqrt(dot(d, d))));
    const V3 out_ns = load3(block.ns, first), out_ng = load3(block.ng, first);
    const M inside = dot(wo_world, out_ng) < zero;
    const V3 ns = select(inside, -out_ns, out_ns), ng = select(inside, -out_ng, out_ng);
    const Frame<F> frame(ns);
    const V3 wo = frame.to_local(wo_world);
    const F ior = load(block.ior + first);
    store3(block.viewer_ng, first, ng);
    store3(block.viewer_ns, first, ns);
    store3(block.tangent, first, frame.t);
    store3(block.bitangent, first, frame.b);
    store3(block.wo, first, wo);
    block.odd |= bits(!reflects_above(wo_world, ns, ng)) << first;
    // What the coating mirrors: course_branches() and spawn().
    const V3 reflected = load3(block.ks, first) * fresnel_dielectric(wo.z, ior);
    const V3 mirrored = frame.to_world(reflect_local(wo));
    const V3 weight = load3(block.weight, first) * reflected;
    const F share = max(max(weight.x, weight.y), weight.z);
    const M mirrors = some(block.coated, first) & (wo.z > zero) & ((reflected.x + reflected.y + reflected.z) / F(3.0f) > zero) &
                      (dot(mirrored, ng) > zero);
    block.goes_on |= bits(mirrors & (share > zero) & !(share <= F(block.threshold))) << first;
    store3(block.mirrored, first, mirrored);
    store3(block.next_weight, first, weight);
    store3(block.next_origin, first, origin(block, first, widen(mirrored)));
  }
}

// sample_true_point() and course_irradiance().
LANCER_LANE void ask_point(const CourseBlock &block, int first, const CourseLamp &lamp, CourseLit &lit) {
  const D3 position{D(lamp.position[0]), D(lamp.position[1]), D(lamp.position[2])};
  const D3 emission{D(lamp.emission[0]), D(lamp.emission[1]), D(lamp.emission[2])};
  const D3 to_light = position - load3(block.p, first);
  const D distance = sqrt(dot(to_light, to_light));
  store3(lit.wi, first, to_light / distance);
  store3(lit.target, first, position);
  store3(lit.irradiance, first, narrow(emission * (D(1.0) / (distance * distance))));
  lit.there |= bits(distance > D(0.0)) << first;
}

LANCER_LANE V3 color(const float (&of)[3]) { return {F(of[0]), F(of[1]), F(of[2])}; }

[[gnu::flatten]] void light(const CourseBlock &block, const CourseLamp &lamp, CourseLit &lit) {
  const F zero(0.0f);
  const V3 dark{zero, zero, zero};
  lit.lit = 0;
  if (lamp.point)
    lit.there = lit.far = 0;
  for (int first = 0; first < static_cast<int>(block.count); first += kLanes) {
    if (lamp.point)
      ask_point(block, first, lamp, lit);
    const D3 wi_exact = load3(lit.wi, first);
    const V3 wi_world = narrow(wi_exact), wo = load3(block.wo, first);
    Frame<F> frame;
    frame.t = load3(block.tangent, first);
    frame.b = load3(block.bitangent, first);
    frame.n = load3(block.viewer_ns, first);
    const V3 wi = frame.to_local(wi_world);
    // course_illumination()
    const M above = some(lit.there, first) & (wi.z > zero);
    const V3 kd = load3(block.kd, first) * (F(kInvPi) * wi.z);
    const V3 diffuse = select(above & some(block.matte, first), kd, dark);
    const M coated = above & some(block.coated, first) & (wo.z > zero);
    F f = zero;
    if (any(coated)) {
      Lobe<F> lobe;
      lobe.alpha_x = load(block.alpha + first);
      lobe.ior = load(block.ior + first);
      const V3 h = half_vector(wo, wi);
      f = select(coated, coating_eval(lobe, wo, wi, h, coating_d(lobe, wo, h)), zero);
    }
    const V3 specular = load3(block.ks, first) * (f * wi.z);
    const V3 seen = diffuse * color(lamp.diffuse) + select(f != zero, specular, dark) * color(lamp.specular);
    const V3 sum = load3(lit.irradiance, first) * seen;
    store3(lit.contribution, first, load3(block.weight, first) * sum);
    // The lamp has to be on the viewer's side of the surface.
    const M same_side = dot(wi_world, load3(block.viewer_ng, first)) > zero;
    lit.lit |= bits(some(lit.there, first) & same_side & !black(sum)) << first;
    const D3 o = origin(block, first, wi_exact);
    store3(lit.origin, first, o);
    store3(lit.d, first, select(some(lit.far, first), wi_exact, load3(lit.target, first) - o));
  }
}

} // namespace

namespace LANCER_ISA {
const CourseKernel course_kernel = {look, light};
}

} // namespace lancer
