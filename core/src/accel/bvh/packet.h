// Traversal of packets of coherent rays: each child's box is tested for all rays at once. Subtrees that only a few rays hit
// become leftovers, which each ray traverses alone. Part of bvh_kernel.cpp: everything has internal linkage.
#pragma once

#include "accel/bvh/blocks.h"

namespace lancer {

namespace {

constexpr uint32_t kFew = 2;       // at most this many lanes are faster alone
constexpr uint32_t kLeftovers = 8; // per lane

// The entries that each lane still has to visit, and its best hit so far.
struct Leftovers {
  Hit best[kPacket];
  alignas(64) double best_t[kPacket];
  uint32_t count[kPacket];
  float entries[kPacket][kLeftovers];
  uint32_t children[kPacket][kLeftovers];
};

// Appends a child to the leftovers of each of these lanes; returns false if the leftovers of a lane are full.
LANCER_LANE bool leave_over(uint32_t child, uint32_t lanes, const float *entry, Leftovers &l) {
  for (uint32_t rest = lanes; rest != 0; rest &= rest - 1)
    if (l.count[__builtin_ctz(rest)] == kLeftovers)
      return false;
  for (uint32_t rest = lanes; rest != 0; rest &= rest - 1) {
    const int lane = __builtin_ctz(rest);
    const uint32_t i = l.count[lane]++;
    l.entries[lane][i] = entry ? entry[lane] : -__builtin_inff();
    l.children[lane][i] = child;
  }
  return true;
}

// Continues with the leftovers of a lane alone, the nearest on top.
LANCER_LANE void resume(const Leftovers &l, uint32_t lane, Flight &s) {
  s.best = l.best[lane];
  s.unbounded = 0;
  s.size = 1;
  for (uint32_t i = l.count[lane]; i-- > 0;)
    push(s, l.entries[lane][i], l.children[lane][i]);
}

struct Packet {
  PacketRays rays; // in the space of an instance
  uint32_t instance;
  uint32_t seeing; // lanes that can hit the instance
  PacketSlabs inner;
  uint32_t size; // of the stack
  alignas(64) float entries[kStackSize][kPacket];
  uint32_t children[kStackSize];
};

// The ray of each lane, and the query.
struct PacketAsks {
  const Ray *const *rays;
  const uint32_t *number; // in the batch
  HitFilter *filter;
};

// Stores a closer hit if it passes the filter.
template <Question q>
LANCER_LANE bool store_hit(const PacketAsks &asks, Leftovers &l, PacketSlabs &slabs, uint32_t lane, const Hit &hit) {
  if (left_out<q>(asks.filter, asks.number[lane], hit))
    return false;
  l.best[lane] = hit;
  l.best_t[lane] = hit.t;
  end_slab(slabs, lane, hit.t);
  return true;
}

template <Question q>
LANCER_LANE void visit_quadric(const BvhScene &scene, uint32_t instance, const PacketAsks &asks, uint32_t active,
                               PacketSlabs &slabs, Leftovers &l) {
  const PlacedShape &shape = scene.shapes[instance];
  for (; active != 0; active &= active - 1) {
    const uint32_t lane = static_cast<uint32_t>(__builtin_ctz(active));
    const Ray &ray = *asks.rays[lane];
    if (!visible(shape, ray))
      continue;
    try_places(
        instance, ray.tmin,
        l.best[lane], [&](double &t) __attribute__((always_inline)) { return next_place(shape, instance, ray, t); },
        [&](const Hit &hit) __attribute__((always_inline)) { return store_hit<q>(asks, l, slabs, lane, hit); });
  }
}

template <Question q>
LANCER_LANE void visit_spheres(const BvhScene &scene, const SphereBlock &block, const PacketAsks &asks, uint32_t active,
                               const Entering &e, PacketSlabs &slabs, Leftovers &l) {
  for (; active != 0; active &= active - 1) {
    const uint32_t lane = static_cast<uint32_t>(__builtin_ctz(active));
    const Ray &ray = *asks.rays[lane];
    BlockRoots roots;
    for (uint32_t met = intersect_spheres(block, ray, roots); met != 0; met &= met - 1) {
      const int i = __builtin_ctz(met);
      const uint32_t instance = block.instance[i];
      if (instance == kNone)
        break;
      const PlacedShape &shape = scene.shapes[instance];
      if (!visible(shape, ray))
        continue;
      try_places(
          instance, e.tmin[lane], l.best[lane],
          [&](double &t) __attribute__((always_inline)) {
            return choose_root(roots, i, shape.slack, ray.skip_instance == instance, t, e.tmax[lane], t);
          },
          [&](const Hit &hit) __attribute__((always_inline)) { return store_hit<q>(asks, l, slabs, lane, hit); });
    }
  }
}

template <Question q>
LANCER_LANE void visit_triangles(const TriangleBlock &block, const PacketAsks &asks, uint32_t active, const Entering &e,
                                 Packet &p, PacketSlabs &slabs, Leftovers &l) {
  for (uint32_t longest = 0; longest < 3; ++longest) {
    uint32_t rest = active & p.rays.longest[longest];
    if (rest == 0)
      continue;
    const RayAxes axes = axes_from(longest);
    const uint32_t order[3] = {axes.kx, axes.ky, axes.kz};
    Double<kPairs> corner[3][3];
    for (uint32_t k = 0; k < 3; ++k)
      for (uint32_t i = 0; i < 3; ++i)
        corner[i][k] = repeat<kTogether>(load_widened(block.corner[i][order[k]]));
    // If the number of lanes is odd, the last lane is tested twice.
    while (rest != 0) {
      uint32_t lanes[kTogether];
      for (int i = 0; i < kTogether; ++i) {
        lanes[i] = rest != 0 ? static_cast<uint32_t>(__builtin_ctz(rest)) : lanes[0];
        rest &= rest - 1;
      }
      BlockHits<kPairs> hits;
      for (uint32_t met = intersect_together(corner, p.rays, longest, lanes, e, l.best_t, hits); met != 0; met &= met - 1) {
        const uint32_t i = static_cast<uint32_t>(__builtin_ctz(met)), lane = lanes[i >> 2];
        const uint32_t primitive = block.primitive[i & 3];
        const bool skipped = asks.rays[lane]->skip_instance == p.instance && asks.rays[lane]->skip_primitive == primitive;
        if (!skipped && closer(hits.t[i], p.instance, primitive, l.best[lane]))
          store_hit<q>(asks, l, slabs, lane,
                       {hits.t[i], hits.wb[i] / hits.det[i], hits.wc[i] / hits.det[i], p.instance, primitive});
      }
    }
  }
}

// Returns the lanes to which an instance is visible.
LANCER_LANE uint32_t seeing(const PlacedShape &shape, const Ray *const *rays) {
  uint32_t lanes = 0;
  for (uint32_t i = 0; i < kPacket; ++i)
    lanes |= static_cast<uint32_t>(visible(shape, *rays[i])) << i;
  return lanes;
}

// Registers per packet.
constexpr int kSteps = kPacket / kLanes;

// Visits a tree's leaves with the active lanes that hit them, the nearest first. All active lanes have the same octant.
template <class Leaf>
LANCER_LANE void walk(const BvhNode *nodes, uint32_t octant, const float *entry, const PacketSlabs &slabs, Packet &p,
                      const char *const *arrays, Leaf leaf) {
  const uint32_t base = p.size;
  for (uint32_t i = 0; i < kPacket; i += kLanes)
    store(p.entries[base] + i, load(entry + i));
  p.children[base] = kBvhInner << kBvhKindShift;
  p.size = base + 1;
  const uint32_t down[3] = {octant & 1, octant >> 1 & 1, octant >> 2};
  while (p.size > base) {
    // Pop an entry that some lane enters before its best hit.
    const uint32_t child = p.children[--p.size];
    F parent[kSteps], limit[kSteps];
    uint32_t active = 0;
    for (int i = 0; i < kSteps; ++i) {
      parent[i] = load(p.entries[p.size] + i * kLanes);
      limit[i] = load(slabs.tau_max + i * kLanes);
      active |= less_equal_bits(parent[i], limit[i]) << i * kLanes;
    }
    if (active == 0)
      continue;
    if (leaf(child, active, p.entries[p.size]))
      continue;
    const BvhNode &node =
        *reinterpret_cast<const BvhNode *>(reinterpret_cast<const char *>(nodes) + size_t{child & kBvhPlace} * kBvhStep);
    F inverse[kSteps][3], shift[kSteps][3];
    for (int i = 0; i < kSteps; ++i)
      for (int axis = 0; axis < 3; ++axis) {
        inverse[i][axis] = load(slabs.inverse[axis] + i * kLanes);
        shift[i][axis] = load(slabs.shift[axis] + i * kLanes);
      }
    uint32_t order = node.order[octant], size = p.size;
    for (uint32_t child_rank = 0; child_rank < kBvhWidth; ++child_rank, order >>= 3) {
      const uint32_t at = order & 7;
      uint32_t met = 0;
      for (int i = 0; i < kSteps; ++i) {
        F near[3], far[3];
        for (int axis = 0; axis < 3; ++axis) {
          near[axis] = multiply_subtract(F(node.bounds[axis][down[axis]][at]), inverse[i][axis], shift[i][axis]);
          far[axis] = multiply_subtract(F(node.bounds[axis][down[axis] ^ 1][at]), inverse[i][axis], shift[i][axis]);
        }
        // Inactive lanes have NaN as entry and keep it: max of unordered operands returns the first operand.
        const F first = max(max(parent[i], near[2]), max(near[1], near[0]));
        const F last = min(min(limit[i], far[2]), min(far[1], far[0]));
        store(p.entries[size] + i * kLanes, drop_greater(first, last));
        met |= less_equal_bits(first, last);
      }
      p.children[size] = node.child[at];
      size += met != 0;
    }
    // Prefetch all children found.
    for (uint32_t i = p.size; i < size; ++i)
      for (int offset = 0; offset < 256; offset += 64)
        __builtin_prefetch(arrays[p.children[i] >> kBvhKindShift] + size_t{p.children[i] & kBvhPlace} * kBvhStep + offset);
    p.size = size;
  }
}

template <Question q>
LANCER_LANE void walk_mesh(const BvhView &bvh, const PacketAsks &asks, uint32_t active, const Entering &e, Packet &p,
                           Leftovers &l) {
  const uint32_t x = lanes_down(p.inner.inverse[0]), y = lanes_down(p.inner.inverse[1]), z = lanes_down(p.inner.inverse[2]);
  const char *const arrays[kBvhKinds] = {reinterpret_cast<const char *>(bvh.nodes), reinterpret_cast<const char *>(bvh.blocks)};
  // Take the lanes with the same octant.
  while (active != 0) {
    const uint32_t lane = static_cast<uint32_t>(__builtin_ctz(active));
    const uint32_t octant = (x >> lane & 1) | (y >> lane & 1) << 1 | (z >> lane & 1) << 2;
    const uint32_t same = active & (octant & 1 ? x : ~x) & (octant & 2 ? y : ~y) & (octant & 4 ? z : ~z);
    active &= ~same;
    alignas(64) float entry[kPacket];
    for (uint32_t i = 0; i < kPacket; ++i)
      entry[i] = same >> i & 1 ? p.inner.tau_min[i] : __builtin_nanf("");
    walk(
        static_cast<const BvhNode *>(bvh.nodes), octant, entry, p.inner, p,
        arrays, [&](uint32_t child, uint32_t lanes, const float *) __attribute__((always_inline)) {
          if (child >> kBvhKindShift == kBvhInner)
            return false;
          const char *at = reinterpret_cast<const char *>(bvh.blocks) + size_t{child & kBvhPlace} * kBvhStep;
          visit_triangles<q>(*reinterpret_cast<const TriangleBlock *>(at), asks, lanes, e, p, p.inner, l);
          return true;
        });
  }
}

// Traces coherent rays, except for the leftovers. Returns the lanes that have leftovers.
template <Question q>
[[gnu::noinline, gnu::flatten]] uint32_t trace_packet(const BvhScene &scene, Entering &e, HitFilter *filter, Leftovers &l) {
  const PacketAsks asks{e.rays, e.number, filter};
  Packet p;
  p.size = 0;
  p.instance = kNone;
  for (uint32_t i = 0; i < kPacket; ++i) {
    l.best[i] = Hit{__builtin_inf(), 0.0, 0.0, kNone, kNone};
    l.best_t[i] = __builtin_inf();
    l.count[i] = 0;
  }
  // Test the unbounded instances.
  for (uint32_t i = 0; i < scene.unbounded_count; ++i) {
    const uint32_t instance = scene.unbounded[i];
    if (scene.shapes[instance].mesh == kNone)
      visit_quadric<q>(scene, instance, asks, kAllOfPacket, e, l);
    else
      leave_over(kBvhInstance << kBvhKindShift | instance * kBvhSteps<PlacedShape>, kAllOfPacket, nullptr, l);
  }
  if (scene.top) {
    const char *arrays[kBvhKinds] = {};
    arrays[kBvhInner] = reinterpret_cast<const char *>(scene.top);
    arrays[kBvhPlaced] = reinterpret_cast<const char *>(scene.blocks);
    arrays[kBvhSpheres] = reinterpret_cast<const char *>(scene.spheres);
    arrays[kBvhInstance] = reinterpret_cast<const char *>(scene.shapes);
    uint32_t octant = 0;
    for (uint32_t axis = 0; axis < 3; ++axis)
      octant |= uint32_t{e.inverse[axis][0] < 0.0f} << axis;
    walk(
        static_cast<const BvhNode *>(scene.top), octant, e.tau_min, e, p,
        arrays, [&](uint32_t child, uint32_t active, const float *entry) __attribute__((always_inline)) {
          const uint32_t kind = child >> kBvhKindShift;
          if ((kind == kBvhInner || kind == kBvhInstance) && __builtin_popcount(active) <= static_cast<int>(kFew) &&
              leave_over(child, active, entry, l))
            return true;
          const size_t place = size_t{child & kBvhPlace} * kBvhStep;
          if (kind == kBvhInner)
            return false;
          if (kind == kBvhPlaced) {
            const TriangleBlock &block =
                *reinterpret_cast<const TriangleBlock *>(reinterpret_cast<const char *>(scene.blocks) + place);
            const uint32_t instance = scene.block_instance[&block - scene.blocks];
            if (instance != p.instance) {
              p.instance = instance;
              enter_mesh_packet(scene.shapes[instance], e, p.rays);
              p.seeing = p.rays.usable & seeing(scene.shapes[instance], e.rays);
            }
            visit_triangles<q>(block, asks, active & p.seeing, e, p, e, l);
          } else if (kind == kBvhSpheres) {
            visit_spheres<q>(scene,
                             *reinterpret_cast<const SphereBlock *>(reinterpret_cast<const char *>(scene.spheres) + place),
                             asks, active, e, e, l);
          } else {
            const uint32_t instance = (child & kBvhPlace) / kBvhSteps<PlacedShape>;
            const PlacedShape &shape = scene.shapes[instance];
            if (shape.mesh == kNone) {
              visit_quadric<q>(scene, instance, asks, active, e, l);
            } else if (const BvhView &bvh = scene.meshes[shape.mesh]; bvh.nodes) {
              alignas(64) double limit[kPacket];
              for (uint32_t i = 0; i < kPacket; ++i)
                limit[i] = e.tmax[i] < l.best[i].t ? e.tmax[i] : l.best[i].t;
              p.instance = instance;
              enter_mesh_packet(shape, e, p.rays, &p.inner, limit);
              p.seeing = p.rays.usable & seeing(shape, e.rays);
              walk_mesh<q>(bvh, asks, active & p.seeing, e, p, l);
              for (uint32_t i = 0; i < kPacket; ++i)
                if (l.best[i].instance == instance)
                  end_slab(e, i, l.best[i].t);
            }
          }
          return true;
        });
  }
  // Drop leftovers behind the best hits.
  uint32_t waiting = 0;
  for (uint32_t i = 0; i < kPacket; ++i) {
    uint32_t count = 0;
    for (uint32_t k = 0; k < l.count[i]; ++k)
      if (l.entries[i][k] <= e.tau_max[i]) {
        l.entries[i][count] = l.entries[i][k];
        l.children[i][count++] = l.children[i][k];
      }
    l.count[i] = count;
    waiting |= static_cast<uint32_t>(count != 0) << i;
  }
  return waiting;
}

} // namespace
} // namespace lancer
