// Numbers for objects that live on the other side of the C interface.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <unordered_map>

namespace lancer {

// Handles of one kind. A number is never used twice, and kinds differ in their highest byte: a freed or foreign handle finds
// nothing.
template <class T> class Handles {
public:
  explicit Handles(uint64_t kind) : next_((kind << 56) + 1) {}

  uint64_t add(std::shared_ptr<T> object) {
    const std::lock_guard lock(mutex_);
    objects_.emplace(next_, std::move(object));
    return next_++;
  }
  // The object, kept alive by the caller's copy; null where there is none.
  std::shared_ptr<T> find(uint64_t handle) const {
    const std::lock_guard lock(mutex_);
    const auto found = objects_.find(handle);
    return found == objects_.end() ? nullptr : found->second;
  }
  // Takes the object out, so that the handle is free from now on.
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

} // namespace lancer
