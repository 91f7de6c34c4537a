// Position of an item in a text file, for error messages. Used by the importers of text formats,
// whose parsed items outlive the text.
#pragma once

#include <memory>
#include <string>

#include "base/error.h"

namespace troffer {

// File, line and column of an item; line and column count from 1.
struct SourcePlace {
  std::shared_ptr<const std::string> file;
  int line = 0, column = 0;

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(file ? *file : std::string(), line, column, what);
  }
};

// Returns text of a file for use in a message, at most 80 bytes.
inline std::string shortened(const std::string& text) {
  return text.size() <= 80 ? text : text.substr(0, 77) + "...";
}

}  // namespace troffer
