#include "accel/accelerator.h"
#include "accel/coplanar/coplanar_faces.h"

namespace lancer {

namespace {

// A filter that calls a function of (ray, hit).
template <class Counts> class FilterBy final : public HitFilter {
public:
  FilterBy(const std::vector<uint8_t> &asks, const Counts &counts) : HitFilter(asks.data()), counts_(counts) {}
  bool counts(size_t ray, const Hit &hit) override { return counts_(ray, hit); }

private:
  const Counts &counts_;
};

class CoplanarAccelerator final : public Accelerator {
public:
  CoplanarAccelerator(std::shared_ptr<const Accelerator> a, PlaneRule r, size_t instances)
      : inner(std::move(a)), rule(std::move(r)), everything(instances, 1) {}

  const Accelerator &without_order() const override { return *inner; }
  TraversalCounts count(std::span<const Ray> rays, bool any) const override { return inner->count(rays, any); }
  size_t bytes() const override { return inner->bytes() + rule.bytes() + everything.capacity(); }
  const char *instruction_set() const override { return inner->instruction_set(); }

private:
  // A query with its filter.
  struct Asked {
    std::span<const Ray> rays;
    HitFilter *filter;

    bool counts(size_t ray, const Hit &hit) const {
      return !filter || !filter->instances[hit.instance] || filter->counts(ray, hit);
    }
  };

  // A hit, and the search across its plane for a face of higher priority.
  struct Search {
    size_t ray;
    Hit *hit;
    PlaneRule::Across across;
    PlaneOrder best;
    Hit found;
  };
  struct Searches {
    const Asked &asked; // without a filter, transparent faces are found as well
    std::vector<Ray> rays;
    std::vector<Search> all;
  };

  // A light at the end of a shadow ray, and the faces in its plane.
  struct End {
    size_t ray = 0;
    bool known = false, shines = false, stops = false; // any face found, an emitting one, one that occludes
    PlaneOrder best{};
    bool best_shines = false;
  };
  struct Ends {
    const Asked &asked;
    std::vector<Ray> rays;
    std::vector<End> all;
  };

  void find(std::span<const Ray> rays, std::span<Hit> hits, HitFilter *filter) const override {
    const Asked asked{rays, filter};
    Searches searches{asked, {}, {}};
    if (filter) {
      trace(asked, hits);
      for (size_t i = 0; i < rays.size(); ++i)
        search_flagged(i, hits[i], searches);
    } else {
      // Trace again the few rays that hit the plane in which they start.
      inner->closest_hit(rays, hits);
      std::vector<size_t> back;
      for (size_t i = 0; i < rays.size(); ++i) {
        if (!hits[i].valid() || !rule.flagged(hits[i]))
          continue;
        if (rule.starts_in_plane(rays[i], hits[i]))
          back.push_back(i);
        else
          search(i, hits[i], searches);
      }
      again(rays, back, hits);
      for (const size_t i : back)
        search_flagged(i, hits[i], searches);
    }
    settle(searches);
  }

  void find(std::span<const Ray> rays, std::span<uint8_t> occluded, HitFilter *filter) const override {
    const Asked asked{rays, filter};
    if (filter) {
      trace(asked, occluded);
    } else {
      // Trace again the rays that start or end where coplanar faces may be: the result does not say which face occluded them.
      inner->any_hit(rays, occluded);
      std::vector<size_t> back;
      for (size_t i = 0; i < rays.size(); ++i)
        if (occluded[i] && (rule.starts_covered(rays[i]) || rule.may_end_on_light(rays[i])))
          back.push_back(i);
      again(rays, back, occluded);
    }
    if (rule.any_hidden_light())
      look_at_ends(asked, occluded);
  }

  // Traces a subset of the rays with the plane rule.
  template <class Answer>
  void again(std::span<const Ray> rays, const std::vector<size_t> &which, std::span<Answer> answers) const {
    if (which.empty())
      return;
    std::vector<Ray> some;
    for (const size_t i : which)
      some.push_back(rays[i]);
    std::vector<Answer> found(some.size());
    trace({some, nullptr}, std::span<Answer>(found));
    for (size_t i = 0; i < which.size(); ++i)
      answers[which[i]] = found[i];
  }

  void trace(Asked asked, std::span<Hit> hits) const {
    const std::vector<uint8_t> instances = instances_asked(asked.filter);
    const auto counts = [&](size_t ray, const Hit &hit) {
      return !(rule.flagged(hit) && rule.starts_in_plane(asked.rays[ray], hit)) && asked.counts(ray, hit);
    };
    FilterBy filter(instances, counts);
    inner->closest_hit(asked.rays, hits, filter);
  }

  void trace(Asked asked, std::span<uint8_t> occluded) const {
    const std::vector<uint8_t> instances = instances_asked(asked.filter);
    const auto counts = [&](size_t ray, const Hit &hit) { return stops(asked, ray, hit); };
    FilterBy filter(instances, counts);
    inner->any_hit(asked.rays, occluded, filter);
  }

  std::vector<uint8_t> instances_asked(HitFilter *filter) const {
    std::vector<uint8_t> instances = rule.instances();
    for (size_t i = 0; filter && i < instances.size(); ++i)
      instances[i] |= filter->instances[i];
    return instances;
  }

  bool stops(const Asked &asked, size_t ray, const Hit &hit) const {
    if (!rule.flagged(hit))
      return asked.counts(ray, hit);
    const Ray &asked_ray = asked.rays[ray];
    if (rule.starts_in_plane(asked_ray, hit) || (rule.may_end_on_light(asked_ray) && rule.ends_in_plane(asked_ray, hit)))
      return false;
    // A transparent face has no effect where a face of higher priority covers it.
    if (asked.filter && asked.filter->instances[hit.instance]) {
      Hit there = hit;
      const Asked all{asked.rays, nullptr};
      Searches searches{all, {}, {}};
      search(ray, there, searches);
      settle(searches);
      if (there.instance != hit.instance || there.primitive != hit.primitive)
        return false;
    }
    return asked.counts(ray, hit);
  }

  void search_flagged(size_t ray, Hit &hit, Searches &searches) const {
    if (hit.valid() && rule.flagged(hit))
      search(ray, hit, searches);
  }

  void search(size_t ray, Hit &hit, Searches &searches) const {
    const std::optional<PlaneRule::Across> across = rule.across(searches.asked.rays[ray], hit);
    if (!across)
      return;
    searches.rays.push_back(across->ray);
    searches.all.push_back({ray, &hit, *across, rule.order_of(hit), hit});
  }

  // Passes all hits along the rays to looks.
  template <class Looks> void look(Looks &looks) const {
    if (looks.all.empty())
      return;
    std::vector<uint8_t> nothing(looks.all.size());
    const auto counts = [&](size_t i, const Hit &hit) {
      look_at(looks.asked, hit, looks.all[i]);
      return false;
    };
    FilterBy filter(everything, counts);
    inner->any_hit(looks.rays, nothing, filter);
  }

  void settle(Searches &searches) const {
    look(searches);
    for (const Search &s : searches.all)
      *s.hit = s.found;
  }

  void look_at(const Asked &asked, const Hit &hit, Search &s) const {
    const Ray &ray = asked.rays[s.ray];
    if (ray.skip_instance == hit.instance && ray.skip_primitive == hit.primitive)
      return;
    const PlaneOrder order = rule.order_of(hit);
    const Hit there{s.hit->t, hit.u, hit.v, hit.instance, hit.primitive};
    if (!(order < s.best) || !rule.in_plane(s.across, *s.hit, hit) || !asked.counts(s.ray, there))
      return;
    s.best = order;
    s.found = there;
  }

  // A light that is coplanar with other faces is visible if the face of highest priority emits.
  void look_at_ends(const Asked &asked, std::span<uint8_t> occluded) const {
    Ends ends{asked, {}, {}};
    for (size_t i = 0; i < occluded.size(); ++i)
      if (!occluded[i] && asked.rays[i].tmax < std::numeric_limits<double>::infinity()) {
        ends.rays.push_back(PlaneRule::around_end(asked.rays[i]));
        ends.all.emplace_back().ray = i;
      }
    look(ends);
    for (const End &end : ends.all)
      occluded[end.ray] = end.known && (end.shines ? !end.best_shines : end.stops);
  }

  void look_at(const Asked &asked, const Hit &hit, End &end) const {
    const Ray &ray = asked.rays[end.ray];
    if (!rule.flagged(hit) || !rule.ends_in_plane(ray, hit) || rule.starts_in_plane(ray, hit))
      return;
    const bool light = rule.emits(hit);
    end.stops = end.stops || (ray.tmin < hit.t && hit.t < ray.tmax && asked.counts(end.ray, hit));
    end.shines = end.shines || light;
    if (const PlaneOrder order = rule.order_of(hit); !end.known || order < end.best) {
      end.best = order;
      end.best_shines = light;
    }
    end.known = true;
  }

  const std::shared_ptr<const Accelerator> inner;
  const PlaneRule rule;
  const std::vector<uint8_t> everything; // by instance: report its hits to the filter
};

} // namespace

std::shared_ptr<const Accelerator> order_coplanar_faces(std::shared_ptr<const Accelerator> unordered,
                                                        const GeometryView &geometry, PlaneRules rules,
                                                        const BuildContext &context, MeshOwners owners) {
  const FaceRounding rounding(geometry, rules.origin, owners);
  CoplanarFaces faces = find_coplanar_faces(geometry, rounding, rules, context);
  if (!faces.any())
    return unordered;
  return std::make_shared<const CoplanarAccelerator>(
      std::move(unordered), PlaneRule(geometry, rounding, std::move(faces), std::move(rules)), geometry.instances.size());
}

std::unique_ptr<Accelerator> build_accelerator(AcceleratorKind kind, const GeometryView &geometry, const BuildContext &context,
                                               MeshOwners owners) {
  switch (kind) {
  case AcceleratorKind::KdTree:
    return build_kdtree_accelerator(geometry, context, owners);
  case AcceleratorKind::BruteForce:
    return build_brute_force(geometry);
  case AcceleratorKind::Bvh:
    break;
  }
  return build_bvh(geometry, context, owners);
}

} // namespace lancer
