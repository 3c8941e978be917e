// Choice of the kernels' copy: the widest that the processor supports, with any compiler's library.
#include "simd/processor.h"

#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <initializer_list>
#include <set>
#include <sstream>
#include <string>

#if defined(__linux__) && defined(__x86_64__)

namespace {

using lancer::InstructionSet;

// Returns Linux's flags of the first processor.
std::set<std::string> processor_flags() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.rfind("flags", 0) == 0) {
      std::istringstream words(line.substr(line.find(':') + 1));
      std::set<std::string> found;
      for (std::string word; words >> word;)
        found.insert(word);
      return found;
    }
  return {};
}

bool all_of(const std::set<std::string> &flags, std::initializer_list<const char *> wanted) {
  for (const char *flag : wanted)
    if (flags.count(flag) == 0)
      return false;
  return true;
}

// Returns the instruction set selected by LANCER_ISA; an empty limit means none.
InstructionSet asked_for(const std::string &limit) {
  const char *before = std::getenv("LANCER_ISA");
  const std::string kept = before ? before : "";
  if (limit.empty())
    unsetenv("LANCER_ISA");
  else
    setenv("LANCER_ISA", limit.c_str(), 1);
  const InstructionSet chosen = lancer::instruction_set();
  if (before)
    setenv("LANCER_ISA", kept.c_str(), 1);
  else
    unsetenv("LANCER_ISA");
  return chosen;
}

// Linux omits the flags of registers that it does not save for threads.
TEST(InstructionSets, TheWidestThatTheProcessorRunsIsTaken) {
  const std::set<std::string> flags = processor_flags();
  ASSERT_FALSE(flags.empty());
  const bool avx2 = all_of(flags, {"avx2", "fma", "bmi1", "bmi2", "f16c", "movbe", "abm"});
  const bool avx512 = avx2 && all_of(flags, {"avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl"});
  const InstructionSet best = avx512 ? InstructionSet::Avx512 : avx2 ? InstructionSet::Avx2 : InstructionSet::Sse4;
  EXPECT_EQ(asked_for(""), best);
  EXPECT_EQ(asked_for("avx512"), best);
  EXPECT_EQ(asked_for("avx2"), avx2 ? InstructionSet::Avx2 : InstructionSet::Sse4);
  EXPECT_EQ(asked_for("sse4"), InstructionSet::Sse4);
  EXPECT_EQ(asked_for("scalar"), InstructionSet::Scalar);
}

} // namespace

#endif
