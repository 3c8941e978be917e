// Sets the instruction set in the environment during its lifetime.
#pragma once

#include <cstdlib>
#include <string>

namespace lancer::test {

class ForcedInstructionSet {
public:
  explicit ForcedInstructionSet(const char *name) {
    const char *before = std::getenv(kName);
    before_ = before ? before : "";
    set(name);
  }
  ~ForcedInstructionSet() { set(before_.c_str()); }
  ForcedInstructionSet(const ForcedInstructionSet &) = delete;
  ForcedInstructionSet &operator=(const ForcedInstructionSet &) = delete;

private:
  static constexpr const char *kName = "LANCER_ISA";
  // An empty value means none.
  static void set(const char *value) {
#if defined(_WIN32)
    _putenv_s(kName, value);
#else
    setenv(kName, value, 1);
#endif
  }
  std::string before_;
};

} // namespace lancer::test
