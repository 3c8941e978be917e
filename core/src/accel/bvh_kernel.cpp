// Traversal of the wide BVH. Compiled once per instruction set, with LANCER_ISA naming it; all give the same bits, because no
// operation is contracted and boxes only ever decide what is not worth testing.
// This file may emit no shared (weak) symbol: the linker would keep one unit's copy for all. Hence plain structs, forced
// inlining, and no call of an inline function of another header out of line.
#include "accel/bvh_kernel.h"

#include "accel/object_ray.h"
#include "accel/simd.h"
#include "accel/triangle.h"

#ifndef LANCER_ISA
#define LANCER_ISA generic
#endif
#define LANCER_TEXT(x) #x
#define LANCER_NAME(x) LANCER_TEXT(x)

namespace lancer {

// quadric.cpp, compiled once for all.
bool intersect_quadric(const PlacedShape &shape, const Ray &ray, bool leaves, double &t);

namespace {

// The ray as the float slab test reads it, in a box frame. row: where the near and far planes of each axis stand in a node.
struct SlabRay {
  F8 origin[3], inverse[3];
  uint32_t near_row[3], far_row[3];
  float tau_min, tau_max;
};

// Rounds outwards: a parameter beyond the float's last digit must not be cut off.
LANCER_SIMD float round_up(double x) { return static_cast<float>(x + 0x1p-22 * magnitude(x)); }
LANCER_SIMD float round_down(double x) { return static_cast<float>(x - 0x1p-22 * magnitude(x)); }

// Directions below 2^-66 of the largest component move a ray by less than 2^-63 of the box frame: kBoxPad covers taking them
// for 2^-66, and no infinity times zero can arise.
LANCER_SIMD float inverse_component(double d) {
  const float x = static_cast<float>(d);
  return __builtin_fabsf(x) < 0x1p-66f ? __builtin_copysignf(0x1p66f, x) : 1.0f / x;
}

LANCER_SIMD void make_slab_ray(const PlacementFrame &frame, const ObjectRay &ray, double tmin, double tmax, SlabRay &slab) {
  for (uint32_t axis = 0; axis < 3; ++axis) {
    const float inverse = inverse_component(ray.d[axis]);
    slab.origin[axis] = splat8(static_cast<float>(ray.q[axis] * frame.scale));
    slab.inverse[axis] = splat8(inverse);
    slab.near_row[axis] = inverse < 0.0f ? axis + 3 : axis;
    slab.far_row[axis] = inverse < 0.0f ? axis : axis + 3;
  }
  slab.tau_min = round_down(box_tau_below(ray, frame, tmin));
  slab.tau_max = round_up(box_tau_above(ray, frame, tmax));
}

// Bit i: the ray meets child i; entry[i] then is where.
LANCER_SIMD uint32_t intersect_node(const BvhNode &node, const SlabRay &ray, F8 &entry) {
  const F8 nx = (load8(node.bounds[ray.near_row[0]]) - ray.origin[0]) * ray.inverse[0];
  const F8 ny = (load8(node.bounds[ray.near_row[1]]) - ray.origin[1]) * ray.inverse[1];
  const F8 nz = (load8(node.bounds[ray.near_row[2]]) - ray.origin[2]) * ray.inverse[2];
  const F8 fx = (load8(node.bounds[ray.far_row[0]]) - ray.origin[0]) * ray.inverse[0];
  const F8 fy = (load8(node.bounds[ray.far_row[1]]) - ray.origin[1]) * ray.inverse[1];
  const F8 fz = (load8(node.bounds[ray.far_row[2]]) - ray.origin[2]) * ray.inverse[2];
  entry = max8(max8(nx, ny), max8(nz, splat8(ray.tau_min)));
  return less_equal(entry, min8(min8(fx, fy), min8(fz, splat8(ray.tau_max))));
}

// Starts loading a node that waits on the stack.
LANCER_SIMD void prefetch(const BvhNode *nodes, uint32_t child) {
  if (child & kBvhLeaf)
    return;
  const char *line = reinterpret_cast<const char *>(nodes + child);
  for (size_t offset = 0; offset < sizeof(BvhNode); offset += 64)
    __builtin_prefetch(line + offset);
}

struct Pending {
  float entry;
  uint32_t child;
};

// Calls leaf(child) for the leaves on the ray, the nearer first, until it returns true. leaf may lower ray.tau_max.
template <class Leaf> LANCER_SIMD void visit_in_order(const BvhNode *nodes, SlabRay &ray, Leaf leaf) {
  Pending stack[kBvhStackSize];
  uint32_t size = 0, child = 0;
  for (;;) {
    if (child & kBvhLeaf) {
      if (leaf(child))
        return;
    } else {
      const BvhNode &node = nodes[child];
      F8 entry;
      uint32_t mask = intersect_node(node, ray, entry);
      if (mask != 0) {
        // Go straight on where only one child is met.
        uint32_t i = static_cast<uint32_t>(__builtin_ctz(mask));
        mask &= mask - 1;
        if (mask == 0) {
          child = node.child[i];
          continue;
        }

        // Push the children, keeping them sorted with the nearest on top; go on with that.
        alignas(32) float entries[kBvhWidth];
        store8(entries, entry);
        const uint32_t bottom = size;
        stack[size++] = {entries[i], node.child[i]};
        do {
          i = static_cast<uint32_t>(__builtin_ctz(mask));
          mask &= mask - 1;
          prefetch(nodes, node.child[i]);
          uint32_t place = size++;
          for (; place > bottom && stack[place - 1].entry < entries[i]; --place)
            stack[place] = stack[place - 1];
          stack[place] = {entries[i], node.child[i]};
        } while (mask != 0);
        child = stack[--size].child;
        continue;
      }
    }

    // Take up the next child that is not behind the best hit.
    do {
      if (size == 0)
        return;
      --size;
    } while (stack[size].entry > ray.tau_max);
    child = stack[size].child;
  }
}

// The same in any order: for questions that end with the first answer.
template <class Leaf> LANCER_SIMD void visit_all(const BvhNode *nodes, const SlabRay &ray, Leaf leaf) {
  uint32_t stack[kBvhStackSize];
  uint32_t size = 0, child = 0;
  for (;;) {
    if (child & kBvhLeaf) {
      if (leaf(child))
        return;
    } else {
      const BvhNode &node = nodes[child];
      F8 entry;
      for (uint32_t mask = intersect_node(node, ray, entry); mask != 0; mask &= mask - 1)
        stack[size++] = node.child[__builtin_ctz(mask)];
    }
    if (size == 0)
      return;
    child = stack[--size];
  }
}

template <bool any, class Leaf> LANCER_SIMD void visit(const BvhNode *nodes, SlabRay &ray, Leaf leaf) {
  if constexpr (any)
    visit_all(nodes, ray, leaf);
  else
    visit_in_order(nodes, ray, leaf);
}

// Four triangles that may be met: their parameters and edge functions.
struct BlockHits {
  alignas(32) double t[4], wb[4], wc[4], det[4];
};

// intersect_triangle() of triangle.h, four at a time. Bit i: triangle i is met with tmin < t < tmax and t <= limit.
LANCER_SIMD uint32_t intersect_block(const TriangleBlock &block, const ObjectRay &ray, const Shear &s, double tmin, double tmax,
                                     double limit, BlockHits &hits) {
  const D4 ox = splat4(ray.o[s.kx]), oy = splat4(ray.o[s.ky]), oz = splat4(ray.o[s.kz]);
  const D4 sx = splat4(s.sx), sy = splat4(s.sy), sz = splat4(s.sz);
  D4 x[3], y[3], z[3];
  for (int corner = 0; corner < 3; ++corner) {
    z[corner] = widen4(block.corner[corner][s.kz]) - oz;
    x[corner] = (widen4(block.corner[corner][s.kx]) - ox) - sx * z[corner];
    y[corner] = (widen4(block.corner[corner][s.ky]) - oy) - sy * z[corner];
  }
  const D4 wa = x[2] * y[1] - y[2] * x[1];
  const D4 wb = x[0] * y[2] - y[0] * x[2];
  const D4 wc = x[1] * y[0] - y[1] * x[0];
  const D4 zero = splat4(0.0);
  const uint32_t front = less_equal(zero, wa) & less_equal(zero, wb) & less_equal(zero, wc);
  const uint32_t back = less_equal(wa, zero) & less_equal(wb, zero) & less_equal(wc, zero);
  const D4 det = wa + wb + wc;
  uint32_t met = (front | back) & not_equal(det, zero);
  if (met == 0)
    return 0;
  const D4 depth = wa * (sz * z[0]) + wb * (sz * z[1]) + wc * (sz * z[2]);
  store4(hits.t, splat4(ray.t0) + (depth / det) * splat4(ray.unit));
  store4(hits.wb, wb);
  store4(hits.wc, wc);
  store4(hits.det, det);
  for (uint32_t rest = met; rest != 0; rest &= rest - 1) {
    const int i = __builtin_ctz(rest);
    const double t = hits.t[i];
    if (!(tmin < t && t < tmax && t <= limit))
      met &= ~(1u << i);
  }
  return met;
}

// One instance; true where the search may end.
template <bool any> LANCER_SIMD bool intersect_instance(const BvhScene &scene, uint32_t instance, const Ray &ray, Hit &best) {
  const PlacedShape &shape = scene.shapes[instance];
  if (!visible(shape, ray))
    return false;
  if (shape.mesh == kNone) {
    double t;
    if (!intersect_quadric(shape, ray, ray.skip_instance == instance, t) || !closer(t, instance, 0, best))
      return false;
    best.t = t;
    best.u = best.v = 0.0;
    best.instance = instance;
    best.primitive = 0;
    return any;
  }

  ObjectRay object_ray;
  const BvhView &bvh = scene.meshes[shape.mesh];
  if (!bvh.nodes || !enter_shape(shape, ray, object_ray))
    return false;
  // Most instances are entered in vain: the shear's divisions wait for the first leaf.
  Shear shear;
  bool sheared = false;
  SlabRay slab;
  make_slab_ray(shape.frame, object_ray, ray.tmin, ray.tmax < best.t ? ray.tmax : best.t, slab);
  const uint32_t skip = ray.skip_instance == instance ? ray.skip_primitive : kNone;
  bool found = false;
  visit<any>(
      bvh.nodes, slab, [&](uint32_t leaf) __attribute__((always_inline)) {
        const TriangleBlock &block = bvh.blocks[leaf & ~kBvhLeaf];
        if (!sheared) {
          shear = make_shear(object_ray);
          sheared = true;
        }
        BlockHits hits;
        for (uint32_t met = intersect_block(block, object_ray, shear, ray.tmin, ray.tmax, best.t, hits); met != 0;
             met &= met - 1) {
          const int i = __builtin_ctz(met);
          const uint32_t primitive = block.primitive[i];
          if (primitive == skip || !closer(hits.t[i], instance, primitive, best))
            continue;
          best.t = hits.t[i];
          best.u = hits.wb[i] / hits.det[i];
          best.v = hits.wc[i] / hits.det[i];
          best.instance = instance;
          best.primitive = primitive;
          found = true;
          if (any)
            return true;
          slab.tau_max = round_up(box_tau_above(object_ray, shape.frame, best.t));
        }
        return false;
      });
  return any && found;
}

template <bool any> LANCER_SIMD void intersect_scene(const BvhScene &scene, const Ray &ray, Hit &best) {
  best.t = __builtin_inf();
  best.u = best.v = 0.0;
  best.instance = best.primitive = kNone;
  ObjectRay world_ray;
  if (!enter_world(scene.world, ray, world_ray))
    return;

  // Try what has no box, then the instances whose boxes are met.
  for (uint32_t i = 0; i < scene.unbounded_count; ++i)
    if (intersect_instance<any>(scene, scene.unbounded[i], ray, best))
      return;
  if (!scene.top)
    return;
  SlabRay slab;
  make_slab_ray(scene.world, world_ray, ray.tmin, ray.tmax < best.t ? ray.tmax : best.t, slab);
  visit<any>(
      scene.top, slab, [&](uint32_t leaf) __attribute__((always_inline)) {
        const uint32_t first = (leaf & ~kBvhLeaf) >> 2, count = (leaf & 3) + 1;
        for (uint32_t i = first; i < first + count; ++i)
          if (intersect_instance<any>(scene, scene.top_order[i], ray, best))
            return true;
        if (best.t < ray.tmax)
          slab.tau_max = round_up(box_tau_above(world_ray, scene.world, best.t));
        return false;
      });
}

[[gnu::flatten]] void closest(const BvhScene &scene, const Ray *rays, Hit *hits, size_t count) {
  for (size_t i = 0; i < count; ++i)
    intersect_scene<false>(scene, rays[i], hits[i]);
}

[[gnu::flatten]] void any_hit(const BvhScene &scene, const Ray *rays, uint8_t *occluded, size_t count) {
  for (size_t i = 0; i < count; ++i) {
    Hit hit;
    intersect_scene<true>(scene, rays[i], hit);
    occluded[i] = hit.instance != kNone;
  }
}

} // namespace

namespace LANCER_ISA {
const BvhKernel kernel = {LANCER_NAME(LANCER_ISA), closest, any_hit};
}

} // namespace lancer
