#include "render/processors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <thread>

#if defined(__linux__)
#include <cerrno>
#include <sched.h>
#endif

namespace lancer {

namespace {

#if defined(__linux__)
using File = std::unique_ptr<std::FILE, decltype(&std::fclose)>;

File open(const std::string &path) { return {std::fopen(path.c_str(), "r"), &std::fclose}; }

// The numbers at the start of a file; 0 for those that are not there, as where it says "max".
std::array<double, 2> numbers(const std::string &path) {
  std::array<double, 2> found{};
  if (const File file = open(path))
    if (std::fscanf(file.get(), "%lf %lf", &found[0], &found[1]) < 1)
      return {};
  return found;
}

// Quota over period of one group; infinity where it has no limit.
double quota(const std::string &folder) {
  // Version 2: "max 100000" or "150000 100000".
  auto [time, period] = numbers(folder + "/cpu.max");
  if (time == 0.0) {
    // Version 1, where -1 is no limit.
    time = numbers(folder + "/cpu.cfs_quota_us")[0];
    period = numbers(folder + "/cpu.cfs_period_us")[0];
  }
  return time > 0.0 && period > 0.0 ? time / period : std::numeric_limits<double>::infinity();
}

// The least quota of a group and of those that hold it. Inside a container the path may be that of the host, of which the
// container sees the end as its root.
double quota_of_all(const std::string &mount, std::string path) {
  double least = quota(mount);
  while (path.size() > 1) {
    least = std::min(least, quota(mount + path));
    path.resize(path.rfind('/'));
  }
  return least;
}

// The least quota of the groups that hold this process, by the kernel's lines "number:controllers:path".
double quota_of_process(const std::string &root) {
  double least = std::numeric_limits<double>::infinity();
  const File file = open(root + "/proc/self/cgroup");
  std::array<char, 4096> text{};
  while (file && std::fgets(text.data(), int(text.size()), file.get())) {
    const std::string line(text.data(), std::strcspn(text.data(), "\n"));
    const size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos)
      continue;
    const std::string controllers = line.substr(first + 1, second - first - 1), path = line.substr(second + 1);
    if (path.empty() || path[0] != '/')
      continue;
    const std::string mounts = root + "/sys/fs/cgroup";
    if (controllers.empty())
      least = std::min(least, quota_of_all(mounts, path));
    else if (("," + controllers + ",").find(",cpu,") != std::string::npos)
      least = std::min({least, quota_of_all(mounts + "/" + controllers, path), quota_of_all(mounts + "/cpu", path)});
  }
  return least;
}

// Processors that the calling thread may run on; 0 where the kernel does not tell.
uint32_t allowed_processors() {
  for (int room = 1024; room <= 1 << 20; room *= 4) {
    cpu_set_t *const set = CPU_ALLOC(size_t(room));
    if (!set)
      return 0;
    const size_t size = CPU_ALLOC_SIZE(size_t(room));
    const bool known = sched_getaffinity(0, size, set) == 0;
    const int error = errno;
    const int count = known ? CPU_COUNT_S(size, set) : 0;
    CPU_FREE(set);
    if (known)
      return uint32_t(count);
    // More processors than there was room for.
    if (error != EINVAL)
      return 0;
  }
  return 0;
}
#endif

} // namespace

uint32_t usable_processors([[maybe_unused]] const std::string &root) {
  uint32_t count = std::max(1u, std::thread::hardware_concurrency());
#if defined(__linux__)
  if (const uint32_t allowed = allowed_processors())
    count = allowed;
  const double least = quota_of_process(root);
  // Half a processor more is a thread more, which waits half of the time.
  if (least < count)
    count = std::max(1u, uint32_t(std::ceil(least)));
#endif
  return count;
}

} // namespace lancer
