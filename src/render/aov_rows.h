// What pictures' further layers are called, in options and in files.
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
  std::vector<std::string_view> channels;  // as named in files
};

const std::vector<AovRow>& aov_rows();
const AovRow& row_of(Aov aov);
std::optional<Aov> find_aov(std::string_view name);
std::string aov_names();  // with commas between them

}  // namespace troffer
