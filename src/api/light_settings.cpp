#include "api/light_settings.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "base/suggestion.h"
#include "render/aov_rows.h"

namespace troffer::api {

namespace {

constexpr int most_samples = 1 << 24, most_threads = 4096;

}  // namespace

Method method_of(const LightOptions& options) {
  const std::optional<Method> m = Method::find(options.method);
  if (!m) throw UsageError("there is no method '" + options.method + "', but " + Method::names());
  return *m;
}

Indirect indirect_of(const LightOptions& options) {
  const std::optional<Indirect> i = Indirect::find(options.indirect);
  if (!i) throw UsageError("indirect is 'auto', 'none', 'radiosity' or 'cells'");
  return *i;
}

void check_ranges(const LightOptions& o) {
  if (!(o.error > 0 && o.error <= 1)) throw UsageError("error lies above 0, and not above 1");
  in_range(o.spp, 0, most_samples, "spp");
  if (o.depth < -1) throw UsageError("depth is not negative, or -1 for no limit");
  in_range(o.threads, 0, most_threads, "threads");
}

Kj92Settings kj92_of(const Kj92Options& o, const troffer::Scene& scene) {
  Kj92Settings s;
  BintreeOptions& tree = s.sampling.tree;
  if (o.variance) tree.allowed_variance = float(in_range(*o.variance, 0, 1000, "variance"));
  if (o.most_rays) tree.most_rays = int(in_range(*o.most_rays, 1, 1 << 16, "most_rays"));
  if (o.mean_change) tree.mean_change = float(in_range(*o.mean_change, 0, 1, "mean_change"));
  if (o.level_difference)
    tree.level_difference = int(in_range(*o.level_difference, 0, 24, "level_difference"));
  if (o.probe_rays) s.sampling.probe_rays = int(in_range(*o.probe_rays, 1, 1 << 10, "probe_rays"));
  s.sampling.has_coherence = o.has_coherence;
  s.sampling.uses_ratio = o.uses_ratio;
  s.selection.is_enabled = o.has_selection;
  if (!o.select.empty()) {
    s.selection.is_restricted = true;
    s.selection.only = lights_named(scene, o.select);
  }
  return s;
}

// Splits the text of Method::names(), "a, b or c".
std::vector<std::string> method_names() {
  std::string all = Method::names();
  const size_t last = all.find(" or ");
  if (last != std::string::npos) all.replace(last, 4, ", ");
  std::vector<std::string> names;
  for (size_t first = 0; first < all.size();) {
    const size_t end = std::min(all.find(", ", first), all.size());
    names.push_back(all.substr(first, end - first));
    first = end + 2;
  }
  return names;
}

std::vector<std::string> layer_names() {
  std::vector<std::string> names;
  for (const AovRow& row : aov_rows()) names.emplace_back(row.name);
  return names;
}

}  // namespace troffer::api
