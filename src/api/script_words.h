// Rewrites messages that name command-line options for callers of the library, who know them as
// names in C++ or Python. Used wherever the public interface calls code of the program.
#pragma once

#include <string>

#include "base/error.h"

namespace troffer {

// Returns the message with "--some-option" replaced by "some_option".
std::string in_script_words(const std::string& message);

// Runs an action and rewrites the UsageErrors that it throws.
template <class Action>
auto with_script_words(const Action& action) {
  try {
    return action();
  } catch (const UsageError& e) {
    throw UsageError(in_script_words(e.what()));
  }
}

}  // namespace troffer
