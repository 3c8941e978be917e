// embree.cpp LIBRARY WORK THREADS PASSES: Embree on a file of rays, one by one and in packets, fast and robust, as JSON.
//
// The package of the library has no headers: this file declares the part of its interface, version 4, that it uses.
#include "work.h"

#include <dlfcn.h>

namespace {

struct Arguments {
  uint32_t flags = 0, features = 0xffffffff;
  void *context = nullptr, *filter = nullptr, *function = nullptr;
};
constexpr uint32_t kCoherent = 1u << 16;

// Rays and hits of a packet of N, each field an array of N. Hits have their last field since instances have arrays.
template <int N> struct alignas(N == 1 ? 16 : 4 * N) Rays {
  float ox[N], oy[N], oz[N], tnear[N], dx[N], dy[N], dz[N], time[N], tfar[N];
  uint32_t mask[N], id[N], flags[N];
};
template <int N> struct alignas(N == 1 ? 16 : 4 * N) RaysAndHits {
  Rays<N> ray;
  float nx[N], ny[N], nz[N], u[N], v[N];
  uint32_t primitive[N], geometry[N], instance[N], instance_primitive[N];
};

using Handle = void *;
struct Api {
  void *library;
  explicit Api(const char *path) : library(dlopen(path, RTLD_NOW | RTLD_LOCAL)) {
    if (!library)
      fail(dlerror());
  }
  template <class Function> Function *get(const char *name) const {
    void *found = dlsym(library, name);
    if (!found)
      fail(std::string("Embree has no ") + name);
    return reinterpret_cast<Function *>(found);
  }
};

template <int N> Rays<N> packet_of(const RaySet &set, size_t first, size_t end, int *valid) {
  Rays<N> result;
  for (int i = 0; i < N; ++i) {
    const FileRay &ray = set.rays[std::min(first + i, end - 1)];
    valid[i] = first + i < end ? -1 : 0;
    result.ox[i] = ray.o[0], result.oy[i] = ray.o[1], result.oz[i] = ray.o[2];
    result.dx[i] = ray.d[0], result.dy[i] = ray.d[1], result.dz[i] = ray.d[2];
    result.tnear[i] = 0.0f, result.tfar[i] = ray.tmax, result.time[i] = 0.0f;
    result.mask[i] = ~0u, result.id[i] = 0, result.flags[i] = 0;
  }
  return result;
}

struct Measured {
  double rate;
  size_t hits;
};

template <int N>
Measured measure(const Api &api, Handle scene, const RaySet &set, unsigned threads, int passes, bool coherent) {
  const std::string suffix = std::to_string(N);
  std::atomic<size_t> hits{0};
  const auto pass = [&](auto &&ask) {
    return best_rate(set.rays.size(), passes, [&] {
      hits = 0;
      return timed(threads, set.rays.size(), 1024, [&](size_t first, size_t end) {
        size_t found = 0;
        for (size_t i = first; i < end; i += N)
          found += ask(i, end);
        hits.fetch_add(found);
      });
    });
  };
  Arguments arguments;
  arguments.flags = coherent ? kCoherent : 0;
  double rate = 0.0;
  if (set.any) {
    using One = void(Handle, Rays<N> *, Arguments *);
    using Many = void(const int *, Handle, Rays<N> *, Arguments *);
    void *const function = reinterpret_cast<void *>(api.get<void()>(("rtcOccluded" + suffix).c_str()));
    rate = pass([&](size_t first, size_t end) {
      alignas(64) int valid[N];
      Rays<N> rays = packet_of<N>(set, first, end, valid);
      if constexpr (N == 1)
        reinterpret_cast<One *>(function)(scene, &rays, &arguments);
      else
        reinterpret_cast<Many *>(function)(valid, scene, &rays, &arguments);
      size_t found = 0;
      for (int i = 0; i < N; ++i)
        found += valid[i] && rays.tfar[i] < 0.0f;
      return found;
    });
  } else {
    using One = void(Handle, RaysAndHits<N> *, Arguments *);
    using Many = void(const int *, Handle, RaysAndHits<N> *, Arguments *);
    void *const function = reinterpret_cast<void *>(api.get<void()>(("rtcIntersect" + suffix).c_str()));
    rate = pass([&](size_t first, size_t end) {
      alignas(64) int valid[N];
      RaysAndHits<N> both;
      both.ray = packet_of<N>(set, first, end, valid);
      for (int i = 0; i < N; ++i)
        both.geometry[i] = both.instance[i] = ~0u;
      if constexpr (N == 1)
        reinterpret_cast<One *>(function)(scene, &both, &arguments);
      else
        reinterpret_cast<Many *>(function)(valid, scene, &both, &arguments);
      size_t found = 0;
      for (int i = 0; i < N; ++i)
        found += valid[i] && both.geometry[i] != ~0u;
      return found;
    });
  }
  return {rate, hits.load()};
}

void measure_sets(const Api &api, Handle scene, const Work &work, unsigned threads, int passes) {
  const char *separator = "";
  for (const RaySet &set : work.sets) {
    const Measured one = measure<1>(api, scene, set, threads, passes, false);
    const Measured four = measure<4>(api, scene, set, threads, passes, false);
    const Measured eight = measure<8>(api, scene, set, threads, passes, false);
    const Measured sixteen = measure<16>(api, scene, set, threads, passes, false);
    const Measured coherent = measure<16>(api, scene, set, threads, passes, true);
    std::printf("%s\"%s\": {\"single\": %g, \"4\": %g, \"8\": %g, \"16\": %g, \"16 coherent\": %g, \"hits\": %zu}", separator,
                set.name.c_str(), one.rate, four.rate, eight.rate, sixteen.rate, coherent.rate, one.hits);
    separator = ", ";
  }
}

} // namespace

int main(int count, char **words) {
  if (count != 5)
    fail("usage: embree LIBRARY WORK THREADS PASSES");
  const Api api(words[1]);
  const Work work = load_work(words[2]);
  const unsigned threads = unsigned(std::atoi(words[3]));
  const int passes = std::atoi(words[4]);

  const std::string settings = "threads=" + std::to_string(threads);
  Handle device = api.get<Handle(const char *)>("rtcNewDevice")(settings.c_str());
  if (!device)
    fail("Embree gives no device");
  const long version = api.get<long(Handle, int)>("rtcGetDeviceProperty")(device, 0);
  std::printf("{\"version\": \"%ld.%ld.%ld\"", version / 10000, version / 100 % 100, version % 100);
  for (const bool robust : {false, true}) {
    // Triangles, with indices of three uint32 and vertices of three floats; medium build quality.
    Handle scene = api.get<Handle(Handle)>("rtcNewScene")(device);
    api.get<void(Handle, int)>("rtcSetSceneFlags")(scene, robust ? 1 << 2 : 0);
    api.get<void(Handle, int)>("rtcSetSceneBuildQuality")(scene, 1);
    Handle geometry = api.get<Handle(Handle, int)>("rtcNewGeometry")(device, 0);
    const auto buffer = api.get<void *(Handle, int, unsigned, int, size_t, size_t)>("rtcSetNewGeometryBuffer");
    const double started = now();
    std::memcpy(buffer(geometry, 0, 0, 0x5003, 12, work.corners.size() / 3), work.corners.data(), 4 * work.corners.size());
    std::memcpy(buffer(geometry, 1, 0, 0x9003, 12, work.positions.size() / 3), work.positions.data(),
                4 * work.positions.size());
    api.get<void(Handle)>("rtcCommitGeometry")(geometry);
    api.get<unsigned(Handle, Handle)>("rtcAttachGeometry")(scene, geometry);
    api.get<void(Handle)>("rtcCommitScene")(scene);
    std::printf(", \"%s\": {\"build_seconds\": %g%s", robust ? "robust" : "fast", now() - started,
                work.sets.empty() ? "" : ", ");
    measure_sets(api, scene, work, threads, passes);
    std::printf("}");
    api.get<void(Handle)>("rtcReleaseGeometry")(geometry);
    api.get<void(Handle)>("rtcReleaseScene")(scene);
  }
  std::printf("}\n");
  return 0;
}
