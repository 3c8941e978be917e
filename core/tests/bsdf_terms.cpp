// Fresnel, Beckmann, Smith and the whole coating against values computed with mpmath at 50 digits from the same floats.
#include "bsdf/bsdf.h"

#include <gtest/gtest.h>
#include <limits>

#include "bsdf_seen.h"

namespace lancer {
namespace {

constexpr double kUlp = 0x1p-24; // half a unit in the last place, relative

TEST(Fresnel, MatchesMpmath) {
  const struct {
    float cos_i, eta;
    double expected;
  } values[] = {
      {1.0f, 1.00000012f, 3.5527132552840652e-15},
      {0.899999976f, 1.00000012f, 3.7481910517975453e-15},
      {0.5f, 1.00000012f, 3.5527102059683177e-14},
      {0.100000001f, 1.00000012f, 3.4822863072388264e-11},
      {0.00100000005f, 1.00000012f, 0.0028524014252899532},
      {1.0f, 1.00000095f, 2.2737345860295266e-13},
      {0.899999976f, 1.00000095f, 2.398840013633526e-13},
      {0.5f, 1.00000095f, 2.2737189736354949e-12},
      {0.100000001f, 1.00000095f, 2.2282895278044597e-9},
      {0.00100000005f, 1.00000095f, 0.067940517889997348},
      {1.0f, 1.00100005f, 2.497735179276061e-7},
      {0.899999976f, 1.00100005f, 2.6348271352735101e-7},
      {0.5f, 1.00100005f, 2.4798734753703123e-6},
      {0.100000001f, 1.00100005f, 0.0020318082725740319},
      {0.00100000005f, 1.00100005f, 0.91438797197010039},
      {1.0f, 1.5f, 0.04},
      {0.899999976f, 1.5f, 0.040791888352669276},
      {0.5f, 1.5f, 0.089186712802212783},
      {0.100000001f, 1.5f, 0.57159251574600751},
      {0.00100000005f, 1.5f, 0.99420557223419737},
      {1.0f, 2.5f, 0.1836734693877551},
      {0.899999976f, 2.5f, 0.18441469437275856},
      {0.5f, 2.5f, 0.22045738455681042},
      {0.100000001f, 2.5f, 0.58334704957730493},
      {0.00100000005f, 2.5f, 0.99370208346141144},
      {1.0f, 1e+09f, 0.99999999600000001},
      {0.899999976f, 1e+09f, 0.99999999597777777},
      {0.5f, 1e+09f, 0.99999999500000002},
      {0.100000001f, 1e+09f, 0.9999999798000007},
      {0.00100000005f, 1e+09f, 0.99999800000209499},
      {1.0f, 9.99999998e+18f, 1.0},
      {0.899999976f, 9.99999998e+18f, 1.0},
      {0.5f, 9.99999998e+18f, 1.0},
      {0.100000001f, 9.99999998e+18f, 1.0},
      {0.00100000005f, 9.99999998e+18f, 0.9999999999999998},
      {1.0f, 0.899999976f, 0.0027700844928917452},
      {0.899999976f, 0.899999976f, 0.0029680234016537189},
      {0.5f, 0.899999976f, 0.088929949981065914},
      {0.100000001f, 0.899999976f, 1.0},
      {0.00100000005f, 0.899999976f, 1.0},
      {1.0f, 0.999998987f, 2.5668382338558822e-13},
      {0.899999976f, 0.999998987f, 2.7080714967069856e-13},
      {0.5f, 0.999998987f, 2.5668569606332281e-12},
      {0.100000001f, 0.999998987f, 2.5165246086943237e-9},
      {0.00100000005f, 0.999998987f, 1.0},
      {1.0f, 0.5f, 0.11111111111111111},
      {0.899999976f, 0.5f, 0.16456308107391595},
      {0.5f, 0.5f, 1.0},
      {0.100000001f, 0.5f, 1.0},
      {0.00100000005f, 0.5f, 1.0},
  };
  // Double inside: at eta = 1 + 2^-23 the differences cancel 2^23 of 2^53, which leaves 1e-8; then one rounding to float.
  for (const auto &v : values)
    EXPECT_NEAR(fresnel_dielectric(v.cos_i, v.eta) / v.expected, 1.0, kUlp + 1e-8) << v.cos_i << " " << v.eta;
}

// The factored form without a subtraction of nearly equal numbers, in long double.
long double factored_fresnel(long double c, long double n) {
  if (n >= 1.0l) {
    const long double e = 1.0l / n, d = (n - 1.0l) * (n + 1.0l) * e * e, g = std::sqrt(e * c * e * c + d);
    const long double rs = -d / ((e * c + g) * (e * c + g)), p = c + e * g, rp = d * (c * c * (1.0l + e * e) - e * e) / (p * p);
    return 0.5l * (rs * rs + rp * rp);
  }
  const long double d = (1.0l - n) * (1.0l + n), g2 = c * c - d;
  if (!(g2 > 0.0l))
    return 1.0l;
  const long double g = std::sqrt(g2), s = c + g, p = n * n * c + g;
  const long double rs = d / (s * s), rp = d * (1.0l - c * c * (1.0l + n * n)) / (p * p);
  return 0.5l * (rs * rs + rp * rp);
}

TEST(Fresnel, IsRightForEveryIndexAtEveryAngle) {
  for (const float n : {1.0f + 0x1p-23f, 1.0f + 0x1p-20f, 1.00001f, 1.001f, 1.33f, 1.5f, 2.5f, 1e3f, 1e9f, 1e19f, 3e38f, 0.5f,
                        0.9f, 0.999f, 1.0f - 0x1p-20f, 1.0f - 0x1p-24f})
    for (int i = 1; i <= 300; ++i) {
      // Uniform in the angle, and 1e-5 from grazing.
      const float c = i == 300 ? 1e-5f : std::cos(float(i) * (0.5f * kPi / 300.0f));
      const long double expected = factored_fresnel(c, n);
      // As MatchesMpmath; near the critical angle the cancellation in the root of n < 1 adds 2^-52 of c^2.
      const long double left = n < 1.0f ? static_cast<long double>(c) * c - (1.0l - n) * (1.0l + n) : 1.0l;
      const double critical = left > 0.0l ? double(0x1p-50l / left) : 0.0;
      EXPECT_NEAR(double(fresnel_dielectric(c, n) / expected), 1.0, kUlp + 1e-8 + critical) << c << " " << n;
      // The transmittance keeps its digits where it is small.
      if (expected < 1.0l) {
        EXPECT_NEAR(double(fresnel(c, n).transmittance / (1.0l - expected)), 1.0,
                    kUlp + 1e-8 + critical + 0x1p-50 / double(1.0l - expected))
            << c << " " << n;
      }
    }
}

TEST(Fresnel, TotalReflectionBeginsAtTheCriticalAngle) {
  for (const float n : {0.1f, 0.5f, 2.0f / 3.0f, 0.9f, 1.0f - 0x1p-20f, 1.0f - 0x1p-24f}) {
    // The floats on both sides of the critical cosine.
    const double critical = std::sqrt((1.0 - double{n}) * (1.0 + double{n}));
    float below = float(critical);
    if (double{below} >= critical)
      below = std::nextafter(below, 0.0f);
    const float above = std::nextafter(below, 1.0f);
    EXPECT_EQ(fresnel(below, n).reflectance, 1.0f) << n;
    EXPECT_EQ(fresnel(below, n).cos_t, 0.0f) << n;
    EXPECT_EQ(fresnel(below, n).transmittance, 0.0f) << n;
    EXPECT_GT(fresnel(std::nextafter(above, 1.0f), n).cos_t, 0.0f) << n;
    EXPECT_LT(fresnel(std::nextafter(above, 1.0f), n).reflectance, 1.0f) << n;
  }
}

TEST(Fresnel, TakesTheEndsOfItsRange) {
  const float infinity = std::numeric_limits<float>::infinity();
  for (float c : {0.0f, 1e-38f, 1e-6f, 0.5f, 1.0f}) {
    EXPECT_EQ(fresnel_dielectric(c, 1.0f), 0.0f);
    EXPECT_EQ(fresnel_dielectric(c, infinity), 1.0f);
    EXPECT_EQ(fresnel_dielectric(c, 0.0f), 1.0f);
    for (float eta : {1e-38f, 0.9f, 1.0f - 0x1p-24f, 1.0f + 0x1p-23f, 1.5f, 1e19f, 3e38f}) {
      const Fresnel<float> boundary = fresnel(c, eta);
      EXPECT_TRUE(boundary.reflectance >= 0.0f && boundary.reflectance <= 1.0f) << c << " " << eta;
      EXPECT_TRUE(boundary.cos_t >= 0.0f && boundary.cos_t <= 1.0f) << c << " " << eta;
    }
  }
  EXPECT_EQ(fresnel_dielectric(0.0f, 1.5f), 1.0f);
  // The cosine of a float unit vector can exceed 1 by an ulp.
  EXPECT_EQ(fresnel_dielectric(1.0f + 0x1p-23f, 1.5f), fresnel_dielectric(1.0f, 1.5f));
}

TEST(Fresnel, RefractionObeysSnell) {
  for (float eta : {0.7f, 1.0f + 0x1p-23f, 1.33f, 2.4f})
    for (float sin_i : {0.0f, 1e-3f, 0.3f, 0.65f}) {
      const glm::vec3 wo(sin_i * 0.6f, sin_i * 0.8f, std::sqrt(1.0f - sin_i * sin_i));
      const glm::vec3 wi = refract_local(wo, eta, fresnel(wo.z, eta).cos_t);
      // sin_i = eta sin_t, in the plane of incidence, on the other side. Each product, quotient and the norm has one or two
      // roundings.
      EXPECT_NEAR(wi.x * eta, -wo.x, 8.0 * kUlp * sin_i);
      EXPECT_NEAR(wi.y * eta, -wo.y, 8.0 * kUlp * sin_i);
      EXPECT_LT(wi.z, 0.0f);
      EXPECT_NEAR(glm::dot(wi, wi), 1.0f, 8.0 * kUlp);
      // The reverse direction reflects the same share; its cosine has an error of an ulp, and F changes by at most |F'| < 20
      // times it here.
      EXPECT_NEAR(fresnel_dielectric(-wi.z, 1.0f / eta), fresnel_dielectric(wo.z, eta), 40.0 * kUlp);
    }
}

TEST(Beckmann, DensityMatchesMpmath) {
  const struct {
    float tan2, alpha;
    double expected;
  } values[] = {
      {0.0f, 1.99999995e-05f, 795774755.66539861},
      {9.99999944e-11f, 1.99999995e-05f, 619750003.83882877},
      {3.99999978e-10f, 1.99999995e-05f, 292749174.26072904},
      {2.49999976e-09f, 1.99999995e-05f, 1536207.1022805054},
      {0.0f, 0.00100000005f, 318309.85594597619},
      {2.50000028e-07f, 0.00100000005f, 247900.08801812317},
      {1.00000011e-06f, 0.00100000005f, 117099.88423104079},
      {6.24999984e-06f, 0.00100000005f, 614.49072092395342},
      {0.0f, 0.00999999978f, 3183.0990041335192},
      {2.49999994e-05f, 0.00999999978f, 2479.1239365097034},
      {9.99999975e-05f, 0.00999999978f, 1171.2308711043101},
      {0.000625000044f, 0.00999999978f, 6.1525056319904514},
      {0.0f, 0.100000001f, 31.830987669741704},
      {0.00250000018f, 0.100000001f, 24.914102804796452},
      {0.0100000007f, 0.100000001f, 11.945335798837074},
      {0.0625f, 0.100000001f, 0.0693693397269039},
      {0.0f, 0.5f, 1.2732395447351627},
      {0.0625f, 0.5f, 1.1194233861090534},
      {0.25f, 0.5f, 0.73187289405398951},
      {1.5625f, 0.5f, 0.016139770496317365},
      {0.0f, 1.0f, 0.31830988618379067},
      {0.25f, 1.0f, 0.38734373221766552},
      {1.0f, 1.0f, 0.46839865219455329},
      {6.25f, 1.0f, 0.032298743575021783},
  };
  // The exponent tan^2 / alpha^2 <= 6.25 has two roundings, the prefactor six.
  for (const auto &v : values)
    EXPECT_NEAR(coating_d(v.tan2, v.alpha) / v.expected, 1.0, (2.0 * 6.25 + 6.0) * kUlp) << v.tan2 << " " << v.alpha;
}

TEST(Beckmann, MaskingMatchesMpmath) {
  const struct {
    float a;
    double walter, exact;
  } values[] = {
      {0.00100000005f, 0.0035291397510617405, 0.0035386322688633055},
      {0.00999999978f, 0.034767823878515406, 0.034828278309823886},
      {0.100000001f, 0.29944071157920044, 0.29858675009275557},
      {0.5f, 0.83125168478749214, 0.83358255480699046},
      {1.0f, 0.97659320006834102, 0.97548863292880549},
      {1.33599997f, 0.99713036589541212, 0.99402195911083016},
      {1.54999995f, 1.0, 0.99772468341587916},
      {1.59000003f, 1.0, 0.99811273010567233},
      {1.60000002f, 1.0, 0.99819951571013448},
      {2.0f, 1.0, 0.99975555408967534},
      {3.0f, 1.0, 0.9999994408278164},
      {3.9000001f, 1.0, 0.99999999946071134},
  };
  // Walter's fit: eight roundings of positive terms. The exact form: exp, erfc, and a difference that at most doubles errors.
  for (const auto &v : values) {
    EXPECT_NEAR(beckmann_g1(v.a) / v.walter, 1.0, 8.0 * kUlp) << v.a;
    EXPECT_NEAR(beckmann_g1_exact(v.a) / v.exact, 1.0, 12.0 * kUlp) << v.a;
  }
  EXPECT_EQ(beckmann_g1(0.0f), 0.0f);
  EXPECT_EQ(beckmann_g1_exact(0.0f), 0.0f);
}

TEST(Beckmann, MaskingNeverPassesOne) {
  for (float a = 0.0f; a < 5.0f; a += 1e-3f) {
    EXPECT_LE(beckmann_g1(a), 1.0f);
    EXPECT_LE(beckmann_g1_exact(a), 1.0f);
    // Walter states 0.35 % for the fit.
    EXPECT_NEAR(beckmann_g1(a), beckmann_g1_exact(a), 0.0035f * beckmann_g1_exact(a));
  }
}

TEST(Coating, MatchesMpmath) {
  const struct {
    float alpha, ior;
    glm::vec3 wo, wi;
    double expected;
  } values[] = {
      {0.699999988f,
       1.5f,
       {0.0384887196f, 0.434187323f, 0.899999976f},
       {-0.421879888f, -0.724364161f, 0.545264959f},
       0.0145039174650337},
      {0.699999988f,
       1.5f,
       {0.378613681f, -0.215989977f, 0.899999976f},
       {-0.573515177f, 0.815238655f, 0.0804129317f},
       0.044029168100643},
      {0.699999988f,
       1.5f,
       {0.174170151f, 0.973223925f, 0.150000006f},
       {-0.0707778856f, -0.949150741f, 0.306762785f},
       0.434114395271771},
      {0.300000012f,
       1.29999995f,
       {0.203779489f, 0.385323137f, 0.899999976f},
       {-0.308594942f, -0.46782434f, 0.828196526f},
       0.020168761385965},
      {0.300000012f,
       2.4000001f,
       {0.134806901f, -0.414520323f, 0.899999976f},
       {-0.206855088f, 0.220772862f, 0.9531371f},
       0.156330571526399},
      {0.100000001f,
       1.5f,
       {0.31700778f, -0.29917565f, 0.899999976f},
       {-0.427307636f, 0.232368454f, 0.87373513f},
       0.247120610244521},
      {0.100000001f,
       1.5f,
       {-0.468877286f, -0.870433271f, 0.150000006f},
       {0.474816293f, 0.87064594f, 0.128549948f},
       182.20889804713},
      {0.100000001f,
       0.899999976f,
       {-0.429792315f, 0.0726537481f, 0.899999976f},
       {0.254155576f, -0.183037028f, 0.949685395f},
       0.00774637294989819},
      {0.100000001f,
       0.899999976f,
       {0.65404135f, -0.741437733f, 0.150000006f},
       {-0.642709792f, 0.744912982f, 0.178965896f},
       260.987628429333},
      {0.0199999996f,
       1.5f,
       {0.365681648f, -0.237227604f, 0.899999976f},
       {-0.331241846f, 0.253986031f, 0.908718824f},
       3.23108278867856},
      {0.0199999996f,
       1.5f,
       {0.569079757f, -0.80848515f, 0.150000006f},
       {-0.565999627f, 0.808642328f, 0.160443261f},
       2755.3213832107},
      {0.00100000005f,
       1.5f,
       {-0.354868323f, -0.253117502f, 0.899999976f},
       {0.355184376f, 0.252970785f, 0.89991653f},
       3860.56343614581},
      {0.00100000005f,
       1.5f,
       {-0.334653616f, 0.930326283f, 0.150000006f},
       {0.334647685f, -0.930311859f, 0.150102496f},
       1544537.67590185},
      {0.5f,
       1.00000012f,
       {0.417576194f, 0.125020459f, 0.899999976f},
       {-0.195879728f, 0.0995732993f, 0.975559473f},
       1.22974495865311e-15},
  };
  for (const auto &v : values) {
    std::vector<LobeInputs<float>> lobes{testing::described(LobeKind::Beckmann, v.alpha, v.ior)};
    // wo + wi rounds by an ulp of 1 or less, which at the slope s <= 1.2 alpha moves exp(-s^2 / alpha^2) by 2 s / alpha times
    // the error over alpha. Fresnel's slope at eta near 1 and the other factors stay within 42 roundings.
    const double tolerance = (42.0 + 2.4 * 2.0 / v.alpha) * kUlp;
    EXPECT_NEAR(testing::seen(lobes, v.wo).eval(v.wi).f().x / v.wi.z / v.expected, 1.0, tolerance) << v.alpha << " " << v.ior;
    // Kd/pi + Ks D F G / (4 (l.n)(v.n)), channel by channel.
    lobes[0].color = glm::vec3(0.5f, 0.25f, 0.0f);
    lobes.push_back(testing::described(LobeKind::Lambert, 0, 1, 0, {0.75f, 0.0f, 0.5f}));
    const glm::vec3 f = testing::seen(lobes, v.wo).eval(v.wi).f() / v.wi.z;
    const glm::dvec3 sum = glm::dvec3(0.5, 0.25, 0.0) * v.expected + glm::dvec3(0.75, 0.0, 0.5) / std::numbers::pi;
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(f[c], sum[c], tolerance * sum[c]);
  }
}

} // namespace
} // namespace lancer
