// Compiled once per instruction set, with LANCER_ISA naming it.
#include "widths/width_kernel.h"

#include "lights/sample_light.h"
#include "lights/seen_face.h"
#include "sampling/elementary.h"
#include "sampling/scramble.h"
#include "simd/kernel_lanes.h"

#include <type_traits>

namespace lancer {
namespace {

// So many lanes of the inputs, and where their results go.
template <class F_> struct Lane {
  using F = F_;
  using D = DoubleOf<F>;
  using U = WordOf<F>;
  using M = MaskOf<F>;
  static constexpr int W = LanesOf<F>::kWidth;

  const WidthInputs &in;
  WidthOutputs &out;
  int first, row = 0;

  F unit(int i) const { return load_lanes<W>(in.unit[i] + first); }
  F number(int i) const { return load_lanes<W>(in.number[i] + first); }
  D wide(int i) const { return load_lanes<W>(in.wide_number[i] + first); }
  U word(int i) const { return load_lanes<W>(in.word[i] + first); }
  F whole() const { return load_lanes<W>(in.whole + first); }
  D of(const double (&numbers)[16]) const { return load_lanes<W>(numbers + first); }
  Vector3<D> of(const double (&v)[3][16]) const { return {of(v[0]), of(v[1]), of(v[2])}; }
  Vector3<F> normal() const {
    return {load_lanes<W>(in.n[0] + first), load_lanes<W>(in.n[1] + first), load_lanes<W>(in.n[2] + first)};
  }
  M odd() const { return equal(word(0) & U(1u), U(1u)); }
  LightQueryLanes<F> query() const { return {of(in.p), normal(), odd()}; }

  void put(F a) {
    alignas(64) float values[W];
    store(values, a);
    keep<uint32_t>(values, true, false);
  }
  void put(D a) requires(!std::is_same_v<D, F>) {
    alignas(64) double values[W];
    store(values, a);
    keep<uint64_t>(values, false, true);
  }
  void put(U a) {
    alignas(64) uint32_t values[W];
    store(values, a);
    keep<uint32_t>(values, false, false);
  }
  void put(M a) {
    uint32_t values[W];
    for (int i = 0; i < W; ++i)
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
    for (int i = 0; i < W; ++i) {
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
    Lane<F> lane{in, out, first};
    Run{}(lane);
    out.rows = lane.row;
  }
}

template <class Run> constexpr WidthFormula formula(const char *name, Run) { return {name, all_lanes<Run>}; }

#define LANCER_OF(lane)                                                                                                        \
  using T = std::remove_reference_t<decltype(lane)>;                                                                           \
  using F [[maybe_unused]] = typename T::F;                                                                                    \
  using D [[maybe_unused]] = typename T::D;                                                                                    \
  using U [[maybe_unused]] = typename T::U;                                                                                    \
  using M [[maybe_unused]] = typename T::M;

// Two numbers of any kind.
template <class Lane, class T> void put_arithmetic(Lane &lane, T a, T b) {
  lane.put(a + b);
  lane.put(a - b);
  lane.put(a * b);
}
template <class Lane, class T> void put_fractions(Lane &lane, T a, T b) {
  using M = typename Lane::M;
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
    formula("Float", [](auto &lane) { put_fractions(lane, lane.number(0), lane.number(1)); }),
    formula("Double", [](auto &lane) { put_fractions(lane, lane.wide(0), lane.wide(1)); }),
    formula("Word",
            [](auto &lane) {
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
            [](auto &lane) {
              LANCER_OF(lane)
              const M a = lane.odd(), b = equal(lane.word(1) & U(1u), U(1u)), neither = !(a | b);
              lane.put(M(a & b));
              lane.put(M(a | b));
              lane.put(M(!a));
              lane.put(M(a != b));
              lane.put(neither);
              lane.put(select(neither, lane.number(0), lane.number(1)));
              // Of as many lanes as there are: what they say together agrees with their bits.
              constexpr uint32_t all_bits = (1u << T::W) - 1u;
              lane.put(U(any(a) == (bits(a) != 0) && all(a) == (bits(a) == all_bits) ? 1u : 0u));
              if constexpr (T::W > 1)
                lane.put(mask_from<T::W>(bits(a)));
              else
                lane.put(a);
            }),
    formula("floor", [](auto &lane) { lane.put(floor(lane.number(0))); }),
    formula("copysign", [](auto &lane) { lane.put(copysign(lane.number(0), lane.number(1))); }),
    formula("sign", [](auto &lane) { lane.put(sign(lane.wide(0))); }),
    formula("as_word", [](auto &lane) { lane.put(as_word(lane.number(0))); }),
    formula("as_float", [](auto &lane) { lane.put(as_float(lane.word(0))); }),
    formula("to_float", [](auto &lane) { lane.put(to_float(lane.word(0))); }),
    formula("truncate",
            [](auto &lane) {
              lane.put(truncate(lane.whole()));
              lane.put(truncate(widen(lane.whole())));
            }),
    formula("widen", [](auto &lane) { lane.put(widen(lane.number(0))); }),
    formula("narrow", [](auto &lane) { lane.put(narrow(lane.wide(0))); }),
    formula("power_of_two",
            [](auto &lane) {
              LANCER_OF(lane)
              lane.put(power_of_two(widen(to_float(lane.word(0) & U(1023u))) - D(511.0)));
            }),
    formula("gather",
            [](auto &lane) {
              LANCER_OF(lane)
              const U at = lane.word(0) & U(15u);
              lane.put(gather(lane.in.number[1], at));
              lane.put(gather(lane.in.wide_number[1], at));
              lane.put(gather(lane.in.word[1], at));
              lane.put(gather_bytes(lane.in.word[1], (at << 2) - at));
            }),
    formula("store",
            [](auto &lane) {
              LANCER_OF(lane)
              alignas(64) float some[T::W];
              alignas(64) double wide_some[T::W];
              store(some, lane.number(0));
              store(some, lane.odd(), lane.number(1));
              store(wide_some, lane.wide(0));
              store(wide_some, lane.odd(), lane.wide(1));
              lane.put(F(load_lanes<T::W>(some)));
              lane.put(D(load_lanes<T::W>(wide_some)));
            }),
    {},
};

constexpr WidthFormula kSamples[] = {
    formula("sin_octant", [](auto &lane) { lane.put(sin_octant(lane.unit(0))); }),
    formula("cos_octant", [](auto &lane) { lane.put(cos_octant(lane.unit(0))); }),
    formula("sin_cos_turn",
            [](auto &lane) {
              const auto turn = sin_cos_turn(lane.unit(0));
              lane.put(turn.sin);
              lane.put(turn.cos);
              const auto wide_turn = sin_cos_turn(lane.of(lane.in.choice));
              lane.put(wide_turn.sin);
              lane.put(wide_turn.cos);
            }),
    formula("angle", [](auto &lane) { lane.put(angle(lane.wide(0), lane.wide(1))); }),
    formula("place_on_map",
            [](auto &lane) {
              const auto place = place_on_map(lane.wide(0), lane.wide(1), lane.wide(2), abs(lane.wide(1)));
              lane.put(place.x);
              lane.put(place.y);
            }),
    formula("warp_disk", [](auto &lane) { lane.put(warp_disk(lane.unit(0), lane.unit(1))); }),
    formula("warp_cosine_hemisphere",
            [](auto &lane) {
              lane.put(warp_cosine_hemisphere(lane.unit(0), lane.unit(1)));
              lane.put(warp_cosine_hemisphere_pdf(lane.number(0)));
            }),
    formula("warp_sphere", [](auto &lane) { lane.put(warp_sphere(lane.unit(0), lane.unit(1))); }),
    formula("warp_cone",
            [](auto &lane) {
              lane.put(warp_cone(lane.unit(0), lane.unit(1), lane.unit(2)));
              lane.put(warp_cone_pdf(lane.unit(2)));
            }),
    formula("warp_triangle", [](auto &lane) { lane.put(warp_triangle(lane.unit(0), lane.unit(1))); }),
    formula("one_minus_cos", [](auto &lane) { lane.put(one_minus_cos(lane.unit(0))); }),
    formula("hash", [](auto &lane) { lane.put(hash_combine(hash(lane.word(0)), lane.word(1))); }),
    formula("reverse_bits", [](auto &lane) { lane.put(sobol::reverse_bits(lane.word(0))); }),
    formula("reversed_second_dimension", [](auto &lane) { lane.put(sobol::reversed_second_dimension(lane.word(0))); }),
    formula("nested_scramble", [](auto &lane) { lane.put(nested_scramble(lane.word(0), lane.word(1))); }),
    formula("scrambled", [](auto &lane) { lane.put(scrambled(lane.word(0), lane.word(1), 5)); }),
    formula("pair_numbers", [](auto &lane) { lane.put(pair_numbers(lane.word(0), lane.word(1), 18)); }),
    formula("sample_filter", [](auto &lane) { lane.put(sample_filter(*lane.in.filter, lane.unit(0))); }),
    formula("sample_direction",
            [](auto &lane) {
              const auto found = sample_direction(lane.in.map, lane.unit(0), lane.unit(1));
              lane.put(found.direction);
              lane.put(found.pdf);
            }),
    formula("direction_pdf",
            [](auto &lane) {
              LANCER_OF(lane)
              lane.put(direction_pdf<F>(lane.in.map, place_of(lane.normal())));
            }),
    {},
};

constexpr WidthFormula kLights[] = {
    formula("sample_light",
            [](auto &lane) {
              LANCER_OF(lane)
              // Lanes that are not asked keep what they have.
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
            [](auto &lane) {
              LANCER_OF(lane)
              const auto hit = meet_light(OneLight<F>{*lane.in.light[0]}, lane.of(lane.in.p), lane.of(lane.in.wi));
              lane.put(hit.radiance);
              lane.put(hit.pdf);
              lane.put(hit.distance);
            }),
    formula("may_meet",
            [](auto &lane) {
              LANCER_OF(lane)
              lane.put(
                  M(may_meet(OneLight<F>{*lane.in.light[0]}, lane.of(lane.in.p), lane.of(lane.in.wi), lane.of(lane.in.end))));
            }),
    formula("importance",
            [](auto &lane) {
              const auto bounds = importance(lane.query(), *lane.in.tree_light);
              lane.put(bounds.most);
              lane.put(bounds.least);
            }),
    formula("SeenFace",
            [](auto &lane) {
              LANCER_OF(lane)
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
    formula("pair_shares", [](auto &lane) { lane.put(pair_shares(lane.query(), lane.in.tree, 0)); }),
    formula("choose_light",
            [](auto &lane) {
              LANCER_OF(lane)
              const auto choice =
                  choose_light(lane.query(), lane.in.tree, lane.of(lane.in.choice), M(equal(lane.word(0), lane.word(0))));
              lane.put(choice.number);
              lane.put(choice.probability);
              // What is left of a choice of nothing is nothing.
              lane.put(select(M(choice.probability > D(0.0)), choice.u, D(0.0)));
            }),
    formula("choice_probability", [](auto &lane) { lane.put(choice_probability(lane.query(), lane.in.tree, 0)); }),
    {},
};

#undef LANCER_OF

} // namespace

namespace LANCER_ISA {
const WidthKernel width_kernel = {LANCER_ISA_NAME, kNumbers, kSamples, kLights};
}

} // namespace lancer
