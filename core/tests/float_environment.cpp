// Another rounding mode or flushed subnormals, set by other code in the process, do not change pictures.
#include "bits_stand.h"

#include <cfenv>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace lancer_test {
namespace {

class OtherFloats {
public:
  OtherFloats() {
    std::fegetenv(&saved_);
    std::fesetround(FE_UPWARD);
#if defined(__SSE2__)
    _mm_setcsr(_mm_getcsr() | 0x8040);
#elif defined(__aarch64__)
    uint64_t control;
    asm volatile("mrs %0, fpcr" : "=r"(control));
    asm volatile("msr fpcr, %0" : : "r"(control | 1ull << 24));
#endif
  }
  ~OtherFloats() { std::fesetenv(&saved_); }
  OtherFloats(const OtherFloats &) = delete;
  OtherFloats &operator=(const OtherFloats &) = delete;

private:
  std::fenv_t saved_;
};

uint64_t picture(bool otherwise) {
  Stand stand;
  stand.floor();
  for (int i = 0; i < 4; ++i)
    tilt(stand.place(LANCER_CYLINDER, stand.material({newest(LANCER_GLASS, 0.75f, 0.25f * float(i))}), i - 1.5, 0.5, 1.0, 0.5)
             .matrix);
  stand.add(point_light());
  stand.sky(0.25f, 0.5f, 0.75f);
  if (otherwise) {
    const OtherFloats floats;
    stand.commit();
    stand.render();
    // The caller's mode is kept.
    EXPECT_EQ(std::fegetround(), FE_UPWARD);
  } else {
    stand.commit();
    stand.render();
  }
  return stand.hash.value();
}

TEST(FloatEnvironment, OfTheCallerChangesNoPicture) { EXPECT_EQ(picture(true), picture(false)); }

} // namespace
} // namespace lancer_test
