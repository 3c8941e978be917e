// Paths below surfaces: where they enter, and where they leave.
#include "bsdf/subsurface_lobe.h"
#include "integrator/path/path.h"

#include <algorithm>

namespace lancer {

namespace {

// The unit of a walk's throughput, which ends the walk where little of it is left.
float largest(const glm::vec3 &beta) { return std::max({std::abs(beta.x), std::abs(beta.y), std::abs(beta.z)}); }

} // namespace

// Sends the path of a lane below the surface.
void PathIntegrator::enter(uint32_t lane, uint32_t branch) {
  const ScatterBlock &block = scatter_.next();
  const Path &path = path_of(lane);
  const glm::vec3 beta = get(block.beta, lane);
  if (beta == glm::vec3(0.0f))
    return;
  Path &next = branch_off(below_, lane, branch);
  next.enter(beta, (block.below_variant[lane] & kDimmedExit) != 0);
  next.go(surface_.distance(lane));
  next.spread = 0.0f;
  film_.set_shares(path, next, block.share, lane);
  const glm::vec3 outwards = get(surface_.surfaces().ng, lane), ng = get(surface_.lobes().ng, lane);
  const Hit &hit = surface_.hit(lane);
  Walk &walk = walks_.emplace_back();
  walk.method = static_cast<SubsurfaceMethod>(block.below_variant[lane] & kMethodBits);
  walk.ray.o = get(surface_.surfaces().p, lane);
  walk.ray.d = glm::dvec3(get(block.wi, lane));
  walk.ray.skip_instance = hit.instance;
  walk.ray.skip_primitive = hit.primitive;
  walk.ray.time = surface_.surfaces().time[lane];
  walk.n = walk.method == SubsurfaceMethod::Burley ? ng : get(surface_.lobes().ns, lane);
  walk.from_behind = glm::dot(outwards, ng) < 0.0f;
  walk.beta = beta / largest(beta);
  walk.color = get(block.below_color, lane);
  walk.radius = get(block.below_radius, lane) * float(scene_.normalisation.scale);
  walk.g = block.below_g[lane];
  walk.ior = block.below_ior[lane];
  // The numbers of a light sample at this vertex serve the walk.
  const uint32_t dimension = path.vertex_dimension();
  walk.u_channel = next.sampler.get1(dimension + kVertexLightChoice);
  walk.u_distance = next.sampler.get1(dimension + kVertexLight);
  walk.key = hash_combine(hash_combine(next.sampler.pixel(), next.sampler.sample()), next.vertex_dimension());
  walk.instance = hit.instance;
}

// Walks below surfaces, and shades the places where paths leave them.
void PathIntegrator::leave() {
  if (below_.empty())
    return;
  counts_.bounce += walk_->walk(walks_);
  const size_t first = queue_.paths.size();
  for (size_t i = 0; i < below_.size(); ++i) {
    if (!walks_[i].hit.valid())
      continue;
    Path &path = queue_.paths.emplace_back(below_[i]);
    path.beta = largest(path.beta) * walks_[i].beta;
    queue_.rays.push_back(walks_[i].ray);
    queue_.rays.back().kinds = path.kinds;
    queue_.from.push_back({});
    hits_.push_back(walks_[i].hit);
  }
  below_.clear();
  walks_.clear();
  queues_.begin();
  for (size_t i = first; i < queue_.paths.size(); ++i)
    queues_.add(i, hits_[i]);
  shade_queued();
}

} // namespace lancer
