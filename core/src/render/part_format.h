// Numbers and words that the writing and the reading of parts share.
#pragma once

#include "scene/messages.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace lancer {

inline constexpr std::string_view kPartMark = "LANCERPT";
inline constexpr uint32_t kPartFormat = 2;
// The head and the end of a part: mark, format, interface, size; checksum.
inline constexpr size_t kPartHead = kPartMark.size() + 2 * sizeof(uint32_t) + sizeof(uint64_t), kPartEnd = sizeof(uint64_t);

[[noreturn]] inline void refuse_part(const std::string &why) { bad_argument("part: " + why); }

} // namespace lancer
