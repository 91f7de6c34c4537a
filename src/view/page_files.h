// Files of the page from src/view/page/, which the build embeds in the program (cmake/embed.cmake).
#pragma once

#include <span>
#include <string_view>

namespace troffer {

// One embedded file.
struct PageFile {
  std::string_view name;  // file name
  std::string_view text;
};

std::span<const PageFile> page_files();

}  // namespace troffer
