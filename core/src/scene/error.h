// Errors, whose messages name the object and the value.
#pragma once

#include <stdexcept>
#include <string>

namespace lancer {

enum class Fault { Argument, State, Memory, Internal };

class Error : public std::runtime_error {
public:
  Error(Fault fault, const std::string &text) : std::runtime_error(text), fault_(fault) {}
  Fault fault() const { return fault_; }

private:
  Fault fault_;
};

[[noreturn]] inline void bad_argument(const std::string &text) { throw Error(Fault::Argument, text); }

} // namespace lancer
