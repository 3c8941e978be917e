// Sentences to the user, which name the object and the value: errors, reports of replaced data, and the check of requests
// against the machine's memory.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <vector>

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

// Reports of data that were left out or replaced, one line each; equal lines are merged with a count.
class Messages {
public:
  void add(const std::string &object, const std::string &what);
  void add(const Messages &others);
  // Returns all lines, each with a trailing newline.
  std::string text() const;

private:
  struct Line {
    std::string text;
    uint64_t count;
  };
  void add_line(const std::string &text, uint64_t count);

  std::vector<Line> lines_;
  std::unordered_map<std::string, size_t> numbers_; // index of a line by its text
};

// Returns "kind 'name'", or "kind #number" without a name.
std::string label(const char *kind, const char *name, size_t number);

} // namespace lancer
