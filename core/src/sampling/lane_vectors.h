// Vectors of lanes: of floats and of doubles, with the sums in glm's order. For kernels only, like lanes.h.
#pragma once

#include "sampling/lane_memory.h"
#include "sampling/lane_widths.h"

namespace lancer {
namespace {

struct V3 {
  F x, y, z;
};
LANCER_LANE V3 operator+(const V3 &a, const V3 &b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
LANCER_LANE V3 operator-(const V3 &a, const V3 &b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
LANCER_LANE V3 operator*(const V3 &a, const V3 &b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
LANCER_LANE V3 operator*(const V3 &a, F s) { return {a.x * s, a.y * s, a.z * s}; }
LANCER_LANE V3 operator*(F s, const V3 &a) { return {s * a.x, s * a.y, s * a.z}; }
LANCER_LANE V3 operator/(const V3 &a, F s) { return {a.x / s, a.y / s, a.z / s}; }
LANCER_LANE V3 operator-(const V3 &a) { return {-a.x, -a.y, -a.z}; }
LANCER_LANE F dot(const V3 &a, const V3 &b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
LANCER_LANE V3 normalize(const V3 &a) { return a * (F(1.0f) / sqrt(dot(a, a))); }
LANCER_LANE V3 select(M m, const V3 &a, const V3 &b) { return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)}; }
LANCER_LANE M black(const V3 &a) { return (a.x == F(0.0f)) & (a.y == F(0.0f)) & (a.z == F(0.0f)); }
LANCER_LANE V3 load3(const float (*p)[16], int first) { return {load(p[0] + first), load(p[1] + first), load(p[2] + first)}; }
LANCER_LANE void store3(float (*p)[16], int first, const V3 &a) {
  store(p[0] + first, a.x);
  store(p[1] + first, a.y);
  store(p[2] + first, a.z);
}
// Only the lanes of m.
LANCER_LANE void store3(float (*p)[16], int first, M m, const V3 &a) { store3(p, first, select(m, a, load3(p, first))); }

struct D3 {
  D x, y, z;
};
LANCER_LANE D3 operator+(const D3 &a, const D3 &b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
LANCER_LANE D3 operator-(const D3 &a, const D3 &b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
LANCER_LANE D3 operator*(D s, const D3 &a) { return {s * a.x, s * a.y, s * a.z}; }
LANCER_LANE D3 operator*(const D3 &a, D s) { return {a.x * s, a.y * s, a.z * s}; }
LANCER_LANE D3 operator/(const D3 &a, D s) { return {a.x / s, a.y / s, a.z / s}; }
LANCER_LANE D dot(const D3 &a, const D3 &b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
LANCER_LANE D3 select(M m, const D3 &a, const D3 &b) { return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)}; }
LANCER_LANE D3 load3(const double (*p)[16], int first) { return {load(p[0] + first), load(p[1] + first), load(p[2] + first)}; }
LANCER_LANE void store3(double (*p)[16], int first, const D3 &a) {
  store(p[0] + first, a.x);
  store(p[1] + first, a.y);
  store(p[2] + first, a.z);
}
LANCER_LANE void store3(double (*p)[16], int first, M m, const D3 &a) { store3(p, first, select(m, a, load3(p, first))); }
LANCER_LANE D3 widen(const V3 &a) { return {widen(a.x), widen(a.y), widen(a.z)}; }
LANCER_LANE V3 narrow(const D3 &a) { return {narrow(a.x), narrow(a.y), narrow(a.z)}; }

} // namespace
} // namespace lancer
