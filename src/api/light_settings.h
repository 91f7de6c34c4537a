// The façade's options of methods as those of the renderer.
#pragma once

#include <string>

#include "api/values.h"
#include "methods/methods.h"
#include "render/preparation.h"
#include "troffer/render.h"

namespace troffer::api {

// UsageError names what is unknown or out of range.
Method method_of(const LightOptions& options);
Indirect indirect_of(const LightOptions& options);
void check_ranges(const LightOptions& options);
// `scene`: whose lights Kj92Options::select names.
Kj92Settings kj92_of(const Kj92Options& options, const troffer::Scene& scene);

// Sets what pictures and measurements have in common.
template <class Options>
void set_light(const LightOptions& from, const troffer::Scene& scene, Options& to) {
  check_ranges(from);
  to.method = method_of(from);
  to.indirect = indirect_of(from);
  to.kj92 = kj92_of(from.kj92, scene);
  to.error = from.error;
  to.depth = from.depth;
  to.threads = from.threads;
  to.seed = from.seed;
}

// The radiosity that a method stands on; null for other methods, and where `stop` was set.
template <class Options>
std::unique_ptr<Preparation> prepared_for(const PreparedScene& scene, const Options& o,
                                          const StopFlag& stop) {
  return prepare(
      scene, o.method, o.kj92, o.indirect, std::nullopt, o.threads, [](double) {}, stop);
}

}  // namespace troffer::api
