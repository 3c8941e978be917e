// Names of attributes as numbers, the same in all scenes of the process, so that a mesh and a material that were made for
// different scenes agree.
#pragma once

#include <cstdint>
#include <string>

namespace lancer {

// Returns the number of a name; 0 is the number of "". A number is never given to another name.
uint32_t attribute_name(const std::string &name);

// Returns the name of a number.
std::string attribute_of(uint32_t number);

} // namespace lancer
