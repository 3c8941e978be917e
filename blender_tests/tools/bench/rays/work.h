// Code that both drivers share: the file of triangles and rays, threads that take batches, clocks, and the answer as JSON.
//
// File, little-endian: uint32 vertices, triangles, sets; float positions[vertices][3]; uint32 corners[triangles][3];
// and for each set uint32 count, any (1: any hit, 0: the closest hit), char name[16],
// float origin[3], direction[3], tmax for each ray. Rays start at t = 0.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

struct FileRay {
  float o[3], d[3], tmax;
};

struct RaySet {
  std::string name;
  bool any = false;
  std::vector<FileRay> rays;
};

struct Work {
  std::vector<float> positions;
  std::vector<uint32_t> corners;
  std::vector<RaySet> sets;
};

[[noreturn]] inline void fail(const std::string &text) {
  std::fprintf(stderr, "%s\n", text.c_str());
  std::exit(1);
}

template <class T> void read_into(std::FILE *file, T *values, size_t count) {
  if (count && std::fread(values, sizeof(T), count, file) != count)
    fail("the file of rays is cut short");
}

inline Work load_work(const char *path) {
  std::FILE *file = std::fopen(path, "rb");
  if (!file)
    fail(std::string("cannot open ") + path);
  uint32_t counts[3];
  read_into(file, counts, 3);
  Work work;
  work.positions.resize(3 * size_t(counts[0]));
  read_into(file, work.positions.data(), work.positions.size());
  work.corners.resize(3 * size_t(counts[1]));
  read_into(file, work.corners.data(), work.corners.size());
  for (uint32_t i = 0; i < counts[2]; ++i) {
    uint32_t head[2];
    char name[17] = {};
    read_into(file, head, 2);
    read_into(file, name, 16);
    RaySet set{name, head[1] != 0, std::vector<FileRay>(head[0])};
    read_into(file, set.rays.data(), set.rays.size());
    work.sets.push_back(std::move(set));
  }
  std::fclose(file);
  return work;
}

inline double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

// Returns the seconds that threads take for items 0 ... count - 1, in batches: what(first, end). All start together.
template <class What> double timed(unsigned threads, size_t count, size_t batch, What &&what) {
  std::atomic<size_t> next{0};
  std::atomic<unsigned> ready{0};
  std::atomic<bool> go{false};
  const auto run = [&] {
    ready.fetch_add(1);
    while (!go.load())
      std::this_thread::yield();
    for (size_t first; (first = next.fetch_add(batch)) < count;)
      what(first, std::min(count, first + batch));
  };
  std::vector<std::thread> crew;
  for (unsigned i = 0; i < threads; ++i)
    crew.emplace_back(run);
  while (ready.load() < threads)
    std::this_thread::yield();
  const double started = now();
  go.store(true);
  for (std::thread &thread : crew)
    thread.join();
  return now() - started;
}

// Returns the rays per second of the fastest of several passes: disturbances only make a pass slower.
template <class Pass> double best_rate(size_t rays, int passes, Pass &&pass) {
  double best = pass();
  for (int i = 1; i < passes; ++i)
    best = std::min(best, double(pass()));
  return double(rays) / best;
}
