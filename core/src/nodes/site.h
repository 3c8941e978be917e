// The hit at which nodes are evaluated, in lanes of F, and the inputs of a node there. Internal linkage, as in lanes.h.
#pragma once

#include "nodes/run.h"
#include "scene/affine.h"
#include "scene/surface.h"
#include "simd/memory.h"
#include "simd/vectors.h"

namespace lancer {
namespace {

// The linear part of a map, by columns as in glm, or any three vectors.
template <class T> struct Columns {
  Vector3<T> c[3];

  LANCER_LANE Vector3<T> times(const Vector3<T> &v) const {
    return {c[0].x * v.x + c[1].x * v.y + c[2].x * v.z, c[0].y * v.x + c[1].y * v.y + c[2].y * v.z,
            c[0].z * v.x + c[1].z * v.y + c[2].z * v.z};
  }
  LANCER_LANE Vector3<T> transposed_times(const Vector3<T> &v) const { return {dot(c[0], v), dot(c[1], v), dot(c[2], v)}; }
};
template <class T> LANCER_LANE Columns<T> operator*(const Columns<T> &a, const Columns<T> &b) {
  return {{a.times(b.c[0]), a.times(b.c[1]), a.times(b.c[2])}};
}

template <class T> LANCER_LANE T length(const Vector3<T> &v) { return sqrt(dot(v, v)); }
// Returns the unit vector; 0 for a zero vector.
template <class T> LANCER_LANE Vector3<T> unit_or_zero(const Vector3<T> &v) {
  const T size = length(v);
  return select(size > T(0), v / size, Vector3<T>(T(0)));
}

// The result of a node.
template <class F> struct Value {
  Vector3<F> v;
  F alpha;
};
template <class F> LANCER_LANE Value<F> solid(const Vector3<F> &v) { return {v, F(1.0f)}; }
template <class F> LANCER_LANE Value<F> scalar(const F &x) { return {{x, x, x}, F(1.0f)}; }
template <class F> LANCER_LANE Value<F> nothing() { return {Vector3<F>(F(0.0f)), F(0.0f)}; }
template <class F> LANCER_LANE Value<F> select(const MaskOf<F> &m, const Value<F> &a, const Value<F> &b) {
  return {select(m, a.v, b.v), select(m, a.alpha, b.alpha)};
}

// Storage of node values: four numbers per node, with a stride of `lanes`.
template <class F> struct Values {
  float *at;
  size_t lanes; // 1: the numbers of one hit in a row

  LANCER_LANE F get(int32_t node, int k) const {
    return load_lanes<LanesOf<F>::kWidth>(at + (size_t(node) * 4 + size_t(k)) * lanes);
  }
  LANCER_LANE Vector3<F> get(int32_t node) const { return {get(node, 0), get(node, 1), get(node, 2)}; }
  LANCER_LANE void set(size_t node, const Value<F> &value) const {
    float *to = at + node * 4 * lanes;
    store(to, value.v.x);
    store(to + lanes, value.v.y);
    store(to + 2 * lanes, value.v.z);
    store(to + 3 * lanes, value.alpha);
  }
};

template <class F> struct Site {
  static constexpr int kWidth = LanesOf<F>::kWidth;
  using D = DoubleOf<F>;
  using M = MaskOf<F>;

  NodeScene scene;
  const LookingLanes *looking = nullptr; // as in NodeBlock
  int first = 0;                         // the first of its lanes
  bool surface = false;                  // else a direction of the world
  bool placed = false;                   // lanes have instances
  bool together = false;                 // and all lanes have the same one
  bool in_height = false;                // a BUMP is evaluating its height
  bool displaces = false;                // a vertex is displaced, seen by nobody
  const Site *still = nullptr;           // then, the site of the bump itself
  uint32_t number[kWidth];               // of the instance
  const Instance *instance[kWidth];
  const MeshView *mesh[kWidth]; // null on exact surfaces
  uint32_t primitive[kWidth];
  float time[kWidth]; // of the ray
  const glm::dvec3 *eye[kWidth];
  M on_mesh;
  Vector3<D> p; // normalised world; for the world, the direction
  D bary[2];
  Vector3<F> ns, ng, wo; // normals on the viewer's side
  F footprint;
  M backfacing;
  LightPath<F> path;

  // Sets the members that follow from the instances of all lanes.
  LANCER_LANE void place() {
    placed = surface && scene.geometry;
    together = placed;
    for (int i = 0; i < kWidth; ++i) {
      mesh[i] = placed && instance[i]->kind == ShapeKind::Mesh ? &scene.geometry->meshes[instance[i]->mesh] : nullptr;
      together = together && instance[i] == instance[0];
    }
    on_mesh = by_lane<M>([&](int i) { return mesh[i] != nullptr; });
  }
  LANCER_LANE double user_scale() const { return scene.normalisation ? scene.normalisation->scale : 1.0; }
  // Returns the site for nodes whose values do not change along a bump's steps.
  LANCER_LANE const Site &standing() const { return still ? *still : *this; }
  // Returns the interpolation weights on a mesh.
  LANCER_LANE Vector3<F> weights() const { return {narrow(D(1.0) - bary[0] - bary[1]), narrow(bary[0]), narrow(bary[1])}; }
};

// Returns a map of every lane's instance.
template <class F> LANCER_LANE Columns<DoubleOf<F>> linear_of(const Site<F> &site, Affine Instance::*map) {
  using D = DoubleOf<F>;
  Columns<D> r;
  const auto column = [&](int c) __attribute__((always_inline)) {
    if (site.together) {
      const glm::dvec3 &v = (site.instance[0]->*map).linear[c];
      return Vector3<D>(D(v.x), D(v.y), D(v.z));
    }
    const auto part = [&](int row) __attribute__((always_inline)) {
      return by_lane<D>([&](int i) { return (site.instance[i]->*map).linear[c][row]; });
    };
    return Vector3<D>(part(0), part(1), part(2));
  };
  for (int c = 0; c < 3; ++c)
    r.c[c] = column(c);
  return r;
}
template <class F> LANCER_LANE Vector3<DoubleOf<F>> translation_of(const Site<F> &site, Affine Instance::*map) {
  using D = DoubleOf<F>;
  const auto part = [&](int row) __attribute__((always_inline)) {
    if (site.together)
      return D((site.instance[0]->*map).translation[row]);
    return by_lane<D>([&](int i) { return (site.instance[i]->*map).translation[row]; });
  };
  return {part(0), part(1), part(2)};
}

// Transformations of points, vectors and normals; the world's own frame is its object space. Normals are unit; 0 stays 0.
template <class F> LANCER_LANE Vector3<DoubleOf<F>> vector_to_object(const Site<F> &site, const Vector3<DoubleOf<F>> &v) {
  return site.placed ? linear_of(site, &Instance::to_object).times(v) : v;
}
template <class F> LANCER_LANE Vector3<DoubleOf<F>> object_position(const Site<F> &site) {
  return site.placed ? vector_to_object(site, site.p) + translation_of(site, &Instance::to_object) : site.p;
}
template <class F> LANCER_LANE Vector3<DoubleOf<F>> vector_to_world(const Site<F> &site, const Vector3<DoubleOf<F>> &v) {
  return site.placed ? linear_of(site, &Instance::to_world).times(v) : v;
}
template <class F> LANCER_LANE Vector3<F> carried_normal(const Site<F> &site, Affine Instance::*back, const Vector3<F> &n) {
  return site.placed ? narrow(unit_or_zero(linear_of(site, back).transposed_times(widen(n)))) : n;
}
template <class F> LANCER_LANE Vector3<F> normal_to_object(const Site<F> &site, const Vector3<F> &n) {
  return carried_normal(site, &Instance::to_world, n);
}
template <class F> LANCER_LANE Vector3<F> normal_to_world(const Site<F> &site, const Vector3<F> &n) {
  return carried_normal(site, &Instance::to_object, n);
}
// Converts a point of the normalised world to the user's, or the reverse.
template <class F> LANCER_LANE Vector3<DoubleOf<F>> in_user_world(const Site<F> &site, const Vector3<DoubleOf<F>> &p) {
  using D = DoubleOf<F>;
  if (!site.scene.normalisation)
    return p;
  const glm::dvec3 &c = site.scene.normalisation->centre;
  return p / D(site.scene.normalisation->scale) + Vector3<D>(D(c.x), D(c.y), D(c.z));
}
template <class F> LANCER_LANE Vector3<DoubleOf<F>> from_user_world(const Site<F> &site, const Vector3<DoubleOf<F>> &p) {
  using D = DoubleOf<F>;
  if (!site.scene.normalisation)
    return p;
  const glm::dvec3 &c = site.scene.normalisation->centre;
  return (p - Vector3<D>(D(c.x), D(c.y), D(c.z))) * D(site.scene.normalisation->scale);
}
// Returns the site's position in the user's world; for the world, the direction.
template <class F> LANCER_LANE Vector3<DoubleOf<F>> user_position(const Site<F> &site) {
  return site.surface ? in_user_world(site, site.p) : site.p;
}

// The input values of one node.
template <class F> struct Inputs {
  using Number = F;
  const Node &node;
  Values<F> values;
  const ImageView *images; // of the program

  LANCER_LANE Vector3<F> operator[](int i) const {
    const Parameter &input = node.inputs[i];
    return input.varies() ? values.get(input.node) : Vector3<F>(F(input.value.x), F(input.value.y), F(input.value.z));
  }
  LANCER_LANE F scalar(int i) const {
    const Parameter &input = node.inputs[i];
    return input.varies() ? values.get(input.node, 0) : F(input.value.x);
  }
  LANCER_LANE F alpha(int i) const { return node.inputs[i].varies() ? values.get(node.inputs[i].node, 3) : F(1.0f); }
  // Returns a normal input; the constant 0 means the shading normal.
  LANCER_LANE Vector3<F> normal(int i, const Site<F> &site) const {
    const Parameter &input = node.inputs[i];
    return !input.varies() && input.value == glm::vec3(0.0f) ? site.ns : (*this)[i];
  }
};

} // namespace
} // namespace lancer
