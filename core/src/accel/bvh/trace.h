// Traversal of the wide BVH by a batch of rays: coherent rays walk the tree as a packet (packet.h); the others go on alone,
// kFlights at a time, by the kind of the entry on top of their stack (visit.h). Part of bvh_kernel.cpp and
// moving_bvh_kernel.cpp: everything has internal linkage.
#pragma once

#include "accel/bvh/packet.h"
#include "accel/bvh/visit.h"

namespace lancer {

namespace {

// Starts the flight of a ray; returns false if the ray's result is already known.
LANCER_LANE bool start(const BvhScene &scene, const Ray &ray, const Entering &e, uint32_t lane, Flight &s) {
  s.best.t = __builtin_inf();
  s.best.u = s.best.v = 0.0;
  s.best.instance = s.best.primitive = kNone;
  s.instance = kNone;
  s.tmin = ray.tmin;
  s.tmax = ray.tmax;
  s.time = ray.time;
  s.tree_moves = true;
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
  return (e.usable >> lane & 1) && s.size > 1;
}

// Writes the result of a ray. Queries that count work write none.
template <Question q> LANCER_LANE void store_answer(const Hit &best, size_t number, Hit *hits, uint8_t *occluded) {
  if constexpr (q.counted)
    return;
  else if constexpr (q.any)
    occluded[number] = best.instance != kNone;
  else
    hits[number] = best;
}

// Flights that wait for the same kind of work.
struct Queue {
  uint32_t count = 0;
  Flight *flights[kFlights];
};

template <Question q>
LANCER_LANE void trace(const BvhScene &scene, const Ray *rays, Hit *hits, uint8_t *occluded, size_t count, HitFilter *filter,
                       TraversalCounts *counts) {
  Flight flights[kFlights];
  Queue queues[kBvhKinds];
  Flight *others[kFlights];
  uint32_t other_count = 0;
  size_t next = 0, row = q.any || q.counted || q.moving ? 4 : find_row(rays, count);
  Entering entering;
  Leftovers leftovers;
  uint32_t waiting = 0; // lanes of entering without a flight
  bool together = false;
  // Replaces a flight that has ended by that of the next ray that needs a traversal of its own.
  const auto refill = [&](Flight & s) __attribute__((always_inline)) {
    for (;;) {
      while (waiting != 0) {
        const uint32_t lane = static_cast<uint32_t>(__builtin_ctz(waiting));
        waiting &= waiting - 1;
        s.number = entering.number[lane];
        const bool usable = start(scene, rays[s.number], entering, lane, s);
        if (together)
          resume(leftovers, lane, s);
        if (usable) {
          go_on(s);
          others[other_count++] = &s;
          return;
        }
        store_answer<q>(s.best, s.number, hits, occluded);
      }
      if (next == count)
        return;
      // Take the next rays: a square of the picture if the batch consists of rows of pixels.
      const size_t left = count - next, taken = left < kPacket ? left : kPacket;
      if (next % (4 * row) == 0 && left < 4 * row)
        row = 4;
      const size_t corner = next - next % (4 * row) + next % (4 * row) / 4;
      for (uint32_t i = 0; i < kPacket; ++i) {
        entering.number[i] = static_cast<uint32_t>(i < taken ? corner + i % 4 + row * (i / 4) : next);
        entering.rays[i] = rays + entering.number[i];
      }
      next += taken;
      waiting = (1u << taken) - 1;
      enter_world_packet(scene.world, entering);
      // Rays of several times meet different scenes: each goes on alone.
      together = !q.any && !q.counted && !q.moving && taken == kPacket && scene.unbounded_count < kLeftovers &&
                 stay_together(scene.world, entering);
      if constexpr (!q.moving)
        if (together) {
          waiting = trace_packet<q>(scene, entering, filter, leftovers);
          for (uint32_t i = 0; i < kPacket; ++i)
            store_answer<q>(leftovers.best[i], entering.number[i], hits, occluded);
        }
    }
  };
  // Does the work of one kind for all flights that wait for it.
  const auto each = [&](uint32_t kind, auto work) __attribute__((always_inline)) {
    Queue &queue = queues[kind];
    other_count = queue.count;
    queue.count = 0;
    if (q.counted) {
      counts->triangle_blocks += kind == kBvhTriangles || kind == kBvhPlaced ? other_count : 0;
      counts->sphere_blocks += kind == kBvhSpheres ? other_count : 0;
      counts->instances += kind == kBvhInstance ? other_count : 0;
    }
    for (uint32_t i = 0; i < other_count; ++i)
      work(*queue.flights[i]);
    for (uint32_t i = 0; i < other_count; ++i)
      go_on(*(others[i] = queue.flights[i]));
  };

  for (Flight &s : flights) {
    s.arrays[kBvhTriangles] = s.arrays[kBvhPlaced] = reinterpret_cast<const char *>(scene.blocks);
    s.arrays[kBvhSpheres] = reinterpret_cast<const char *>(scene.spheres);
    s.arrays[kBvhInstance] = reinterpret_cast<const char *>(scene.shapes);
    s.arrays[kBvhLeave] = s.arrays[kBvhUnbounded] = s.arrays[kBvhDone] = reinterpret_cast<const char *>(&s);
    refill(s);
  }
  for (;;) {
    // Sort the flights by kind; process the kind with the most flights.
    for (uint32_t i = 0; i < other_count; ++i) {
      Queue &queue = queues[others[i]->kind];
      queue.flights[queue.count++] = others[i];
    }
    other_count = 0;
    uint32_t most = 0;
    for (uint32_t kind = 1; kind < kBvhKinds; ++kind)
      most = queues[kind].count > queues[most].count ? kind : most;
    switch (most) {
    case kBvhInner: {
      Queue &queue = queues[kBvhInner];
      const uint32_t present = queue.count;
      if (present == 0)
        return;
      if (q.counted)
        counts->nodes += present;
      for (uint32_t i = 0; i < present; ++i)
        visit_node<q>(*queue.flights[i]);
      // Keep the flights that wait for another node.
      uint32_t inner = 0, other = 0;
      for (uint32_t i = 0; i < present; ++i) {
        Flight *s = queue.flights[i];
        go_on(*s);
        queue.flights[inner] = others[other] = s;
        inner += s->kind == kBvhInner;
        other += s->kind != kBvhInner;
      }
      queue.count = inner;
      other_count = other;
      break;
    }
    case kBvhTriangles:
      each(
          kBvhTriangles, [&](Flight & s) __attribute__((always_inline)) { visit_triangles<q>(filter, s); });
      break;
    case kBvhPlaced:
      each(
          kBvhPlaced, [&](Flight & s) __attribute__((always_inline)) { visit_placed<q>(scene, rays[s.number], filter, s); });
      break;
    case kBvhSpheres:
      each(
          kBvhSpheres, [&](Flight & s) __attribute__((always_inline)) { visit_spheres<q>(scene, rays[s.number], filter, s); });
      break;
    case kBvhInstance:
      each(
          kBvhInstance, [&](Flight & s)
                            __attribute__((always_inline)) { enter_instance<q>(scene, rays[s.number], filter, s); });
      break;
    case kBvhUnbounded:
      each(
          kBvhUnbounded, [&](Flight & s)
                             __attribute__((always_inline)) { visit_unbounded<q>(scene, rays[s.number], filter, s); });
      break;
    case kBvhLeave:
      each(
          kBvhLeave, [&](Flight & s) __attribute__((always_inline)) { leave_instance<q>(scene, s); });
      break;
    case kBvhDone: {
      Queue &queue = queues[kBvhDone];
      const uint32_t present = queue.count;
      queue.count = 0;
      for (uint32_t i = 0; i < present; ++i) {
        store_answer<q>(queue.flights[i]->best, queue.flights[i]->number, hits, occluded);
        refill(*queue.flights[i]);
      }
      break;
    }
    }
  }
}

} // namespace
} // namespace lancer
