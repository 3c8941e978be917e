// Steps of a single ray: nodes, instances, and blocks of triangles and spheres. Part of bvh_kernel.cpp: everything has internal
// linkage.
#pragma once

#include "accel/bvh/blocks.h"

namespace lancer {

namespace {

// The planes of some children of a node, at the time of a ray.
template <int W> LANCER_LANE Float<W> planes(const BvhNode &node, int axis, uint32_t side, int first, float) {
  return load_lanes<W>(node.bounds[axis][side] + first);
}
template <int W> LANCER_LANE Float<W> planes(const BvhMovingNode &node, int axis, uint32_t side, int first, float time) {
  return load_lanes<W>(node.bounds[axis][side] + first) + Float<W>(time) * load_lanes<W>(node.way[axis][side] + first);
}

// Replaces a node by its children that the ray hits, the nearest by the octant of the ray's direction on top.
template <class Node> LANCER_LANE void visit_children(Flight &s) {
  const Slab &ray = s.slab;
  const Node &node = *reinterpret_cast<const Node *>(s.at);
  // Width of a register, at most the eight children.
  constexpr int kWidth = kLanes < 8 ? kLanes : 8;
  using Children = Float<kWidth>;
  Children entry[8 / kWidth], exit[8 / kWidth];
  for (int i = 0; i < 8 / kWidth; ++i) {
    Children near[3], far[3];
    for (int axis = 0; axis < 3; ++axis) {
      const Children inverse(ray.inverse[axis]), shift(ray.shift[axis]);
      const uint32_t down = ray.octant >> axis & 1;
      near[axis] = multiply_subtract(planes<kWidth>(node, axis, down, i * kWidth, s.time), inverse, shift);
      far[axis] = multiply_subtract(planes<kWidth>(node, axis, down ^ 1, i * kWidth, s.time), inverse, shift);
    }
    entry[i] = max(max(near[0], near[1]), max(near[2], Children(ray.tau_min)));
    exit[i] = min(min(far[0], far[1]), min(far[2], Children(ray.tau_max)));
  }
  s.size += keep_ordered<kWidth>(s.entries + s.size, s.children + s.size, entry, exit, node.child, node.order[ray.octant]);
}

template <Question q> LANCER_LANE void visit_node(Flight &s) {
  if constexpr (q.moving)
    if (s.tree_moves)
      return visit_children<BvhMovingNode>(s);
  visit_children<BvhNode>(s);
}

LANCER_LANE void done(Flight &s) { s.size = 1; }

// Returns the shape of an instance at the time of the ray; moved: see shape_at().
template <Question q>
LANCER_LANE const PlacedShape &shape_of(const BvhScene &scene, uint32_t instance, const Ray &ray, PlacedShape &moved) {
  if constexpr (q.moving)
    return shape_at(scene.shapes[instance], scene.keys, ray.time, moved);
  else
    return scene.shapes[instance];
}

LANCER_LANE void become_mesh_ray(const PlacedShape &shape, uint32_t instance, const Ray &ray, Flight &s) {
  s.instance = instance;
  s.skip = ray.skip_instance == instance ? ray.skip_primitive : kNone;
  s.usable = visible(shape, ray) && enter_mesh(shape, ray, s.ray);
}

// Stores a closer hit if it passes the filter.
template <Question q> LANCER_LANE bool store_hit(HitFilter *filter, Flight &s, const Hit &hit) {
  if (left_out<q>(filter, s.number, hit))
    return false;
  s.best = hit;
  if (q.any)
    done(s);
  else
    shorten(s);
  return true;
}

template <Question q, class Next>
LANCER_LANE void try_places(uint32_t instance, HitFilter *filter, Flight &s, const Next &next) {
  try_places(
      instance, s.tmin, s.best,
      next, [&](const Hit &hit) __attribute__((always_inline)) { return store_hit<q>(filter, s, hit); });
}

template <Question q>
LANCER_LANE void visit_quadric(const PlacedShape &shape, uint32_t instance, const Ray &ray, HitFilter *filter, Flight &s) {
  if (visible(shape, ray))
    try_places<q>(
        instance, filter, s, [&](double &t) __attribute__((always_inline)) { return next_place(shape, instance, ray, t); });
}

template <Question q> LANCER_LANE void visit_spheres(const BvhScene &scene, const Ray &ray, HitFilter *filter, Flight &s) {
  const SphereBlock &block = *reinterpret_cast<const SphereBlock *>(s.at);
  BlockRoots roots;
  for (uint32_t met = intersect_spheres(block, ray, roots); met != 0; met &= met - 1) {
    const int i = __builtin_ctz(met);
    const uint32_t instance = block.instance[i];
    if (instance == kNone)
      return;
    const PlacedShape &shape = scene.shapes[instance];
    if (visible(shape, ray))
      try_places<q>(
          instance, filter, s, [&](double &t) __attribute__((always_inline)) {
            return choose_root(roots, i, shape.slack, ray.skip_instance == instance, t, s.tmax, t);
          });
    if (q.any && s.best.instance != kNone)
      return;
  }
}

// Enters an instance, if the ray can hit it.
template <Question q> LANCER_LANE void enter_instance(const BvhScene &scene, const Ray &ray, HitFilter *filter, Flight &s) {
  const uint32_t instance = static_cast<uint32_t>(reinterpret_cast<const PlacedShape *>(s.at) - scene.shapes);
  PlacedShape moved;
  const PlacedShape &shape = shape_of<q>(scene, instance, ray, moved);
  if (shape.mesh == kNone)
    return visit_quadric<q>(shape, instance, ray, filter, s);
  const BvhView &bvh = scene.meshes[shape.mesh];
  if (!bvh.nodes)
    return;
  become_mesh_ray(shape, instance, ray, s);
  if (!s.usable)
    return;
  s.outer = s.slab;
  make_slab(shape.frame, s.ray, s.tmin, s.tmax < s.best.t ? s.tmax : s.best.t, s.slab);
  s.arrays[kBvhInner] = reinterpret_cast<const char *>(bvh.nodes);
  s.arrays[kBvhTriangles] = reinterpret_cast<const char *>(bvh.blocks);
  if constexpr (q.moving) {
    s.tree_moves = bvh.key_count > 0;
    if (s.tree_moves) {
      const KeyPlace at = key_at(bvh.key_count, ray.time);
      s.key_step = bvh.block_count * sizeof(TriangleBlock);
      s.key_share = at.share;
      s.arrays[kBvhTriangles] += at.key * s.key_step;
    }
  }
  push(s, 0.0f, kBvhLeave << kBvhKindShift);
  s.base = s.size;
  push(s, 0.0f, 0);
}

template <Question q> LANCER_LANE void leave_instance(const BvhScene &scene, Flight &s) {
  s.slab = s.outer;
  if constexpr (q.moving)
    s.tree_moves = true;
  s.arrays[kBvhInner] = reinterpret_cast<const char *>(scene.top);
  s.base = 1;
  if (s.best.instance == s.instance)
    shorten(s);
}

// Returns a block between two keys.
LANCER_LANE TriangleBlock block_between(const TriangleBlock &from, const TriangleBlock &to, float share) {
  TriangleBlock block;
  for (int corner = 0; corner < 3; ++corner)
    for (int axis = 0; axis < 3; ++axis)
      for (int lane = 0; lane < 4; ++lane)
        block.corner[corner][axis][lane] = between_keys(from.corner[corner][axis][lane], to.corner[corner][axis][lane], share);
  for (int lane = 0; lane < 4; ++lane)
    block.primitive[lane] = from.primitive[lane];
  return block;
}

// Tests the triangles of a block.
template <Question q> LANCER_LANE void test_triangles(const TriangleBlock &block, HitFilter *filter, Flight &s) {
  BlockHits<4> hits;
  bool found = false;
  for (uint32_t met = intersect_block(block, s.ray, s.tmin, s.tmax, s.best.t, hits); met != 0; met &= met - 1) {
    const int i = __builtin_ctz(met);
    const uint32_t primitive = block.primitive[i];
    if (primitive == s.skip || !closer(hits.t[i], s.instance, primitive, s.best))
      continue;
    const Hit hit{hits.t[i], hits.wb[i] / hits.det[i], hits.wc[i] / hits.det[i], s.instance, primitive};
    if (left_out<q>(filter, s.number, hit))
      continue;
    s.best = hit;
    found = true;
    if (q.any)
      break;
  }
  if (found) {
    if (q.any)
      done(s);
    else
      shorten(s);
  }
}

template <Question q> LANCER_LANE void visit_triangles(HitFilter *filter, Flight &s) {
  const TriangleBlock &block = *reinterpret_cast<const TriangleBlock *>(s.at);
  if constexpr (q.moving)
    if (s.tree_moves) {
      const auto &next = *reinterpret_cast<const TriangleBlock *>(s.at + s.key_step);
      return test_triangles<q>(block_between(block, next, s.key_share), filter, s);
    }
  test_triangles<q>(block, filter, s);
}

// Tests a block of the world's tree, whose triangles are in the space of their instance.
template <Question q> LANCER_LANE void visit_placed(const BvhScene &scene, const Ray &ray, HitFilter *filter, Flight &s) {
  const uint32_t instance = scene.block_instance[reinterpret_cast<const TriangleBlock *>(s.at) - scene.blocks];
  if (instance != s.instance)
    become_mesh_ray(scene.shapes[instance], instance, ray, s);
  if (s.usable)
    test_triangles<q>(*reinterpret_cast<const TriangleBlock *>(s.at), filter, s);
}

// Tests the unbounded instances, up to the next mesh.
template <Question q> LANCER_LANE void visit_unbounded(const BvhScene &scene, const Ray &ray, HitFilter *filter, Flight &s) {
  while (s.unbounded > 0 && !(q.any && s.best.instance != kNone)) {
    const uint32_t instance = scene.unbounded[--s.unbounded];
    if (scene.shapes[instance].mesh == kNone) {
      PlacedShape moved;
      visit_quadric<q>(shape_of<q>(scene, instance, ray, moved), instance, ray, filter, s);
      continue;
    }
    push(s, -__builtin_inff(), kBvhUnbounded << kBvhKindShift);
    push(s, -__builtin_inff(), kBvhInstance << kBvhKindShift | instance * kBvhSteps<PlacedShape>);
    return;
  }
}

} // namespace
} // namespace lancer
