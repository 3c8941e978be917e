// Traversal of the wide BVH. Compiled once per instruction set, with LANCER_ISA naming it; all give the same bits, because no
// operation is contracted and boxes only ever decide what is not worth testing.
// This file may emit no shared (weak) symbol: the linker would keep one unit's copy for all. Hence plain structs, forced
// inlining, and no call of an inline function of another header out of line.
#include "accel/bvh_kernel.h"

#include "accel/kernel_block.h"
#include "accel/kernel_enter.h"
#include "accel/kernel_slot.h"
#include "accel/kernel_sphere.h"

#ifndef LANCER_ISA
#define LANCER_ISA generic
#endif
#define LANCER_TEXT(x) #x
#define LANCER_NAME(x) LANCER_TEXT(x)

namespace lancer {

// quadric.cpp, compiled once for all.
bool intersect_quadric(const PlacedShape &shape, const Ray &ray, bool leaves, double &t);

namespace {

// Replaces a node by its children that the ray meets, the nearest on top.
LANCER_SIMD void visit_node(Slot &s) {
  const Slab &ray = s.slab;
  const BvhNode &node = *reinterpret_cast<const BvhNode *>(s.at);
  F8 near[3], far[3];
  for (int axis = 0; axis < 3; ++axis) {
    const F8 inverse = splat8(ray.inverse[axis]), shift = splat8(ray.shift[axis]);
    const uint32_t down = ray.octant >> axis & 1;
    near[axis] = multiply_subtract(load8(node.bounds[axis][down]), inverse, shift);
    far[axis] = multiply_subtract(load8(node.bounds[axis][down ^ 1]), inverse, shift);
  }
  const F8 entry = max8(max8(near[0], near[1]), max8(near[2], splat8(ray.tau_min)));
  const F8 exit = min8(min8(far[0], far[1]), min8(far[2], splat8(ray.tau_max)));
  s.size += compress_ordered8(s.entries + s.size, s.children + s.size, entry, exit, node.child, node.order[ray.octant]);
}

LANCER_SIMD void done(Slot &s) { s.size = 1; }

LANCER_SIMD void become_mesh_ray(const BvhScene &scene, uint32_t instance, const Ray &ray, Slot &s) {
  const PlacedShape &shape = scene.shapes[instance];
  s.instance = instance;
  s.skip = ray.skip_instance == instance ? ray.skip_primitive : kNone;
  s.usable = visible(shape, ray) && enter_mesh(shape, ray, s.ray);
}

// Keeps the place of an exact surface if it is closer.
template <bool any> LANCER_SIMD void keep_quadric(double t, uint32_t instance, Slot &s) {
  if (!closer(t, instance, 0, s.best))
    return;
  s.best.t = t;
  s.best.u = s.best.v = 0.0;
  s.best.instance = instance;
  s.best.primitive = 0;
  if (any)
    done(s);
  else
    shorten(s);
}

template <bool any> LANCER_SIMD void try_quadric(const PlacedShape &shape, uint32_t instance, const Ray &ray, Slot &s) {
  double t;
  if (visible(shape, ray) && intersect_quadric(shape, ray, ray.skip_instance == instance, t))
    keep_quadric<any>(t, instance, s);
}

template <bool any> LANCER_SIMD void visit_spheres(const BvhScene &scene, const Ray &ray, Slot &s) {
  const SphereBlock &block = *reinterpret_cast<const SphereBlock *>(s.at);
  SphereTerms terms;
  for (uint32_t met = intersect_spheres(block, ray, terms); met != 0; met &= met - 1) {
    const int i = __builtin_ctz(met);
    const uint32_t instance = block.instance[i];
    if (instance == kNone)
      return;
    const PlacedShape &shape = scene.shapes[instance];
    double t;
    if (visible(shape, ray) && choose_root(terms, i, shape.slack, ray.skip_instance == instance, s.tmin, s.tmax, t))
      keep_quadric<any>(t, instance, s);
  }
}

// Enters an instance, if the ray can meet it at all.
template <bool any> LANCER_SIMD void enter_instance(const BvhScene &scene, const Ray &ray, Slot &s) {
  const PlacedShape &shape = *reinterpret_cast<const PlacedShape *>(s.at);
  const uint32_t instance = static_cast<uint32_t>(&shape - scene.shapes);
  if (shape.mesh == kNone)
    return try_quadric<any>(shape, instance, ray, s);
  const BvhView &bvh = scene.meshes[shape.mesh];
  if (!bvh.nodes)
    return;
  become_mesh_ray(scene, instance, ray, s);
  if (!s.usable)
    return;
  s.outer = s.slab;
  make_slab(shape.frame, s.ray, s.tmin, s.tmax < s.best.t ? s.tmax : s.best.t, s.slab);
  s.arrays[kBvhInner] = reinterpret_cast<const char *>(bvh.nodes);
  s.arrays[kBvhTriangles] = reinterpret_cast<const char *>(bvh.blocks);
  push(s, 0.0f, kBvhLeave << kBvhKindShift);
  s.base = s.size;
  push(s, 0.0f, 0);
}

LANCER_SIMD void leave_instance(const BvhScene &scene, Slot &s) {
  s.slab = s.outer;
  s.arrays[kBvhInner] = reinterpret_cast<const char *>(scene.top);
  s.base = 1;
  if (s.best.instance == s.instance)
    shorten(s);
}

template <bool any> LANCER_SIMD void visit_triangles(Slot &s) {
  const TriangleBlock &block = *reinterpret_cast<const TriangleBlock *>(s.at);
  BlockHits hits;
  bool found = false;
  for (uint32_t met = intersect_block(block, s.ray, s.tmin, s.tmax, s.best.t, hits); met != 0; met &= met - 1) {
    const int i = __builtin_ctz(met);
    const uint32_t primitive = block.primitive[i];
    if (primitive == s.skip || !closer(hits.t[i], s.instance, primitive, s.best))
      continue;
    s.best.t = hits.t[i];
    s.best.u = hits.wb[i] / hits.det[i];
    s.best.v = hits.wc[i] / hits.det[i];
    s.best.instance = s.instance;
    s.best.primitive = primitive;
    found = true;
  }
  if (found) {
    if (any)
      done(s);
    else
      shorten(s);
  }
}

// A block of the world's own tree: it has its instance's space to itself.
template <bool any> LANCER_SIMD void visit_placed(const BvhScene &scene, const Ray &ray, Slot &s) {
  const uint32_t instance = scene.block_instance[reinterpret_cast<const TriangleBlock *>(s.at) - scene.blocks];
  if (instance != s.instance)
    become_mesh_ray(scene, instance, ray, s);
  if (s.usable)
    visit_triangles<any>(s);
}

// Tries what has no box, up to the next mesh.
template <bool any> LANCER_SIMD void visit_unbounded(const BvhScene &scene, const Ray &ray, Slot &s) {
  while (s.unbounded > 0 && !(any && s.best.instance != kNone)) {
    const uint32_t instance = scene.unbounded[--s.unbounded];
    if (scene.shapes[instance].mesh == kNone) {
      try_quadric<any>(scene.shapes[instance], instance, ray, s);
      continue;
    }
    push(s, -__builtin_inff(), kBvhUnbounded << kBvhKindShift);
    push(s, -__builtin_inff(), kBvhInstance << kBvhKindShift | instance * kBvhSteps<PlacedShape>);
    return;
  }
}

// Starts a ray; false where its answer is known at once.
LANCER_SIMD bool start(const BvhScene &scene, const Ray &ray, const Entering &e, uint32_t lane, Slot &s) {
  s.best.t = __builtin_inf();
  s.best.u = s.best.v = 0.0;
  s.best.instance = s.best.primitive = kNone;
  s.instance = kNone;
  s.tmin = ray.tmin;
  s.tmax = ray.tmax;
  s.arrays[kBvhInner] = reinterpret_cast<const char *>(scene.top);
  s.slab.octant = 0;
  for (int axis = 0; axis < 3; ++axis) {
    s.slab.inverse[axis] = e.inverse[axis][lane];
    s.slab.shift[axis] = e.shift[axis][lane];
    s.slab.octant |= uint32_t{e.inverse[axis][lane] < 0.0f} << axis;
  }
  s.slab.tau_min = e.tau_min[lane];
  s.slab.tau_max = e.tau_max[lane];
  s.slab.t0 = e.t0[lane];
  s.slab.inverse_unit = e.inverse_unit[lane];
  s.slab.scale = scene.world.scale;
  s.unbounded = scene.unbounded_count;
  s.children[0] = kBvhDone << kBvhKindShift;
  s.base = s.size = 1;
  if (scene.top)
    push(s, -__builtin_inff(), kBvhInner << kBvhKindShift);
  if (s.unbounded > 0)
    push(s, -__builtin_inff(), kBvhUnbounded << kBvhKindShift);
  return e.usable[lane] != 0 && s.size > 1;
}

// Nobody wants the answers of rays whose work is counted.
template <bool any, bool counted> LANCER_SIMD void store_answer(const Slot &s, Hit *hits, uint8_t *occluded) {
  if constexpr (counted)
    return;
  else if constexpr (any)
    occluded[s.number] = s.best.instance != kNone;
  else
    hits[s.number] = s.best;
}

// The slots that wait for the same kind of work.
struct Queue {
  uint32_t count = 0;
  Slot *slots[kSlots];
};

template <bool any, bool counted>
LANCER_SIMD void trace(const BvhScene &scene, const Ray *rays, Hit *hits, uint8_t *occluded, size_t count,
                       TraversalCounts *counts) {
  Slot slots[kSlots];
  Queue queues[kBvhKinds];
  Slot *others[kSlots];
  uint32_t other_count = 0;
  size_t next = 0;
  Entering entering;
  // Fills a slot with the next ray that has a way to go.
  const auto refill = [&](Slot & s) __attribute__((always_inline)) {
    while (next < count) {
      const uint32_t lane = next % Entering::kLanes;
      if (lane == 0)
        enter_world8(scene.world, rays + next, count - next, entering);
      s.number = static_cast<uint32_t>(next);
      if (start(scene, rays[next++], entering, lane, s)) {
        go_on(s);
        others[other_count++] = &s;
        return;
      }
      store_answer<any, counted>(s, hits, occluded);
    }
  };
  // Does the work of one kind for all that wait for it.
  const auto each = [&](uint32_t kind, auto work) __attribute__((always_inline)) {
    Queue &queue = queues[kind];
    other_count = queue.count;
    queue.count = 0;
    if (counted) {
      counts->triangle_blocks += kind == kBvhTriangles || kind == kBvhPlaced ? other_count : 0;
      counts->sphere_blocks += kind == kBvhSpheres ? other_count : 0;
      counts->instances += kind == kBvhInstance ? other_count : 0;
    }
    for (uint32_t i = 0; i < other_count; ++i)
      work(*queue.slots[i]);
    for (uint32_t i = 0; i < other_count; ++i)
      go_on(*(others[i] = queue.slots[i]));
  };

  for (Slot &s : slots) {
    s.arrays[kBvhTriangles] = s.arrays[kBvhPlaced] = reinterpret_cast<const char *>(scene.blocks);
    s.arrays[kBvhSpheres] = reinterpret_cast<const char *>(scene.spheres);
    s.arrays[kBvhInstance] = reinterpret_cast<const char *>(scene.shapes);
    s.arrays[kBvhLeave] = s.arrays[kBvhUnbounded] = s.arrays[kBvhDone] = reinterpret_cast<const char *>(&s);
    refill(s);
  }
  for (;;) {
    // Sort the slots by what they wait for; take up what most wait for.
    for (uint32_t i = 0; i < other_count; ++i) {
      Queue &queue = queues[others[i]->kind];
      queue.slots[queue.count++] = others[i];
    }
    other_count = 0;
    uint32_t most = 0;
    for (uint32_t kind = 1; kind < kBvhKinds; ++kind)
      most = queues[kind].count > queues[most].count ? kind : most;
    switch (most) {
    case kBvhInner: {
      Queue &queue = queues[kBvhInner];
      const uint32_t waiting = queue.count;
      if (waiting == 0)
        return;
      if (counted)
        counts->nodes += waiting;
      for (uint32_t i = 0; i < waiting; ++i)
        visit_node(*queue.slots[i]);
      // Those that come to another node stay.
      uint32_t inner = 0, other = 0;
      for (uint32_t i = 0; i < waiting; ++i) {
        Slot *s = queue.slots[i];
        go_on(*s);
        queue.slots[inner] = others[other] = s;
        inner += s->kind == kBvhInner;
        other += s->kind != kBvhInner;
      }
      queue.count = inner;
      other_count = other;
      break;
    }
    case kBvhTriangles:
      each(
          kBvhTriangles, [&](Slot & s) __attribute__((always_inline)) { visit_triangles<any>(s); });
      break;
    case kBvhPlaced:
      each(
          kBvhPlaced, [&](Slot & s) __attribute__((always_inline)) { visit_placed<any>(scene, rays[s.number], s); });
      break;
    case kBvhSpheres:
      each(
          kBvhSpheres, [&](Slot & s) __attribute__((always_inline)) { visit_spheres<any>(scene, rays[s.number], s); });
      break;
    case kBvhInstance:
      each(
          kBvhInstance, [&](Slot & s) __attribute__((always_inline)) { enter_instance<any>(scene, rays[s.number], s); });
      break;
    case kBvhUnbounded:
      each(
          kBvhUnbounded, [&](Slot & s) __attribute__((always_inline)) { visit_unbounded<any>(scene, rays[s.number], s); });
      break;
    case kBvhLeave:
      each(
          kBvhLeave, [&](Slot & s) __attribute__((always_inline)) { leave_instance(scene, s); });
      break;
    case kBvhDone: {
      Queue &queue = queues[kBvhDone];
      const uint32_t waiting = queue.count;
      queue.count = 0;
      for (uint32_t i = 0; i < waiting; ++i) {
        store_answer<any, counted>(*queue.slots[i], hits, occluded);
        refill(*queue.slots[i]);
      }
      break;
    }
    }
  }
}

[[gnu::flatten]] void closest(const BvhScene &scene, const Ray *rays, Hit *hits, size_t count) {
  trace<false, false>(scene, rays, hits, nullptr, count, nullptr);
}

[[gnu::flatten]] void any_hit(const BvhScene &scene, const Ray *rays, uint8_t *occluded, size_t count) {
  trace<true, false>(scene, rays, nullptr, occluded, count, nullptr);
}

[[gnu::flatten]] void count_work(const BvhScene &scene, const Ray *rays, size_t count, bool any, TraversalCounts &counts) {
  if (any)
    trace<true, true>(scene, rays, nullptr, nullptr, count, &counts);
  else
    trace<false, true>(scene, rays, nullptr, nullptr, count, &counts);
}

} // namespace

namespace LANCER_ISA {
const BvhKernel kernel = {LANCER_NAME(LANCER_ISA), closest, any_hit, count_work};
}

} // namespace lancer
