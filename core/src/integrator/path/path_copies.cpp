// Copies of paths: ghosts, which measure what limits and settings do to the light, and those that go on among shadow catchers.
#include "integrator/path/path.h"

namespace lancer {

namespace {

// Whether a path sends a ghost, by its address.
bool sends(const Path &path, Ghost cause) {
  constexpr uint32_t kOther = 0x9e3779b9; // numbers apart from those of estimates
  return hash_combine(path.estimates_key(), kOther) % paths_of(cause) == 0;
}

} // namespace

// Adds copies of some paths at the surfaces where limits change them, which go on without the limits.
void PathIntegrator::send_ghosts() {
  for (size_t i = 0, count = queue_.paths.size(); i < count; ++i) {
    const Path &path = queue_.paths[i];
    if (!hits_[i].valid() || path.is_spent(settings_) || path.of_catchers || path.ghost != Ghost::None)
      continue;
    const bool over = path.is_over_limit(settings_);
    const Ghost cause = over ? Ghost::Bounces : Ghost::Caustics;
    if (over || (path.lacks_caustics() && (settings_.no_reflections || settings_.no_refractions)))
      if (sends(path, cause))
        send_ghost(i, cause);
    if (!over && !filtered_materials_.empty())
      send_pair(i);
  }
}

// Adds a copy of a path that goes on from its surface.
void PathIntegrator::send_ghost(size_t path, Ghost cause) {
  Path ghost = queue_.paths[path];
  ghost.haunt(cause, true);
  queue_.paths.push_back(ghost);
  queue_.rays.push_back(Ray(queue_.rays[path]));
  queue_.from.push_back(Scattering(queue_.from[path]));
  hits_.push_back(Hit(hits_[path]));
}

// Lets some paths go on with and without the filter from the first surface that it may change.
void PathIntegrator::send_pair(size_t number) {
  Path &path = queue_.paths[number];
  if (path.filtered || !(path.least_alpha(settings_.filter_glossy) > 0.0f))
    return;
  const Hit &hit = hits_[number];
  const uint32_t material = material_of(scene_.geometry, scene_.slots, hit.instance, hit.primitive);
  if (material == kNone || !filtered_materials_[material])
    return;
  path.filtered = true;
  if (!sends(path, Ghost::Sharp))
    return;
  send_ghost(number, Ghost::Blurred);
  send_ghost(number, Ghost::Sharp);
}

// Lets a path whose last ray Fast GI ends early go on also without that end, beside a copy of it. tmax: of the whole ray.
void PathIntegrator::follow_guess(size_t number, double tmax) {
  const Path &path = next_.paths[number];
  if (path.ghost != Ghost::None || path.of_catchers || path.in_view || !sends(path, Ghost::Followed))
    return;
  for (const Ghost cause : {Ghost::Guessed, Ghost::Followed}) {
    Path ghost = next_.paths[number];
    ghost.haunt(cause, false);
    next_.paths.push_back(ghost);
    next_.from.push_back(Scattering(next_.from[number]));
    next_.rays.push_back(Ray(next_.rays[number]));
  }
  next_.rays.back().tmax = tmax;
}

// Lets paths that meet a shadow catcher in the camera's view go on twice: among all objects, and among catchers alone.
void PathIntegrator::send_among_catchers() {
  behind_.clear();
  const bool shows_sky = (settings_.passes & bit(Pass::Environment)) && !settings_.film_transparent;
  for (size_t i = 0, count = queue_.paths.size(); i < count; ++i) {
    Path &path = queue_.paths[i];
    if (!hits_[i].valid() || !film_.splits_at(path, scene_.geometry.instances[hits_[i].instance]))
      continue;
    film_.meet_catcher(path);
    if (shows_sky && path.shows_light(hidden_of_catcher(scene_.world.hidden_from)))
      behind_.push_back(i);
    path.caught = true;
    Path among = path;
    among.leave_others();
    queue_.paths.push_back(among);
    queue_.rays.push_back(Ray(queue_.rays[i]));
    queue_.from.push_back(Scattering(queue_.from[i]));
    hits_.push_back(Hit(hits_[i]));
  }
}

} // namespace lancer
