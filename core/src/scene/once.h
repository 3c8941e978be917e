// Data that are computed from an immutable object at their first use, and shared by all scenes with that object.
#pragma once

#include <memory>
#include <mutex>

namespace lancer {

template <class T> class Once {
public:
  Once() = default;
  // A copy of an object will be changed: it computes its own data.
  Once(const Once &) {}
  Once &operator=(const Once &) {
    value_.reset();
    return *this;
  }

  // Returns make() of the first call that did not throw. Another thread waits for it.
  template <class Make> std::shared_ptr<const T> get(const Make &make) const {
    const std::lock_guard lock(mutex_);
    if (!value_)
      value_ = std::make_shared<const T>(make());
    return value_;
  }
  // Returns null before the first call.
  std::shared_ptr<const T> known() const {
    const std::lock_guard lock(mutex_);
    return value_;
  }

private:
  mutable std::mutex mutex_;
  mutable std::shared_ptr<const T> value_;
};

} // namespace lancer
