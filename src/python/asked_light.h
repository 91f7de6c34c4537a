// What a script asks for in light, in the words of the program's options.
#pragma once

#include <pybind11/pybind11.h>

#include "lighting/daylight_options.h"

namespace troffer {

// The keyword arguments of Scene.add_light() as DaylightOptions, bit for bit what they would be if
// typed. What nobody asked for stays dark. TypeError for what is of another kind, UsageError for
// what has no meaning.
DaylightOptions daylight_options(const pybind11::kwargs& asked);

// A message about options in a script's words: "--some-option" is some_option.
std::string in_script_words(const std::string& message);

// What help() says of them.
extern const char* const add_light_help;

}  // namespace troffer
