// Sessions and their pictures in the C interface.
#include "lancer_probes.h"
#include "objects.h"
#include "render/catchers.h"
#include "render/denoised.h"
#include "render/fill_bake.h"
#include "render/session.h"
#include "simd/vectors.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <utility>

namespace {

using namespace lancer;

// Longest side of a picture that comes in arrays, far above Blender's.
constexpr uint32_t kLongestSide = 1u << 20;

// Returns the committed scene, and completes the identity of its pictures.
std::shared_ptr<const Scene> committed_of(lancer_scene scene, Identity &identity) {
  const auto object = scene_of(scene);
  const std::lock_guard lock(object->mutex);
  identity.digest = object->digest;
  identity.has_digest = object->has_digest;
  return object->committed();
}

} // namespace

extern "C" {

lancer_status lancer_session_create(lancer_scene scene, const lancer_camera *camera, const lancer_settings *settings,
                                    lancer_session *session) {
  return guard([&] {
    require(camera, "camera");
    require(settings, "settings");
    require(session, "session");
    Identity identity{{}, false, *camera, *settings, this_release()};
    auto committed = committed_of(scene, identity);
    *session = sessions().add(std::make_shared<SessionObject>(std::move(committed), identity));
    return LANCER_OK;
  });
}

lancer_status lancer_session_create_bake(lancer_scene scene, const lancer_camera *camera, const lancer_settings *settings,
                                         const lancer_bake *bake, lancer_session *session) {
  return guard([&] {
    require(camera, "camera");
    require(settings, "settings");
    require(bake, "bake");
    require(session, "session");
    if (settings->integrator != LANCER_PATH)
      bad_argument("bake: only PATH bakes");
    Identity identity{{}, false, *camera, *settings, this_release()};
    auto committed = committed_of(scene, identity);
    // Parts of pictures do not tell texels: a bake has none.
    identity.has_digest = false;
    auto texels = std::make_unique<const Bake>(read_bake(*bake, *committed, read_camera(*camera)));
    *session = sessions().add(std::make_shared<SessionObject>(std::move(committed), identity, std::move(texels)));
    return LANCER_OK;
  });
}

lancer_status lancer_session_destroy(lancer_session session) {
  return guard([&] {
    const auto object = sessions().remove(session);
    if (!object)
      throw BadHandle{"session: no such session, or it has been destroyed"};
    object->session.cancel();
    return LANCER_OK;
  });
}

lancer_status lancer_session_render(lancer_session session, uint32_t first, uint32_t count) {
  return guard([&] {
    const auto object = session_of(session);
    const std::lock_guard lock(object->mutex);
    object->session.render(first, count);
    return LANCER_OK;
  });
}

lancer_status lancer_session_wait(lancer_session session, uint32_t milliseconds, lancer_progress *progress) {
  return guard([&]() -> lancer_status {
    const auto object = session_of(session);
    const std::lock_guard lock(object->mutex);
    Progress now;
    const Session::State state = object->session.wait(milliseconds, now);
    if (progress)
      *progress = {now.fraction, now.seconds, now.samples, now.rays};
    return state == Session::State::Done ? LANCER_OK : state == Session::State::Running ? LANCER_RUNNING : LANCER_CANCELLED;
  });
}

lancer_status lancer_session_cancel(lancer_session session) {
  return guard([&] {
    // Do not take the lock: a thread inside lancer_session_wait() holds it.
    session_of(session)->session.cancel();
    return LANCER_OK;
  });
}

lancer_status lancer_session_stop(lancer_session session) {
  return guard([&] {
    // Take no lock, as in lancer_session_cancel().
    session_of(session)->session.stop();
    return LANCER_OK;
  });
}

lancer_status lancer_session_refine(lancer_session session, double target, double confidence) {
  return guard([&]() -> lancer_status {
    const auto object = session_of(session);
    check_target("refine", target);
    check_confidence("refine", confidence);
    const std::lock_guard lock(object->mutex);
    return object->session.refine(target, confidence) ? LANCER_OK : LANCER_CANCELLED;
  });
}

lancer_status lancer_session_error(lancer_session session, double confidence, lancer_error *error) {
  return guard([&] {
    const auto object = session_of(session);
    require(error, "error");
    check_confidence("error", confidence);
    const std::lock_guard lock(object->mutex);
    const SessionError from = object->session.error(confidence);
    const PictureError &picture = from.picture;
    *error = {picture.error,
              picture.low,
              picture.high,
              picture.cannot_exclude,
              from.clipped,
              from.clipped_direct,
              from.cut,
              from.no_caustics,
              from.filtered,
              from.filtered_error,
              from.guessed,
              from.guessed_error,
              from.missing,
              from.planned_samples,
              from.least_samples,
              from.most_samples};
    return LANCER_OK;
  });
}

lancer_status lancer_combine_denoised(uint32_t width, uint32_t height, const float *noisy, const float *noise,
                                      const float *errors, const float *first, const float *second, double step,
                                      uint32_t combines, double confidence, uint32_t block, float *picture, float *bars,
                                      lancer_denoised_error *error) {
  return guard([&] {
    const size_t numbers = 3 * size_t(width) * height;
    if (numbers == 0 || width > kLongestSide || height > kLongestSide)
      bad_argument("combine_denoised: " + std::to_string(width) + " x " + std::to_string(height) + " pixels");
    const std::pair<const char *, const float *> inputs[] = {
        {"noisy", noisy}, {"noise", noise}, {"first", first}, {"second", second}};
    for (const auto &[name, values] : inputs) {
      const std::string what = std::string("combine_denoised: ") + name;
      require(values, what.c_str());
      if (!std::all_of(values, values + numbers, [](float value) { return std::isfinite(value); }))
        bad_argument(what + " is not finite everywhere");
    }
    require(picture, "combine_denoised: picture");
    require(bars, "combine_denoised: bars");
    require(error, "combine_denoised: error");
    check_confidence("combine_denoised", confidence);
    if (!(step > 0.0 && step <= 1.0))
      bad_argument("combine_denoised: step " + std::to_string(step) + " must be above 0 and at most 1");
    if (combines > 1 || block == 0)
      bad_argument("combine_denoised: combines " + std::to_string(combines) + ", block " + std::to_string(block));
    const auto known = [](float value) { return std::isfinite(value) && value >= 0.0f; };
    if (errors && !std::all_of(errors, errors + numbers / 3, known))
      bad_argument("combine_denoised: errors must be finite and not negative");
    std::vector<float> of_blocks;
    const DenoisedInput input = {width, height, noisy, noise, errors, first, second, step, combines != 0};
    const DenoisedError from = combine_denoised(input, confidence, block, picture, of_blocks);
    std::copy(of_blocks.begin(), of_blocks.end(), bars);
    *error = {from.error, from.low, from.high, from.moved};
    return LANCER_OK;
  });
}

lancer_status lancer_compose_catchers(uint64_t count, const float *matte, const float *catcher, const float *environment,
                                      float *picture) {
  return guard([&] {
    require(matte, "compose_catchers: matte");
    require(catcher, "compose_catchers: catcher");
    require(picture, "compose_catchers: picture");
    for (uint64_t pixel = 0; pixel < count; ++pixel) {
      const glm::dvec4 over(glm::make_vec4(matte + 4 * pixel));
      const glm::dvec3 factor(glm::make_vec3(catcher + 3 * pixel));
      const glm::dvec4 seen = environment ? over_environment(over, factor, glm::dvec3(glm::make_vec3(environment + 3 * pixel)))
                                          : over_shadow(over, factor);
      for (int i = 0; i < 4; ++i)
        picture[4 * pixel + i] = nearest_float(seen[i]);
    }
    return LANCER_OK;
  });
}

lancer_status lancer_session_read(lancer_session session, uint32_t pass, float *out, size_t float_count) {
  return guard([&] {
    const auto object = session_of(session);
    require(out, "read: out");
    const std::lock_guard lock(object->mutex);
    const Film &film = object->session.film();
    const size_t expected = size_t(film.width()) * film.height() * Session::channels_of(pass);
    if (float_count != expected)
      bad_argument("read: out has " + std::to_string(float_count) + " floats, but the pass has " + std::to_string(expected));
    object->session.read(pass, std::span(out, float_count));
    return LANCER_OK;
  });
}

lancer_status lancer_session_statistics(lancer_session session, lancer_statistics *statistics) {
  return guard([&] {
    const auto object = session_of(session);
    require(statistics, "statistics");
    const std::lock_guard lock(object->mutex);
    const SessionStatistics from = object->session.statistics();
    *statistics = {};
    statistics->render_seconds = from.render_seconds;
    statistics->samples = from.samples;
    statistics->camera_rays = from.rays.camera;
    statistics->bounce_rays = from.rays.bounce;
    statistics->shadow_rays = from.rays.shadow;
    statistics->invalid_samples = from.invalid_samples;
    statistics->invalid_x = from.first_invalid.x;
    statistics->invalid_y = from.first_invalid.y;
    statistics->invalid_sample = from.first_invalid.sample;
    statistics->threads = from.threads;
    statistics->film_bytes = from.film_bytes;
    copy_text(statistics->kernel, sizeof statistics->kernel, from.kernel);
    statistics->split_lights = from.splits.lights;
    statistics->split_paths = from.splits.paths;
    statistics->vertices = from.vertices;
    if (object->session.only_joins())
      return LANCER_OK;
    const Scene &scene = object->session.scene();
    statistics->build_seconds = scene.build_seconds;
    statistics->triangles = scene.placed->triangles;
    statistics->instances = scene.geometry.instances.size();
    statistics->lights = scene.lights.size();
    statistics->geometry_bytes = scene.geometry_bytes();
    statistics->accelerator_bytes = scene.accelerator->bytes();
    statistics->texture_bytes = scene.texture_bytes();
    statistics->mapped_bytes = scene.mapped_bytes();
    const bool lens = object->session.camera().lens_radius > 0.0;
    copy_text(statistics->features, sizeof statistics->features,
              feature_names({scene.features, scene.shapes}) + (lens ? " lens" : ""));
    copy_text(statistics->instruction_set, sizeof statistics->instruction_set,
              instruction_set() == InstructionSet::Scalar ? "scalar" : scene.accelerator->instruction_set());
    return LANCER_OK;
  });
}

lancer_status lancer_debug_sample(lancer_session session, uint32_t x, uint32_t y, uint32_t s, float *rgba,
                                  lancer_vertex *vertices, uint32_t capacity, uint32_t *count) {
  return guard([&] {
    const auto object = session_of(session);
    require(rgba, "debug_sample: rgba");
    if (capacity)
      require(vertices, "debug_sample: vertices");
    const std::lock_guard lock(object->mutex);
    const Film &film = object->session.film();
    if (x >= film.width() || y >= film.height())
      bad_argument("debug_sample: pixel (" + std::to_string(x) + ", " + std::to_string(y) + ") outside the region of " +
                   std::to_string(film.width()) + " x " + std::to_string(film.height()));
    const Scene &scene = object->session.scene();
    std::vector<PathVertex> path;
    const SampleResult result = object->session.replay({x, y, s}, path);
    for (int i = 0; i < 3; ++i)
      rgba[i] = result.radiance[i];
    rgba[3] = result.alpha;
    for (size_t i = 0; i < std::min<size_t>(capacity, path.size()); ++i) {
      const PathVertex &from = path[i];
      vertices[i] = {{from.position.x, from.position.y, from.position.z},
                     from.t,
                     {from.normal.x, from.normal.y, from.normal.z},
                     {from.beta.x, from.beta.y, from.beta.z},
                     {from.radiance.x, from.radiance.y, from.radiance.z},
                     scene.geometry.instances[from.instance].number,
                     scene.face_number(from.instance, from.primitive),
                     from.material,
                     from.depth};
    }
    if (count)
      *count = uint32_t(path.size());
    return LANCER_OK;
  });
}

} // extern "C"
