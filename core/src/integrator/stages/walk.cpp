#include "integrator/stages/walk.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace lancer {

namespace {

// Walks on their way at a time: enough for batches of rays, few enough for the cache.
constexpr size_t kBlocks = 16;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

} // namespace

const WalkKernel &walk_kernel() { return LANCER_CHOSEN_SHADING_KERNEL(walk_kernel); }

WalkStage::WalkStage(const Scene &scene) : kernel_(walk_kernel()), own_(scene), profile_(scene) {}

// lane: over all blocks.
void WalkStage::load(const Walk &walk, size_t number, uint32_t lane) {
  walk_of_[lane] = number;
  WalkBlock &block = blocks_[lane / kBlockLanes];
  const uint32_t at = lane % kBlockLanes;
  put(walk.ray.o, block.p, at);
  put(glm::vec3(walk.ray.d), block.d, at);
  put(walk.n, block.n, at);
  put(walk.beta, block.beta, at);
  put(walk.color, block.color, at);
  put(walk.radius, block.radius, at);
  block.g[at] = walk.g;
  block.method[at] = uint32_t(walk.method);
  block.u_channel[at] = walk.u_channel;
  block.u_distance[at] = walk.u_distance;
  block.key[at] = walk.key;
}

// Fills the free lanes with the next walks.
void WalkStage::fill(std::span<const Walk> walks, size_t &next) {
  for (size_t number = 0; number < blocks_.size() && next < at_random_.size(); ++number) {
    WalkBlock &block = blocks_[number];
    uint32_t fresh = 0;
    for (uint32_t lane = 0; lane < kBlockLanes && next < at_random_.size(); ++lane)
      if (!(block.walking >> lane & 1)) {
        load(walks[at_random_[next]], at_random_[next], uint32_t(number * kBlockLanes + lane));
        fresh |= 1u << lane;
        ++next;
      }
    if (fresh != 0)
      kernel_.begin(block, fresh);
    block.walking |= fresh;
  }
}

namespace {

void move_lane(WalkBlock &block, uint32_t to, const WalkBlock &other, uint32_t from) {
  for (int axis = 0; axis < 3; ++axis) {
    block.p[axis][to] = other.p[axis][from];
    for (const auto member :
         {&WalkBlock::d, &WalkBlock::n, &WalkBlock::sigma_t, &WalkBlock::sigma_s, &WalkBlock::light, &WalkBlock::densities})
      (block.*member)[axis][to] = (other.*member)[axis][from];
  }
  for (const auto member :
       {&WalkBlock::depth, &WalkBlock::g, &WalkBlock::guided, &WalkBlock::length, &WalkBlock::log_length, &WalkBlock::opposite})
    (block.*member)[to] = (other.*member)[from];
  for (const auto member : {&WalkBlock::hero, &WalkBlock::key, &WalkBlock::steps})
    (block.*member)[to] = (other.*member)[from];
}

} // namespace

// Moves the walks of the last blocks into free lanes of the first ones, so that few blocks are left at the end. The numbers of
// a walk do not depend on its lane.
void WalkStage::close_ranks() {
  size_t last = blocks_.size();
  for (size_t first = 0; first < last; ++first) {
    WalkBlock &block = blocks_[first];
    for (uint32_t lane = 0; lane < kBlockLanes; ++lane) {
      if (block.walking >> lane & 1)
        continue;
      while (last > first + 1 && blocks_[last - 1].walking == 0)
        --last;
      if (last == first + 1)
        return;
      WalkBlock &other = blocks_[last - 1];
      const auto from = uint32_t(std::countr_zero(other.walking));
      move_lane(block, lane, other, from);
      walk_of_[first * kBlockLanes + lane] = walk_of_[(last - 1) * kBlockLanes + from];
      other.walking &= other.walking - 1;
      block.walking |= 1u << lane;
    }
  }
}

// Finds the surfaces on the ways of all walking lanes.
void WalkStage::look(std::span<const Walk> walks) {
  rays_.clear();
  lane_of_.clear();
  instance_of_.clear();
  for (size_t number = 0; number < blocks_.size(); ++number) {
    const WalkBlock &block = blocks_[number];
    each_lane(block.walking, [&](uint32_t lane) {
      const Walk &walk = walks[walk_of_[number * kBlockLanes + lane]];
      Ray &ray = rays_.emplace_back();
      ray.o = get(block.p, lane);
      ray.d = glm::dvec3(get(block.d, lane));
      ray.tmax = double(block.reach[lane]);
      // The first ray starts on the surface, the others within the object.
      if (block.steps[lane] == 0) {
        ray.skip_instance = walk.ray.skip_instance;
        ray.skip_primitive = walk.ray.skip_primitive;
      }
      lane_of_.push_back(uint32_t(number * kBlockLanes + lane));
      instance_of_.push_back(walk.instance);
    });
  }
  hits_.assign(rays_.size(), {});
  own_.closest(rays_, instance_of_, hits_);
  for (size_t i = 0; i < rays_.size(); ++i)
    blocks_[lane_of_[i] / kBlockLanes].met[lane_of_[i] % kBlockLanes] = hits_[i].valid() ? hits_[i].t : kInfinite;
}

uint64_t WalkStage::walk(std::span<Walk> walks) {
  by_profile_.clear();
  at_random_.clear();
  for (size_t number = 0; number < walks.size(); ++number)
    (walks[number].method == SubsurfaceMethod::Burley ? by_profile_ : at_random_).push_back(number);
  uint64_t count = profile_.leave(walks, by_profile_);
  blocks_.resize(std::min(kBlocks, (at_random_.size() + kBlockLanes - 1) / kBlockLanes));
  walk_of_.resize(blocks_.size() * kBlockLanes);
  for (WalkBlock &block : blocks_)
    block.walking = 0;
  for (size_t next = 0;;) {
    if (next < at_random_.size())
      fill(walks, next);
    else
      close_ranks();
    for (WalkBlock &block : blocks_)
      if (block.walking != 0)
        kernel_.step(block);
    look(walks);
    if (rays_.empty())
      return count;
    count += rays_.size();
    for (WalkBlock &block : blocks_) {
      block.left = 0;
      if (block.walking != 0)
        kernel_.advance(block);
    }
    // End the walks that have reached the surface: the path meets it as if it came from outside.
    for (size_t i = 0; i < rays_.size(); ++i) {
      const WalkBlock &block = blocks_[lane_of_[i] / kBlockLanes];
      const uint32_t lane = lane_of_[i] % kBlockLanes;
      if (!(block.left >> lane & 1))
        continue;
      Walk &walk = walks[walk_of_[lane_of_[i]]];
      walk.hit = hits_[i];
      walk.beta = get(block.throughput, lane);
      walk.ray = rays_[i];
      walk.ray.o += 2.0 * walk.hit.t * walk.ray.d;
      walk.ray.d = -walk.ray.d;
    }
  }
}

} // namespace lancer
