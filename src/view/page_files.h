// The page, which the build puts into the program (cmake/embed.cmake) from src/view/page/.
#pragma once

#include <span>
#include <string_view>

namespace troffer {

struct PageFile {
  std::string_view name;  // of the file
  std::string_view text;
};

std::span<const PageFile> page_files();

}  // namespace troffer
