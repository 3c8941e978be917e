#include "accel/instruction_set.h"

#include <cstdlib>
#include <string_view>

namespace lancer {

InstructionSet instruction_set() {
#if defined(__x86_64__)
  const char *asked = std::getenv("LANCER_ISA");
  const std::string_view limit = asked ? asked : "";
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
                    __builtin_cpu_supports("bmi2");
  const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                      __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                      __builtin_cpu_supports("avx512vl");
  if (avx512 && limit != "avx2" && limit != "sse4")
    return InstructionSet::Avx512;
  return avx2 && limit != "sse4" ? InstructionSet::Avx2 : InstructionSet::Sse4;
#else
  return InstructionSet::Generic;
#endif
}

} // namespace lancer
