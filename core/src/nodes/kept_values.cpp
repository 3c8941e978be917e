#include "nodes/kept_values.h"

#include <new>

namespace lancer {

namespace {

constexpr std::align_val_t kAlignment{64};

} // namespace

void *allocate_kept(size_t bytes) { return ::operator new(bytes, kAlignment); }
void free_kept(void *values) { ::operator delete(values, kAlignment); }

} // namespace lancer
