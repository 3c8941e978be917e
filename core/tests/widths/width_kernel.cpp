// Compiled once per instruction set, with LANCER_ISA naming it.
#include "widths/width_kernel.h"

#include "lights/sample_light.h"
#include "lights/seen_face.h"
#include "sampling/elementary.h"
#include "sampling/sobol.h"
#include "simd/kernel_lanes.h"

namespace lancer {
namespace {

// The lanes of a kernel among the inputs, and the rows of their results.
struct Lane {
  const WidthInputs &in;
  WidthOutputs &out;
  int first, row = 0;

  F unit(int i) const { return load_lanes<kLanes>(in.unit[i] + first); }
  F number(int i) const { return load_lanes<kLanes>(in.number[i] + first); }
  D wide(int i) const { return load_lanes<kLanes>(in.wide_number[i] + first); }
  U word(int i) const { return load_lanes<kLanes>(in.word[i] + first); }
  F whole() const { return load_lanes<kLanes>(in.whole + first); }
  D of(const double (&numbers)[16]) const { return load_lanes<kLanes>(numbers + first); }
  Vector3<D> of(const double (&v)[3][16]) const { return {of(v[0]), of(v[1]), of(v[2])}; }
  Vector3<F> normal() const {
    return {load_lanes<kLanes>(in.n[0] + first), load_lanes<kLanes>(in.n[1] + first), load_lanes<kLanes>(in.n[2] + first)};
  }
  M odd() const { return equal(word(0) & U(1u), U(1u)); }
  LightQueryLanes<F> query() const { return {of(in.p), normal(), odd()}; }

  void put(F a) {
    alignas(64) float values[kLanes];
    store(values, a);
    keep<uint32_t>(values, true, false);
  }
  void put(D a) {
    alignas(64) double values[kLanes];
    store(values, a);
    keep<uint64_t>(values, false, true);
  }
  void put(U a) {
    alignas(64) uint32_t values[kLanes];
    store(values, a);
    keep<uint32_t>(values, false, false);
  }
  void put(M a) {
    uint32_t values[kLanes];
    for (int i = 0; i < kLanes; ++i)
      values[i] = bits(a) >> i & 1;
    keep<uint32_t>(values, false, false);
  }
  template <class T> void put(const Vector2<T> &v) {
    put(v.x);
    put(v.y);
  }
  template <class T> void put(const Vector3<T> &v) {
    put(v.x);
    put(v.y);
    put(v.z);
  }

private:
  template <class Bits, class T> void keep(const T *values, bool is_float, bool is_double) {
    for (int i = 0; i < kLanes; ++i) {
      Bits copy;
      __builtin_memcpy(&copy, values + i, sizeof(copy));
      out.bits[row][first + i] = copy;
    }
    out.is_float[row] = is_float;
    out.is_double[row] = is_double;
    ++row;
  }
};

template <class Run> [[gnu::flatten]] void all_lanes(const WidthInputs &in, WidthOutputs &out) {
  for (int first = 0; first < WidthInputs::kCount; first += kLanes) {
    Lane lane{in, out, first};
    Run{}(lane);
    out.rows = lane.row;
  }
}

template <class Run> constexpr WidthFormula formula(const char *name, Run) { return {name, all_lanes<Run>}; }

// Two numbers of any kind.
template <class T> void put_arithmetic(Lane &lane, T a, T b) {
  lane.put(a + b);
  lane.put(a - b);
  lane.put(a * b);
}
template <class T> void put_fractions(Lane &lane, T a, T b) {
  put_arithmetic(lane, a, b);
  lane.put(a / b);
  lane.put(-a);
  lane.put(sqrt(a));
  lane.put(abs(a));
  lane.put(min(a, b));
  lane.put(max(a, b));
  lane.put(select(M(a < b), a, b));
  lane.put(M(a < b));
  lane.put(M(a <= b));
  lane.put(M(a > b));
  lane.put(M(a >= b));
  lane.put(M(a == b));
  lane.put(M(a != b));
  T c = a;
  c += b;
  c *= a;
  c -= b;
  lane.put(c);
}

constexpr WidthFormula kNumbers[] = {
    formula("Float", [](Lane &lane) { put_fractions(lane, lane.number(0), lane.number(1)); }),
    formula("Double", [](Lane &lane) { put_fractions(lane, lane.wide(0), lane.wide(1)); }),
    formula("Word",
            [](Lane &lane) {
              const auto a = lane.word(0), b = lane.word(1);
              put_arithmetic(lane, a, b);
              lane.put(a & b);
              lane.put(a | b);
              lane.put(a ^ b);
              lane.put(a >> 7);
              lane.put(a << 9);
              lane.put(equal(a, b));
              lane.put(equal(a, a));
              lane.put(select(lane.odd(), a, b));
            }),
    formula("Mask",
            [](Lane &lane) {
              const M a = lane.odd(), b = equal(lane.word(1) & U(1u), U(1u)), neither = !(a | b);
              lane.put(M(a & b));
              lane.put(M(a | b));
              lane.put(M(!a));
              lane.put(M(a != b));
              lane.put(neither);
              lane.put(select(neither, lane.number(0), lane.number(1)));
              // Of as many lanes as there are: what they say together agrees with their bits.
              constexpr uint32_t all_bits = (1u << kLanes) - 1u;
              lane.put(U(any(a) == (bits(a) != 0) && all(a) == (bits(a) == all_bits) ? 1u : 0u));
              lane.put(mask_of(bits(a)));
            }),
    formula("floor", [](Lane &lane) { lane.put(floor(lane.number(0))); }),
    formula("copysign", [](Lane &lane) { lane.put(copysign(lane.number(0), lane.number(1))); }),
    formula("sign", [](Lane &lane) { lane.put(sign(lane.wide(0))); }),
    formula("as_word", [](Lane &lane) { lane.put(as_word(lane.number(0))); }),
    formula("as_float", [](Lane &lane) { lane.put(as_float(lane.word(0))); }),
    formula("to_float", [](Lane &lane) { lane.put(to_float(lane.word(0))); }),
    formula("truncate",
            [](Lane &lane) {
              lane.put(truncate(lane.whole()));
              lane.put(truncate(widen(lane.whole())));
            }),
    formula("widen", [](Lane &lane) { lane.put(widen(lane.number(0))); }),
    formula("narrow", [](Lane &lane) { lane.put(narrow(lane.wide(0))); }),
    formula("power_of_two", [](Lane &lane) { lane.put(power_of_two(widen(to_float(lane.word(0) & U(1023u))) - D(511.0))); }),
    formula("gather",
            [](Lane &lane) {
              const U at = lane.word(0) & U(15u);
              lane.put(gather(lane.in.number[1], at));
              lane.put(gather(lane.in.wide_number[1], at));
              lane.put(gather(lane.in.word[1], at));
              lane.put(gather_bytes(lane.in.word[1], (at << 2) - at));
            }),
    formula("store",
            [](Lane &lane) {
              alignas(64) float some[kLanes];
              alignas(64) double wide_some[kLanes];
              store(some, lane.number(0));
              store(some, lane.odd(), lane.number(1));
              store(wide_some, lane.wide(0));
              store(wide_some, lane.odd(), lane.wide(1));
              lane.put(F(load_lanes<kLanes>(some)));
              lane.put(D(load_lanes<kLanes>(wide_some)));
            }),
    {},
};

constexpr WidthFormula kSamples[] = {
    formula("sin_octant", [](Lane &lane) { lane.put(sin_octant(lane.unit(0))); }),
    formula("cos_octant", [](Lane &lane) { lane.put(cos_octant(lane.unit(0))); }),
    formula("sin_cos_turn",
            [](Lane &lane) {
              const auto turn = sin_cos_turn(lane.unit(0));
              lane.put(turn.sin);
              lane.put(turn.cos);
              const auto wide_turn = sin_cos_turn(lane.of(lane.in.choice));
              lane.put(wide_turn.sin);
              lane.put(wide_turn.cos);
            }),
    formula("angle", [](Lane &lane) { lane.put(angle(lane.wide(0), lane.wide(1))); }),
    formula("place_on_map",
            [](Lane &lane) {
              const auto place = place_on_map(lane.wide(0), lane.wide(1), lane.wide(2), abs(lane.wide(1)));
              lane.put(place.x);
              lane.put(place.y);
            }),
    formula("warp_disk", [](Lane &lane) { lane.put(warp_disk(lane.unit(0), lane.unit(1))); }),
    formula("warp_cosine_hemisphere",
            [](Lane &lane) {
              lane.put(warp_cosine_hemisphere(lane.unit(0), lane.unit(1)));
              lane.put(warp_cosine_hemisphere_pdf(lane.number(0)));
            }),
    formula("warp_sphere", [](Lane &lane) { lane.put(warp_sphere(lane.unit(0), lane.unit(1))); }),
    formula("warp_cone",
            [](Lane &lane) {
              lane.put(warp_cone(lane.unit(0), lane.unit(1), lane.unit(2)));
              lane.put(warp_cone_pdf(lane.unit(2)));
            }),
    formula("warp_triangle", [](Lane &lane) { lane.put(warp_triangle(lane.unit(0), lane.unit(1))); }),
    formula("one_minus_cos", [](Lane &lane) { lane.put(one_minus_cos(lane.unit(0))); }),
    formula("hash", [](Lane &lane) { lane.put(hash_combine(hash(lane.word(0)), lane.word(1))); }),
    formula("reverse_bits", [](Lane &lane) { lane.put(sobol::reverse_bits(lane.word(0))); }),
    formula("reversed_second_dimension", [](Lane &lane) { lane.put(sobol::reversed_second_dimension(lane.word(0))); }),
    formula("nested_scramble", [](Lane &lane) { lane.put(nested_scramble(lane.word(0), lane.word(1))); }),
    formula("scrambled", [](Lane &lane) { lane.put(scrambled(lane.word(0), lane.word(1), 5)); }),
    formula("pair_numbers", [](Lane &lane) { lane.put(pair_numbers(lane.word(0), lane.word(1), 18)); }),
    formula("sample_filter", [](Lane &lane) { lane.put(sample_filter(*lane.in.filter, lane.unit(0))); }),
    formula("sample_direction",
            [](Lane &lane) {
              const auto found = sample_direction(lane.in.map, lane.unit(0), lane.unit(1));
              lane.put(found.direction);
              lane.put(found.pdf);
            }),
    formula("direction_pdf", [](Lane &lane) { lane.put(direction_pdf(lane.in.map, lane.normal())); }),
    {},
};

constexpr WidthFormula kLights[] = {
    formula("sample_light",
            [](Lane &lane) {
              // Masked lanes keep their values.
              LightSampleLanes<F> sample{lane.of(lane.in.wi), lane.of(lane.in.wi), D(1.0), D(2.0), lane.normal(), lane.odd()};
              const M asked = !equal(lane.word(1) & U(7u), U(0u));
              sample_light(EachLight<F>{lane.in.light + lane.first}, lane.of(lane.in.p), lane.unit(0), lane.unit(1), asked,
                           sample);
              lane.put(sample.target);
              lane.put(sample.wi);
              lane.put(sample.distance);
              lane.put(sample.pdf);
              lane.put(sample.radiance);
              lane.put(sample.delta);
            }),
    formula("meet_light",
            [](Lane &lane) {
              const auto hit = meet_light(OneLight<F>{*lane.in.light[0]}, lane.of(lane.in.p), lane.of(lane.in.wi));
              lane.put(hit.radiance);
              lane.put(hit.pdf);
              lane.put(hit.distance);
            }),
    formula("may_meet",
            [](Lane &lane) {
              lane.put(
                  M(may_meet(OneLight<F>{*lane.in.light[0]}, lane.of(lane.in.p), lane.of(lane.in.wi), lane.of(lane.in.end))));
            }),
    formula("importance",
            [](Lane &lane) {
              const auto bounds = importance(lane.query(), *lane.in.tree_light);
              lane.put(bounds.most);
              lane.put(bounds.least);
            }),
    formula("SeenFace",
            [](Lane &lane) {
              const Vector3<F> corner[3] = {
                  lane.normal(), {lane.unit(0), lane.unit(1), lane.unit(2)}, {lane.unit(3), -lane.unit(0), lane.unit(1)}};
              // Mostly from near, where angles count, and from far.
              for (const Vector3<D> &p : {lane.of(lane.in.wi), lane.of(lane.in.p)}) {
                const SeenFace<F> seen(MapLanes<F>(Affine{}), corner, p);
                lane.put(seen.sample(lane.unit(2), lane.unit(3)));
                lane.put(seen.pdf(widen(corner[1]) - p, lane.normal()));
                lane.put(seen.by_angle);
              }
            }),
    formula("pair_shares", [](Lane &lane) { lane.put(pair_shares(lane.query(), lane.in.tree, 0)); }),
    formula("choose_light",
            [](Lane &lane) {
              const auto choice =
                  choose_light(lane.query(), lane.in.tree, lane.of(lane.in.choice), M(equal(lane.word(0), lane.word(0))));
              lane.put(choice.number);
              lane.put(choice.probability);
              // A choice of no light leaves no random number.
              lane.put(select(M(choice.probability > D(0.0)), choice.u, D(0.0)));
            }),
    formula("choice_probability", [](Lane &lane) { lane.put(choice_probability(lane.query(), lane.in.tree, 0)); }),
    {},
};

} // namespace

namespace LANCER_ISA {
const WidthKernel width_kernel = {LANCER_ISA_NAME, kNumbers, kSamples, kLights};
}

} // namespace lancer
