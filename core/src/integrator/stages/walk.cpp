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

namespace {

void move_lane(WalkBlock &block, uint32_t to, const WalkBlock &other, uint32_t from) {
  for (int axis = 0; axis < 3; ++axis) {
    block.p[axis][to] = other.p[axis][from];
    for (const auto member :
         {&WalkBlock::d, &WalkBlock::n, &WalkBlock::sigma_t, &WalkBlock::sigma_s, &WalkBlock::light, &WalkBlock::densities})
      (block.*member)[axis][to] = (other.*member)[axis][from];
  }
  for (const auto member : {&WalkBlock::depth, &WalkBlock::g, &WalkBlock::guided, &WalkBlock::length, &WalkBlock::log_length,
                            &WalkBlock::opposite, &WalkBlock::u_distance})
    (block.*member)[to] = (other.*member)[from];
  for (const auto member : {&WalkBlock::hero, &WalkBlock::key, &WalkBlock::steps})
    (block.*member)[to] = (other.*member)[from];
}

} // namespace

// Writes a walk into a lane of the waiting block.
void WalkStage::load(const Walk &walk, uint32_t lane) {
  put(walk.ray.o, waiting_.p, lane);
  put(glm::vec3(walk.ray.d), waiting_.d, lane);
  put(walk.n, waiting_.n, lane);
  put(walk.beta, waiting_.beta, lane);
  put(walk.color, waiting_.color, lane);
  put(walk.radius, waiting_.radius, lane);
  waiting_.ior[lane] = walk.ior;
  waiting_.g[lane] = walk.g;
  waiting_.method[lane] = uint32_t(walk.method);
  waiting_.u_channel[lane] = walk.u_channel;
  waiting_.u_distance[lane] = walk.u_distance;
  waiting_.key[lane] = walk.key;
}

// Begins the next walks, as many as a block holds.
void WalkStage::begin_some(std::span<const Walk> walks) {
  waiting_.walking = 0;
  for (first_waiting_ = kBlockLanes; first_waiting_ > 0 && next_ < at_random_.size(); ++next_) {
    load(walks[at_random_[next_]], --first_waiting_);
    waiting_walks_[first_waiting_] = at_random_[next_];
    waiting_.walking |= 1u << first_waiting_;
  }
  kernel_.begin(waiting_);
}

// Fills the free lanes with the next walks.
void WalkStage::fill(std::span<const Walk> walks) {
  for (size_t number = 0; number < blocks_.size(); ++number)
    for (uint32_t lane = 0; lane < kBlockLanes; ++lane) {
      if (blocks_[number].walking >> lane & 1)
        continue;
      if (first_waiting_ == kBlockLanes) {
        if (next_ == at_random_.size())
          return;
        begin_some(walks);
      }
      move_lane(blocks_[number], lane, waiting_, first_waiting_);
      walk_of_[number * kBlockLanes + lane] = waiting_walks_[first_waiting_++];
      blocks_[number].walking |= 1u << lane;
    }
}

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
      ray.time = walk.ray.time;
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
  next_ = 0;
  first_waiting_ = kBlockLanes;
  for (;;) {
    fill(walks);
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
