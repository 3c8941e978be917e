// Arithmetic of Blender's Vector Math, Mapping and Vector Transform nodes: undefined results are 0. Internal linkage, as in
// lanes.h.
#pragma once

#include "nodes/math_nodes.h"

#include <glm/glm.hpp>

namespace lancer {

// Matrices of nodes that are the same for all hits.

// Returns the rotation by Euler angles, x first.
glm::mat3 rotation(const glm::vec3 &angles);
// Computes the inverse transpose of a 3 x 3 matrix, both row-major; returns false if it is singular.
bool inverse_transpose(const float (&rows)[9], double (&result)[9]);

namespace {

// Applies a function to every component.
template <class F, class Function> LANCER_LANE Vector3<F> componentwise(const Vector3<F> &a, const Function &f) {
  return {f(a.x), f(a.y), f(a.z)};
}
template <class F, class Function>
LANCER_LANE Vector3<F> componentwise(const Vector3<F> &a, const Vector3<F> &b, const Function &f) {
  return {f(a.x, b.x), f(a.y, b.y), f(a.z, b.z)};
}
template <class F> LANCER_LANE Vector3<F> divide(const Vector3<F> &a, const Vector3<F> &b) {
  return {divide(a.x, b.x), divide(a.y, b.y), divide(a.z, b.z)};
}

// Returns the rotation by Euler angles, x first.
template <class F> Columns<F> turn_by(const Vector3<F> &angles) {
  const F zero(0.0f), one(1.0f);
  const Vector3<F> c{cos(angles.x), cos(angles.y), cos(angles.z)}, s{sin(angles.x), sin(angles.y), sin(angles.z)};
  const Columns<F> x{{{one, zero, zero}, {zero, c.x, s.x}, {zero, -s.x, c.x}}};
  const Columns<F> y{{{c.y, zero, -s.y}, {zero, one, zero}, {s.y, zero, c.y}}};
  const Columns<F> z{{{c.z, s.z, zero}, {-s.z, c.z, zero}, {zero, zero, one}}};
  return z * y * x;
}

template <class In, class F = typename In::Number> Value<F> vector_math_node(const In &in) {
  using V3 = Vector3<F>;
  const V3 a = in[0], b = in[1];
  switch (in.node.option) {
  case VectorOperation::Add:
    return solid(a + b);
  case VectorOperation::Subtract:
    return solid(a - b);
  case VectorOperation::Multiply:
    return solid(a * b);
  case VectorOperation::Divide:
    return solid(divide(a, b));
  case VectorOperation::MultiplyAdd:
    return solid(a * b + in[2]);
  case VectorOperation::CrossProduct:
    return solid(cross(a, b));
  case VectorOperation::Project: {
    const F length2 = dot(b, b);
    return solid(select(length2 != F(0.0f), F(dot(a, b) / length2) * b, V3(F(0.0f))));
  }
  case VectorOperation::Reflect: {
    const V3 n = unit_or_zero(b);
    return solid(a - F(F(2.0f) * dot(a, n)) * n);
  }
  case VectorOperation::DotProduct:
    return scalar(F(dot(a, b)));
  case VectorOperation::Distance:
    return scalar(length(a - b));
  case VectorOperation::Length:
    return scalar(length(a));
  case VectorOperation::Scale:
    return solid(a * in.scalar(3));
  case VectorOperation::Normalize:
    return solid(unit_or_zero(a));
  case VectorOperation::Absolute:
    return solid(abs(a));
  case VectorOperation::Minimum:
    return solid(min(a, b));
  case VectorOperation::Maximum:
    return solid(max(a, b));
  case VectorOperation::Floor:
    return solid(componentwise(a, [](const F &x) { return floor(x); }));
  case VectorOperation::Ceil:
    return solid(componentwise(a, [](const F &x) { return ceil(x); }));
  case VectorOperation::Fraction:
    return solid(componentwise(a, [](const F &x) { return fraction(x); }));
  case VectorOperation::Modulo:
    return solid(componentwise(a, b, [](const F &x, const F &y) { return modulo(x, y); }));
  case VectorOperation::Snap:
    return solid(componentwise(a, b, [](const F &x, const F &y) { return floor(divide(x, y)) * y; }));
  case VectorOperation::Sine:
    return solid(componentwise(a, [](const F &x) { return sin(x); }));
  case VectorOperation::Cosine:
    return solid(componentwise(a, [](const F &x) { return cos(x); }));
  case VectorOperation::Tangent:
    return solid(componentwise(a, [](const F &x) { return tan(x); }));
  default:
    return solid(V3(F(0.0f)));
  }
}

// Returns the rotation of a node, mostly one constant for all lanes.
template <class In, class F = typename In::Number> LANCER_LANE Columns<F> turn_of(const In &in) {
  if (in.node.inputs[2].varies())
    return turn_by(in[2]);
  const glm::mat3 turn = rotation(in.node.inputs[2].value);
  Columns<F> r;
  for (int c = 0; c < 3; ++c)
    r.c[c] = {F(turn[c].x), F(turn[c].y), F(turn[c].z)};
  return r;
}

template <class In, class F = typename In::Number> Value<F> mapping_node(const In &in) {
  const Vector3<F> v = in[0], location = in[1], scale = in[3];
  const Columns<F> turn = turn_of(in);
  switch (in.node.option) {
  case MappingType::Point:
    return solid(turn.times(v * scale) + location);
  case MappingType::Texture:
    return solid(divide(turn.transposed_times(v - location), scale));
  case MappingType::Vector:
    return solid(turn.times(v * scale));
  default:
    return solid(unit_or_zero(turn.times(divide(v, scale))));
  }
}

// Returns the rows of a matrix times v plus the last column times translation.
template <class D> LANCER_LANE Vector3<D> rows_times(const float (&m)[12], const Vector3<D> &v, double translation) {
  const auto row = [&](int i) __attribute__((always_inline)) {
    const double last = static_cast<double>(m[4 * i + 3]);
    return D(static_cast<double>(m[4 * i])) * v.x + D(static_cast<double>(m[4 * i + 1])) * v.y +
           D(static_cast<double>(m[4 * i + 2])) * v.z + D(last * translation);
  };
  return {row(0), row(1), row(2)};
}

template <class F> Value<F> transform_node(const Inputs<F> &in) {
  const auto v = widen(in[0]);
  if (in.node.option != 2)
    return solid(narrow(rows_times(in.node.matrix, v, in.node.option == 0 ? 1.0 : 0.0)));
  // Transform normals by the inverse transpose.
  float rows[9];
  double inverse[9];
  for (int i = 0; i < 9; ++i)
    rows[i] = in.node.matrix[4 * (i / 3) + i % 3];
  if (!inverse_transpose(rows, inverse))
    return solid(in[0]);
  using D = DoubleOf<F>;
  const auto row = [&](int i) __attribute__((always_inline)) {
    return D(inverse[3 * i]) * v.x + D(inverse[3 * i + 1]) * v.y + D(inverse[3 * i + 2]) * v.z;
  };
  return solid(unit_or_zero(narrow(Vector3<D>(row(0), row(1), row(2)))));
}

} // namespace

} // namespace lancer
