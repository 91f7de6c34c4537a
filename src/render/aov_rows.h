// Names of a picture's additional layers (AOVs), in options and in files. The one table for the
// command line, the Python module and the film.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "render/render.h"

namespace troffer {

struct AovRow {
  Aov aov;
  std::string_view name;
  std::vector<std::string_view> channels;  // names in files
};

const std::vector<AovRow>& aov_rows();
const AovRow& row_of(Aov aov);
std::optional<Aov> find_aov(std::string_view name);
std::string aov_names();  // all names, separated by commas

}  // namespace troffer
