#include "integrator/stages/walk.h"

#include "bsdf/subsurface.h"
#include "sampling/sobol.h"

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

WalkStage::WalkStage(const Scene &scene)
    : HitFilter(nullptr), scene_(scene), kernel_(walk_kernel()), all_instances_(scene.geometry.instances.size(), 1) {
  instances = all_instances_.data();
}

bool WalkStage::counts(size_t ray, const Hit &hit) {
  if (hit.instance != instance_of_[ray])
    return false;
  if (!collects_)
    return true;
  crossed_[ray].push_back(hit);
  return false;
}

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
  for (size_t number = 0; number < blocks_.size() && next < walks.size(); ++number) {
    WalkBlock &block = blocks_[number];
    uint32_t fresh = 0;
    for (uint32_t lane = 0; lane < kBlockLanes && next < walks.size(); ++lane)
      if (!(block.walking >> lane & 1)) {
        load(walks[next], next, uint32_t(number * kBlockLanes + lane));
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
  scene_.accelerator->closest_hit(rays_, hits_, *this);
  for (size_t i = 0; i < rays_.size(); ++i)
    blocks_[lane_of_[i] / kBlockLanes].met[lane_of_[i] % kBlockLanes] = hits_[i].valid() ? hits_[i].t : kInfinite;
}

uint64_t WalkStage::walk(std::span<Walk> walks) {
  const auto profiles = std::stable_partition(walks.begin(), walks.end(),
                                              [](const Walk &walk) { return walk.method != SubsurfaceMethod::Burley; });
  uint64_t count = leave_by_profile({profiles, walks.end()});
  const std::span<Walk> random(walks.begin(), profiles);
  blocks_.resize(std::min(kBlocks, (random.size() + kBlockLanes - 1) / kBlockLanes));
  walk_of_.resize(blocks_.size() * kBlockLanes);
  for (WalkBlock &block : blocks_)
    block.walking = 0;
  for (size_t next = 0;;) {
    if (next < random.size())
      fill(random, next);
    else
      close_ranks();
    for (WalkBlock &block : blocks_)
      if (block.walking != 0)
        kernel_.step(block);
    look(random);
    if (rays_.empty())
      return count;
    count += rays_.size();
    for (WalkBlock &block : blocks_) {
      block.left = 0;
      if (block.walking != 0)
        kernel_.advance(block);
    }
    for (size_t i = 0; i < rays_.size(); ++i) {
      const WalkBlock &block = blocks_[lane_of_[i] / kBlockLanes];
      const uint32_t lane = lane_of_[i] % kBlockLanes;
      if (block.left >> lane & 1)
        end(random[walk_of_[lane_of_[i]]], block, lane, hits_[i], rays_[i]);
    }
  }
}

// Ends a walk at the hit of a ray from inside: the path meets the surface as if it came from outside.
void WalkStage::end(Walk &walk, const WalkBlock &block, uint32_t lane, const Hit &hit, const Ray &ray) {
  walk.hit = hit;
  walk.beta = get(block.throughput, lane);
  walk.ray = ray;
  walk.ray.o = ray.o + 2.0 * hit.t * ray.d;
  walk.ray.d = -ray.d;
}

// Leaves by Burley's profile: along one of three axes through a point of a disk around the entry, at one of the surfaces met.
uint64_t WalkStage::leave_by_profile(std::span<Walk> walks) {
  struct Probe {
    Frame<float> frame; // n is the axis
    float share[3];     // of the axes n, t, b
    float r, height;
  };
  if (walks.empty())
    return 0;
  std::vector<Probe> probes;
  rays_.clear();
  instance_of_.clear();
  const auto number = [](const Walk &walk, uint32_t which) { return float(hash_combine(walk.key, which) >> 8) * 0x1p-24f; };
  for (const Walk &walk : walks) {
    Probe probe;
    const Frame<float> at(walk.n);
    float u = walk.u_distance;
    const float v = walk.u_channel;
    // Half of the rays go along the normal, a quarter along each tangent.
    const int axis = u < 0.5f ? 0 : u < 0.75f ? 1 : 2;
    u = axis == 0 ? 2.0f * u : axis == 1 ? 4.0f * (u - 0.5f) : 4.0f * (u - 0.75f);
    probe.frame = at;
    if (axis == 1)
      std::swap(probe.frame.n, probe.frame.t);
    else if (axis == 2)
      std::swap(probe.frame.n, probe.frame.b);
    std::fill_n(probe.share, 3, 0.25f);
    probe.share[axis] = 0.5f;
    // Choose one of the channels that have a radius, and a distance by its profile.
    float channels = 0.0f;
    for (int i = 0; i < 3; ++i)
      channels += walk.radius[i] > 0.0f ? 1.0f : 0.0f;
    float w = v * channels, radius = 0.0f;
    for (int i = 0; i < 3 && channels > 0.0f; ++i)
      if (walk.radius[i] > 0.0f) {
        radius = walk.radius[i];
        if (w < 1.0f)
          break;
        w -= 1.0f;
      }
    probe.r = burley_radius(std::min(w, 1.0f)) * radius;
    const float reach = kBurleyReach * radius;
    probe.height = std::sqrt(std::max(0.0f, (reach - probe.r) * (reach + probe.r)));
    const SinCos<float> turn = sin_cos_turn(u);
    Ray &ray = rays_.emplace_back();
    ray.o = walk.ray.o + glm::dvec3(probe.frame.n) * double(probe.height) +
            double(probe.r) * (double(turn.cos) * glm::dvec3(probe.frame.t) + double(turn.sin) * glm::dvec3(probe.frame.b));
    ray.d = -glm::dvec3(probe.frame.n);
    ray.tmax = 2.0 * double(probe.height);
    instance_of_.push_back(walk.instance);
    probes.push_back(probe);
  }
  crossed_.assign(rays_.size(), {});
  occluded_.assign(rays_.size(), 0);
  collects_ = true;
  scene_.accelerator->any_hit(rays_, occluded_, *this);
  collects_ = false;
  for (size_t i = 0; i < walks.size(); ++i) {
    Walk &walk = walks[i];
    std::vector<Hit> &hits = crossed_[i];
    std::sort(hits.begin(), hits.end(), [](const Hit &a, const Hit &b) { return closer(a.t, a.instance, a.primitive, b); });
    const auto same = [](const Hit &a, const Hit &b) { return a.t == b.t; };
    hits.erase(std::unique(hits.begin(), hits.end(), same), hits.end());
    // Weight each surface by the profile at its distance, over the densities of all axes.
    std::vector<glm::vec3> weights;
    float sum = 0.0f;
    for (const Hit &hit : hits) {
      const Surface surface = surface_at(scene_.geometry, scene_.slots, rays_[i], hit);
      const float r = float(glm::length(surface.p - walk.ray.o));
      float pdf[3], squares = 0.0f;
      const glm::vec3 axes[] = {probes[i].frame.n, probes[i].frame.t, probes[i].frame.b};
      for (int k = 0; k < 3; ++k) {
        pdf[k] = probes[i].share[k] * std::abs(glm::dot(axes[k], surface.ng));
        squares += pdf[k] * pdf[k];
      }
      float mean = 0.0f, channels = 0.0f;
      glm::vec3 profile(0.0f);
      for (int k = 0; k < 3; ++k)
        if (walk.radius[k] > 0.0f) {
          profile[k] = burley_profile(walk.radius[k], r);
          mean += burley_profile(walk.radius[k], probes[i].r);
          channels += 1.0f;
        }
      const float scale = mean > 0.0f && squares > 0.0f ? pdf[0] / squares * channels / mean : 0.0f;
      weights.push_back(profile * scale);
      sum += (weights.back().x + weights.back().y + weights.back().z) / 3.0f;
    }
    // Choose one of them by its weight.
    float u = number(walk, 0) * sum;
    for (size_t k = 0; k < hits.size(); ++k) {
      const float weight = (weights[k].x + weights[k].y + weights[k].z) / 3.0f;
      if (weight > 0.0f && (u < weight || k + 1 == hits.size())) {
        walk.hit = hits[k];
        walk.beta *= weights[k] * (sum / weight);
        walk.ray = rays_[i];
        // Come from the outside of the surface.
        const Surface surface = surface_at(scene_.geometry, scene_.slots, rays_[i], hits[k]);
        const bool behind = glm::dot(glm::vec3(rays_[i].d), surface.ng) > 0.0f;
        if (behind != walk.inside) {
          walk.ray.o += 2.0 * hits[k].t * walk.ray.d;
          walk.ray.d = -walk.ray.d;
        }
        break;
      }
      u -= weight;
    }
  }
  return rays_.size();
}

} // namespace lancer
