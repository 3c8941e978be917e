#include "render/matte_sums.h"

#include "lancer.h"
#include "sampling/sobol.h"

#include <algorithm>
#include <numeric>

namespace lancer {

MattesBySample::MattesBySample(std::span<const MatteShare> mattes, size_t samples)
    : ends_(samples + 1, 0), sorted_(mattes.size()) {
  for (const MatteShare &matte : mattes)
    ++ends_[matte.sample + 1];
  std::partial_sum(ends_.begin(), ends_.end(), ends_.begin());
  std::vector<uint32_t> next(ends_.begin(), ends_.end() - 1);
  for (const MatteShare &matte : mattes)
    sorted_[next[matte.sample]++] = matte;
}

void MatteSums::gather(const MattesBySample &mattes, uint32_t kind, size_t first, uint32_t pixels) {
  ends.resize(pixels);
  ids.clear();
  shares.clear();
  ids.reserve(pixels);
  shares.reserve(pixels);
  for (uint32_t pixel = 0; pixel < pixels; ++pixel) {
    const auto begin = ptrdiff_t(ids.size());
    const std::span<const MatteShare> met = mattes.of(first + pixel);
    for (const MatteShare &matte : met) {
      const uint32_t id = matte.ids[kind];
      if (id == 0)
        continue;
      // Most samples meet one surface.
      if (met.size() == 1) {
        ids.push_back(id);
        shares.push_back(double(matte.share));
        break;
      }
      const auto at = std::lower_bound(ids.begin() + begin, ids.end(), id);
      const auto share = shares.begin() + (at - ids.begin());
      if (at != ids.end() && *at == id) {
        *share += double(matte.share);
      } else {
        shares.insert(share, double(matte.share));
        ids.insert(at, id);
      }
    }
    if (met.size() > LANCER_MOST_MATTES)
      limit(size_t(begin), 0);
    ends[pixel] = uint32_t(ids.size());
  }
}

void MatteSums::join(const MatteSums &earlier, uint32_t key) {
  // Mostly, samples of a tile see the same surfaces.
  if (earlier.ends == ends && earlier.ids == ids) {
    for (size_t i = 0; i < shares.size(); ++i)
      shares[i] = earlier.shares[i] + shares[i];
    return;
  }
  MatteSums sum;
  sum.ends.reserve(ends.size());
  sum.ids.reserve(std::max(ids.size(), earlier.ids.size()) + 16);
  sum.shares.reserve(sum.ids.capacity());
  for (uint32_t pixel = 0; pixel < ends.size(); ++pixel) {
    const size_t begin = sum.ids.size();
    uint32_t a = earlier.begin(pixel), b = this->begin(pixel);
    const uint32_t a_end = earlier.ends[pixel], b_end = ends[pixel];
    while (a < a_end || b < b_end) {
      const bool of_a = b == b_end || (a < a_end && earlier.ids[a] <= ids[b]);
      const bool of_b = a == a_end || (b < b_end && ids[b] <= earlier.ids[a]);
      sum.ids.push_back(of_a ? earlier.ids[a] : ids[b]);
      sum.shares.push_back(of_a && of_b ? earlier.shares[a] + shares[b] : of_a ? earlier.shares[a] : shares[b]);
      a += of_a;
      b += of_b;
    }
    sum.limit(begin, key);
    sum.ends.push_back(uint32_t(sum.ids.size()));
  }
  *this = std::move(sum);
}

uint32_t MatteSums::append(const MatteSums &from, uint32_t pixel) {
  const auto begin = ptrdiff_t(from.begin(pixel)), end = ptrdiff_t(from.ends[pixel]);
  ids.insert(ids.end(), from.ids.begin() + begin, from.ids.begin() + end);
  shares.insert(shares.end(), from.shares.begin() + begin, from.shares.begin() + end);
  return uint32_t(end - begin);
}

// Removes the mattes of the last pixel, which begins there, beyond the limit.
void MatteSums::limit(size_t begin, uint32_t key) {
  const size_t count = ids.size() - begin;
  if (count <= LANCER_MOST_MATTES)
    return;
  std::vector<size_t> order(count);
  std::iota(order.begin(), order.end(), begin);
  std::ranges::sort(order, [&](size_t a, size_t b) {
    return shares[a] != shares[b] ? shares[a] > shares[b] : hash_combine(key, ids[a]) < hash_combine(key, ids[b]);
  });
  order.resize(LANCER_MOST_MATTES);
  std::ranges::sort(order);
  for (size_t i = 0; i < order.size(); ++i) {
    ids[begin + i] = ids[order[i]];
    shares[begin + i] = shares[order[i]];
  }
  ids.resize(begin + order.size());
  shares.resize(begin + order.size());
}

} // namespace lancer
