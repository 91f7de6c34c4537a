#include "base/similar_file.h"

#include <algorithm>
#include <filesystem>
#include <vector>

#include "base/suggestion.h"

namespace troffer {

std::string did_you_mean_file(const std::string& path) {
  namespace fs = std::filesystem;
  constexpr size_t most_names = 10'000;
  const fs::path asked(path);
  const fs::path folder = asked.has_parent_path() ? asked.parent_path() : fs::path(".");
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator i(folder, error), end;
       !error && i != end && names.size() < most_names; i.increment(error))
    names.push_back(i->path().filename().string());
  std::sort(names.begin(), names.end());  // directory order differs between machines
  return did_you_mean(asked.filename().string(), names);
}

}  // namespace troffer
