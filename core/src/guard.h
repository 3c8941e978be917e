// The boundary of the library: turns exceptions into statuses and keeps the message of a failure for its thread.
#pragma once

#include "lancer.h"
#include "scene/error.h"
#include "simd/float_environment.h"

#include <cstdio>
#include <new>
#include <system_error>

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

} // namespace lancer
