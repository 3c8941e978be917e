// Errors, whose messages name the object and the value; and the check of requests against the machine's memory.
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

// Returns the machine's memory, in bytes.
double physical_memory();

// Throws an Error if bytes exceed the memory. what: "image 'Sky': 65536 x 65536 texels".
void check_memory(const std::string &what, double bytes);

} // namespace lancer
