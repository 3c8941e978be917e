// Writes src/bsdf/albedo_tables.cpp: directional albedos of GGX, integrated in double.
//   c++ -std=c++20 -O2 tables/albedo_tables.cpp -o albedo_tables && ./albedo_tables > src/bsdf/albedo_tables.cpp
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <vector>

namespace {

struct Vec {
  double x, y, z;
};
double dot(const Vec &a, const Vec &b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec normalised(const Vec &a) {
  const double l = std::sqrt(dot(a, a));
  return {a.x / l, a.y / l, a.z / l};
}

constexpr double kPi = std::numbers::pi;

struct Rule {
  std::vector<double> node, weight; // on 0 ... 1
};

// Gauss-Legendre by Newton's method on the Legendre polynomial.
Rule gauss(int n) {
  Rule rule;
  for (int i = 0; i < n; ++i) {
    double x = std::cos(kPi * (i + 0.75) / (n + 0.5)), slope = 0;
    for (int step = 0; step < 50; ++step) {
      double p0 = 1, p1 = x;
      for (int k = 2; k <= n; ++k) {
        const double p2 = ((2 * k - 1) * x * p1 - (k - 1) * p0) / k;
        p0 = p1;
        p1 = p2;
      }
      slope = n * (x * p1 - p0) / (x * x - 1);
      x -= p1 / slope;
    }
    rule.node.push_back(0.5 - 0.5 * x);
    rule.weight.push_back(1 / ((1 - x * x) * slope * slope));
  }
  return rule;
}

// Light from wo on facets of GGX.
struct Surface {
  double alpha, mu;
  Vec wo{std::sqrt((1 - mu) * (1 + mu)), 0, mu};

  double lambda(double z) const {
    const double t = alpha * alpha * (1 - z * z) / (z * z);
    return 0.5 * t / (1 + std::sqrt(1 + t));
  }
  // Returns the unshadowed share of a facet's light in directions with that cosine.
  double unshadowed(double z) const {
    const double o = lambda(mu);
    return (1 + o) / (1 + o + lambda(std::abs(z)));
  }
  // Returns a visible facet, uniformly distributed by u in 0 ... 1 and phi in half a turn; the other half is its mirror image.
  Vec facet(double u, double phi) const {
    const Vec w = normalised({alpha * wo.x, 0, wo.z});
    const double s = u * (1 + w.z), sine = std::sqrt(std::max(0.0, s * (2 - s)));
    return normalised({alpha * (sine * std::cos(phi) + w.x), alpha * sine * std::sin(phi), (1 - u) * (1 + w.z)});
  }
  double reflected_z(const Vec &h) const { return 2 * dot(wo, h) * h.z - wo.z; }
};

double cos2_refracted(double c, double eta) { return 1 - (1 - c * c) / (eta * eta); }
double refracted_z(const Surface &s, const Vec &h, double eta) {
  const double c = dot(s.wo, h);
  return (c / eta - std::sqrt(std::max(0.0, cos2_refracted(c, eta)))) * h.z - s.wo.z / eta;
}
double fresnel(double c, double eta) {
  const double cos2 = cos2_refracted(c, eta);
  if (cos2 <= 0)
    return 1;
  const double t = std::sqrt(cos2), rs = (c - eta * t) / (c + eta * t), rp = (eta * c - t) / (eta * c + t);
  return 0.5 * (rs * rs + rp * rp);
}

using Scalar = std::function<double(const Vec &)>;

// Returns the mean of value over the visible facets with a positive side (all if side is null). Each line of constant phi is
// split where side or one of the edges changes its sign, so that the rule integrates only smooth pieces.
double mean(const Surface &s, const Scalar &side, const std::vector<Scalar> &edges, const Scalar &value) {
  static const Rule along = gauss(28), around = gauss(120);
  constexpr int kScan = 200;
  // At the very end, no facet is left.
  constexpr double kEnd = 1 - 1e-9;
  double sum = 0;
  for (size_t j = 0; j < around.node.size(); ++j) {
    const double phi = kPi * around.node[j];
    std::vector<double> cut{0.0};
    std::vector<Scalar> signs = edges;
    if (side)
      signs.push_back(side);
    for (const Scalar &f : signs) {
      double before = f(s.facet(0, phi));
      for (int i = 1; i <= kScan; ++i) {
        double low = kEnd * (i - 1) / kScan, high = kEnd * i / kScan;
        const double after = f(s.facet(high, phi));
        if ((before > 0) != (after > 0)) {
          for (int step = 0; step < 45; ++step) {
            const double middle = 0.5 * (low + high);
            ((f(s.facet(middle, phi)) > 0) == (before > 0) ? low : high) = middle;
          }
          cut.push_back(high);
        }
        before = after;
      }
    }
    cut.push_back(1.0);
    std::sort(cut.begin(), cut.end());
    for (size_t k = 0; k + 1 < cut.size(); ++k) {
      const double a = cut[k], width = cut[k + 1] - a;
      for (size_t i = 0; i < along.node.size(); ++i) {
        // Nodes are denser at both ends: the horizon cuts narrow lobes off steeply.
        const double t = along.node[i];
        const Vec h = s.facet(a + width * t * t * (3 - 2 * t), phi);
        if (!side || side(h) > 0)
          sum += around.weight[j] * along.weight[i] * width * 6 * t * (1 - t) * value(h);
      }
    }
  }
  return sum;
}

double mirror_albedo(const Surface &s) {
  return mean(
      s, [&](const Vec &h) { return s.reflected_z(h); }, {}, [&](const Vec &h) { return s.unshadowed(s.reflected_z(h)); });
}

double glass_albedo(const Surface &s, double eta) {
  // Total reflection, and light that leaves along the surface.
  const auto total = [&](const Vec &h) { return cos2_refracted(dot(s.wo, h), eta); };
  const auto along = [&](const Vec &h) { return refracted_z(s, h, eta); };
  const double reflected = mean(
      s, [&](const Vec &h) { return s.reflected_z(h); }, {total},
      [&](const Vec &h) { return fresnel(dot(s.wo, h), eta) * s.unshadowed(s.reflected_z(h)); });
  // Light that is refracted so little that it stays above a surface seen from inside at a grazing angle counts as transmitted,
  // as in Cycles' tables. The lobes send no light there, so their sum is below 1 by this part.
  const double through = mean(s, nullptr, {total, along}, [&](const Vec &h) {
    return (1 - fresnel(dot(s.wo, h), eta)) * s.unshadowed(refracted_z(s, h, eta));
  });
  return reflected + through;
}

// Returns the mean of a curve over the reflecting facets.
double mix(const Surface &s, const std::function<double(double)> &curve) {
  return mean(
      s, [&](const Vec &h) { return s.reflected_z(h); }, {}, [&](const Vec &h) { return curve(dot(s.wo, h)); });
}

// Nodes of the grids. Both ends of an axis are slightly inside; roughness 0 is a smooth surface.
double cosine(int i, int n) { return std::clamp(i / (n - 1.0), 1e-4, 1.0); }
double alpha(int i, int n) { return std::pow(i / (n - 1.0), 2); }
double index(int i, int n) {
  const double z = std::clamp(i / (n - 1.0), 1e-4, 0.99), r = z * z;
  return (1 + r) / (1 - r);
}

// Returns the albedo under a white sky: the mean over directions, weighted by the cosine.
double sky(const std::function<double(double)> &albedo) {
  static const Rule rule = gauss(24);
  double sum = 0;
  for (size_t i = 0; i < rule.node.size(); ++i) {
    // Nodes are denser at the horizon, where the albedo has a high curvature.
    const double mu = rule.node[i] * rule.node[i];
    sum += rule.weight[i] * 2 * rule.node[i] * 2 * mu * albedo(mu);
  }
  return sum;
}

void print(const char *head, const std::vector<double> &values, const char *tail) {
  std::printf("%s", head);
  for (size_t i = 0; i < values.size(); ++i)
    std::printf("%s%d%s", i % 20 == 0 ? "\n    " : " ", static_cast<int>(std::lround(65535 * std::clamp(values[i], 0.0, 1.0))),
                i + 1 < values.size() ? "," : "");
  std::printf("%s", tail);
}

} // namespace

int main() {
  constexpr int fine = 32, coarse = 16;
  std::printf("// Written by tables/albedo_tables.cpp.\n// clang-format off\n#include \"bsdf/albedo_tables.h\"\n\n"
              "namespace lancer::tables {\n");
  std::vector<double> t;
  for (int y = 0; y < fine; ++y)
    for (int x = 0; x < fine; ++x)
      t.push_back(x == 0 ? 1.0 : mirror_albedo({alpha(x, fine), cosine(y, fine)}));
  print("\nconst uint16_t kGgx[] = {", t, "};\n");
  t.clear();
  for (int x = 0; x < fine; ++x)
    t.push_back(x == 0 ? 1.0 : sky([&](double mu) { return mirror_albedo({alpha(x, fine), mu}); }));
  print("\nconst uint16_t kGgxMean[] = {", t, "};\n");

  // An index of 1 neither refracts nor loses light.
  const auto eta = [](int side, int z) { return side ? 1 / index(z, coarse) : index(z, coarse); };
  for (int side = 0; side < 2; ++side) {
    t.clear();
    for (int z = 0; z < coarse; ++z)
      for (int y = 0; y < coarse; ++y)
        for (int x = 0; x < coarse; ++x)
          t.push_back(x == 0 || z == 0 ? 1.0 : glass_albedo({alpha(x, coarse), cosine(y, coarse)}, eta(side, z)));
    print(side ? ",\n   {" : "\nconst uint16_t kGlass[][kCoarse * kCoarse * kCoarse] = {\n   {", t, side ? "}};\n" : "}");
  }
  for (int side = 0; side < 2; ++side) {
    t.clear();
    for (int z = 0; z < coarse; ++z)
      for (int x = 0; x < coarse; ++x)
        t.push_back(x == 0 || z == 0 ? 1.0 : sky([&](double mu) {
          return glass_albedo({alpha(x, coarse), mu}, eta(side, z));
        }));
    print(side ? ",\n   {" : "\nconst uint16_t kGlassMean[][kCoarse * kCoarse] = {\n   {", t, side ? "}};\n" : "}");
  }

  t.clear();
  for (int z = 0; z < coarse; ++z)
    for (int y = 0; y < coarse; ++y)
      for (int x = 0; x < coarse; ++x) {
        const double n = index(z, coarse), f0 = std::pow((n - 1) / (n + 1), 2), mu = cosine(y, coarse);
        const auto curve = [&](double c) { return std::clamp((fresnel(c, n) - f0) / (1 - f0), 0.0, 1.0); };
        t.push_back(z == 0 ? 0.0 : x == 0 ? curve(mu) : mix({alpha(x, coarse), mu}, curve));
      }
  print("\nconst uint16_t kDielectricMix[] = {", t, "};\n");

  // Cycles' table is for all exponents; 5 is in the middle between two of its nodes.
  t.clear();
  for (int y = 0; y < coarse; ++y)
    for (int x = 0; x < coarse; ++x) {
      const double mu = cosine(y, coarse);
      const auto curve = [&](double c) { return 0.5 * (std::pow(1 - c, 5.0 * 8 / 7) + std::pow(1 - c, 5.0 * 7 / 8)); };
      t.push_back(x == 0 ? curve(mu) : mix({alpha(x, coarse), mu}, curve));
    }
  print("\nconst uint16_t kFifthPowerMix[] = {", t, "};\n");
  std::printf("\n} // namespace lancer::tables\n");
}
