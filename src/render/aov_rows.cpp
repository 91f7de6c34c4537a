#include "render/aov_rows.h"

#include <algorithm>

#include "base/error.h"

namespace troffer {

const std::vector<AovRow>& aov_rows() {
  static const std::vector<AovRow> rows{{Aov::albedo, "albedo", {"R", "G", "B"}},
                                        {Aov::normal, "normal", {"X", "Y", "Z"}},
                                        {Aov::depth, "depth", {"Z"}},
                                        {Aov::position, "position", {"X", "Y", "Z"}},
                                        {Aov::direct, "direct", {"R", "G", "B"}},
                                        {Aov::indirect, "indirect", {"R", "G", "B"}},
                                        {Aov::shadow_rays, "shadow_rays", {"V"}},
                                        {Aov::sources, "sources", {"R", "G", "B"}},
                                        {Aov::error, "error", {"V"}},
                                        {Aov::viewing_error, "viewing_error", {"V"}}};
  return rows;
}

const AovRow& row_of(Aov aov) {
  const auto it = std::find_if(aov_rows().begin(), aov_rows().end(),
                               [&](const AovRow& row) { return row.aov == aov; });
  TROFFER_CHECK(it != aov_rows().end());
  return *it;
}

std::optional<Aov> find_aov(std::string_view name) {
  for (const AovRow& row : aov_rows())
    if (row.name == name) return row.aov;
  return std::nullopt;
}

std::string aov_names() {
  std::string names;
  for (const AovRow& row : aov_rows()) names.append(names.empty() ? "" : ",").append(row.name);
  return names;
}

}  // namespace troffer
