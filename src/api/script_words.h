// Messages about the program's options, in the words of programs that use the library.
#pragma once

#include <string>

#include "base/error.h"

namespace troffer {

// Replaces "--some-option" by some_option.
std::string in_script_words(const std::string& message);

// Runs an action whose UsageErrors name options of the program.
template <class Action>
auto with_script_words(const Action& action) {
  try {
    return action();
  } catch (const UsageError& e) {
    throw UsageError(in_script_words(e.what()));
  }
}

}  // namespace troffer
