// Converts light that a script asks for into the program's options. Scene.add_light() uses it.
#pragma once

#include <pybind11/pybind11.h>

#include "lighting/daylight_options.h"

namespace troffer {

// Returns the keyword arguments of Scene.add_light() as DaylightOptions, exactly as if they were
// typed. Light that is not asked for stays off. Throws TypeError for values of a wrong type,
// UsageError for meaningless values.
DaylightOptions daylight_options(const pybind11::kwargs& asked);

// Rewrites option names in a message as a script spells them: "--some-option" becomes some_option.
std::string in_script_words(const std::string& message);

// Documentation of add_light() for help().
extern const char* const add_light_help;

}  // namespace troffer
