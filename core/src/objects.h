// The boundary of the library: exceptions become statuses, handles find scenes, before and after commit, and sessions.
#pragma once

#include "lancer.h"
#include "nodes/mipmaps.h"
#include "render/session.h"
#include "scene/fill.h"
#include "scene/messages.h"
#include "simd/processor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <mutex>
#include <new>
#include <system_error>
#include <unordered_map>
#include <variant>

namespace lancer {

// The message of the last failure. The buffer is fixed, so that a report of missing memory allocates none.
inline thread_local char last_error[1024] = "";

inline lancer_status fail(lancer_status status, const char *text) {
  std::snprintf(last_error, sizeof last_error, "%s", text);
  return status;
}

inline lancer_status status_of(Fault fault) {
  switch (fault) {
  case Fault::Argument:
    return LANCER_ERROR_ARGUMENT;
  case Fault::State:
    return LANCER_ERROR_STATE;
  case Fault::Memory:
    return LANCER_ERROR_MEMORY;
  case Fault::Internal:
    break;
  }
  return LANCER_ERROR_INTERNAL;
}

// Returns the release as parts of pictures tell it.
inline std::array<char, sizeof lancer_part::release> this_release() {
  static_assert(sizeof LANCER_VERSION <= sizeof lancer_part::release);
  std::array<char, sizeof lancer_part::release> release{};
  std::copy_n(LANCER_VERSION, sizeof LANCER_VERSION, release.begin());
  return release;
}

inline void copy_text(char *target, size_t size, const std::string &text) { std::snprintf(target, size, "%s", text.c_str()); }

struct BadHandle {
  const char *text;
};

// Runs body and returns its status; no exception leaves the library.
template <class Body> lancer_status guard(Body &&body) noexcept {
  last_error[0] = '\0';
  const FloatEnvironment environment;
  try {
    return body();
  } catch (const BadHandle &handle) {
    return fail(LANCER_ERROR_HANDLE, handle.text);
  } catch (const Error &error) {
    return fail(status_of(error.fault()), error.what());
  } catch (const std::bad_alloc &) {
    return fail(LANCER_ERROR_MEMORY, "out of memory");
  } catch (const std::length_error &) {
    return fail(LANCER_ERROR_MEMORY, "out of memory: an array is larger than any memory");
  } catch (const std::system_error &) {
    // The library requests only threads from the system.
    return fail(LANCER_ERROR_MEMORY, "not enough memory, or too many threads: the system gives no more threads");
  } catch (const std::exception &error) {
    return fail(LANCER_ERROR_INTERNAL, error.what());
  } catch (...) {
    return fail(LANCER_ERROR_INTERNAL, "unknown fault");
  }
}

inline void require(const void *pointer, const char *name) {
  if (!pointer)
    bad_argument(std::string(name) + " is NULL");
}

inline void check_confidence(const char *what, double confidence) {
  if (!(confidence > 0.0 && confidence < 1.0))
    bad_argument(std::string(what) + ": confidence " + std::to_string(confidence) + " must be between 0 and 1");
}

inline void check_threads(const char *what, uint32_t threads) {
  if (threads > 1024)
    bad_argument(std::string(what) + ": threads " + std::to_string(threads) + " > 1024");
}

inline void check_target(const char *what, double target) {
  if (!(target >= 0.0) || !std::isfinite(target))
    bad_argument(std::string(what) + ": target " + std::to_string(target) + " must be finite and not negative");
}

// Handles of one kind. A number is never used twice, and kinds differ in their highest byte: a freed or foreign handle finds no
// object.
template <class T> class Handles {
public:
  explicit Handles(uint64_t kind) : next_((kind << 56) + 1) {}

  uint64_t add(std::shared_ptr<T> object) {
    const std::lock_guard lock(mutex_);
    objects_.emplace(next_, std::move(object));
    return next_++;
  }
  // Returns the object, kept alive by the caller's copy; null if the handle is unknown.
  std::shared_ptr<T> find(uint64_t handle) const {
    const std::lock_guard lock(mutex_);
    const auto found = objects_.find(handle);
    return found == objects_.end() ? nullptr : found->second;
  }
  // Removes and returns the object; the handle is invalid afterwards. Returns null if the handle is unknown.
  std::shared_ptr<T> remove(uint64_t handle) {
    const std::lock_guard lock(mutex_);
    const auto found = objects_.find(handle);
    if (found == objects_.end())
      return nullptr;
    std::shared_ptr<T> object = std::move(found->second);
    objects_.erase(found);
    return object;
  }

private:
  mutable std::mutex mutex_;
  std::unordered_map<uint64_t, std::shared_ptr<T>> objects_;
  uint64_t next_;
};

// A part of scenes.
using PartObject = std::variant<Given<Image>, Given<Mesh>, Given<Material>, Given<LightDescription>, Given<World>>;

// Reads an image with its levels.
inline Given<Image> given_image(const lancer_image &source, size_t number) {
  Messages messages;
  Image image = read_image(source, number, messages);
  if (!image.in_blocks)
    make_mipmaps(image);
  return Given<Image>(std::move(image), std::move(messages));
}

class SceneObject {
public:
  ~SceneObject() { cancel = true; }

  std::mutex mutex;
  Description description;
  std::shared_ptr<const Scene> before; // from which the next commit takes what is the same; may be null
  std::shared_ptr<const Scene> scene;  // set by commit
  MadeCounts made;                     // by the commit
  std::string messages;
  std::array<uint8_t, 32> digest{};
  bool has_digest = false;
  std::atomic<bool> cancel{false};
  enum class State { Filling, Committing, Committed, Failed } state = State::Filling;
  std::unique_ptr<ThreadPool> builder; // last: its thread ends before the members that it works on are destroyed

  void require_filling() const {
    if (state != State::Filling)
      throw Error(Fault::State, "scene: it has been committed; nothing can be added");
  }
  const std::shared_ptr<const Scene> &committed() const {
    if (state != State::Committed)
      throw Error(Fault::State, state == State::Filling      ? "scene: it has not been committed yet"
                                : state == State::Committing ? "scene: wait for its commit first"
                                                             : "scene: its commit failed");
    return scene;
  }
};

struct SessionObject {
  SessionObject(std::shared_ptr<const Scene> scene, const Identity &identity, std::unique_ptr<const Bake> bake = nullptr)
      : session(std::move(scene), read_camera(identity.camera), read_settings(identity.settings), identity, std::move(bake)) {}
  std::mutex mutex;
  Session session;
};

// Never destroyed: a thread may still be inside a call while the process ends.
inline Handles<SceneObject> &scenes() {
  static auto *const handles = new Handles<SceneObject>(0x5c);
  return *handles;
}
inline Handles<const PartObject> &parts() {
  static auto *const handles = new Handles<const PartObject>(0x0b);
  return *handles;
}
inline Handles<SessionObject> &sessions() {
  static auto *const handles = new Handles<SessionObject>(0x5e);
  return *handles;
}

inline std::shared_ptr<SceneObject> scene_of(lancer_scene handle) {
  auto object = scenes().find(handle);
  if (!object)
    throw BadHandle{"scene: no such scene, or it has been destroyed"};
  return object;
}
inline std::shared_ptr<SessionObject> session_of(lancer_session handle) {
  auto object = sessions().find(handle);
  if (!object)
    throw BadHandle{"session: no such session, or it has been destroyed"};
  return object;
}

inline std::shared_ptr<const PartObject> part_of(lancer_object handle) {
  auto object = parts().find(handle);
  if (!object)
    throw BadHandle{"object: no such object, or it has been destroyed"};
  return object;
}

} // namespace lancer
