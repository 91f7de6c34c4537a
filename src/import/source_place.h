// Where in a text file something stands, for messages.
#pragma once

#include <memory>
#include <string>

#include "base/error.h"

namespace troffer {

struct SourcePlace {
  std::shared_ptr<const std::string> file;
  int line = 0, column = 0;

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(file ? *file : std::string(), line, column, what);
  }
};

// Text of a file as part of a message: of bounded length.
inline std::string shortened(const std::string& text) {
  return text.size() <= 80 ? text : text.substr(0, 77) + "...";
}

}  // namespace troffer
