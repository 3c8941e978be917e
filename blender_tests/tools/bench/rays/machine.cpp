// machine: the limits of this processor, as JSON: its clock, and the latency and bandwidth of its caches and memory.
#include "work.h"

#include <numeric>
#include <random>

namespace {

// Passes take about a millisecond, so that some run without interruption.
constexpr int kPasses = 100;

// Returns the least seconds of several passes: disturbances only make a pass slower.
template <class Pass> double least(Pass &&pass) {
  double best = 1e30;
  for (int i = 0; i < kPasses; ++i) {
    const double started = now();
    pass();
    best = std::min(best, now() - started);
  }
  return best;
}

// Dependent additions take one cycle each.
double clock_rate() {
  constexpr uint64_t count = 2'000'000;
  const double seconds = least([] {
    uint64_t x = 1;
    for (uint64_t i = 0; i < count / 8; ++i)
      asm volatile("add %0, %0\n add %0, %0\n add %0, %0\n add %0, %0\n"
                   "add %0, %0\n add %0, %0\n add %0, %0\n add %0, %0\n"
                   : "+r"(x));
  });
  return double(count) / seconds;
}

// Returns the seconds per load from random places in this many bytes, where each load gives the address of the next.
double latency(size_t bytes) {
  constexpr size_t line = 64 / sizeof(uint32_t);
  const size_t lines = bytes / 64;
  std::vector<uint32_t> order(lines), chain(lines * line);
  std::iota(order.begin(), order.end(), 0u);
  std::shuffle(order.begin(), order.end(), std::mt19937(1));
  // One cycle through all cache lines.
  for (size_t i = 0; i < lines; ++i)
    chain[order[i] * line] = uint32_t(order[(i + 1) % lines] * line);
  constexpr size_t count = 20'000;
  uint32_t at = 0;
  const double seconds = least([&] {
    for (size_t i = 0; i < count; ++i)
      at = chain[at];
    asm volatile("" : : "r"(at));
  });
  return seconds / count;
}

// Returns the bytes per second that all threads read together; each reads its own array of this many bytes repeatedly.
double bandwidth(size_t bytes, unsigned threads) {
  const size_t words = bytes / sizeof(uint64_t);
  const size_t rounds = std::max<size_t>(1, (size_t(1) << 23) / bytes);
  std::vector<std::vector<uint64_t>> memory(threads, std::vector<uint64_t>(words, 1));
  const int passes = rounds > 1 ? kPasses : 5;
  double best = 1e30;
  for (int pass = 0; pass < passes; ++pass)
    best = std::min(best, timed(threads, threads, 1, [&](size_t first, size_t) {
                      const uint64_t *const values = memory[first].data();
                      for (size_t round = 0; round < rounds; ++round) {
                        uint64_t sums[8] = {};
                        for (size_t i = 0; i + 8 <= words; i += 8)
                          for (size_t k = 0; k < 8; ++k)
                            sums[k] += values[i + k];
                        asm volatile("" : : "r"(sums) : "memory");
                      }
                    }));
  return double(threads) * double(rounds) * double(bytes) / best;
}

} // namespace

int main(int count, char **words) {
  const unsigned threads = count > 1 ? unsigned(std::atoi(words[1])) : 1;
  std::printf("{\"clock\": %g", clock_rate());
  // Well inside the first and second cache, and well beyond the second; a shared third cache may have any size.
  const std::pair<const char *, size_t> sizes[] = {
      {"l1", size_t(16) << 10}, {"l2", size_t(512) << 10}, {"l3", size_t(12) << 20}, {"memory", size_t(128) << 20}};
  for (const auto &[name, bytes] : sizes)
    std::printf(", \"%s\": {\"bytes\": %zu, \"latency\": %g, \"bandwidth\": %g}", name, bytes, latency(bytes),
                bandwidth(bytes, threads));
  std::printf("}\n");
  return 0;
}
