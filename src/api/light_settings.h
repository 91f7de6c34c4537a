// Converts the public LightOptions to options of the renderer and checks their ranges. render() and
// measure() of the public interface use it. All functions throw UsageError that names an unknown or
// invalid value.
#pragma once

#include <string>

#include "api/values.h"
#include "methods/methods.h"
#include "render/preparation.h"
#include "troffer/render.h"

namespace troffer::api {

Method method_of(const LightOptions& options);
Indirect indirect_of(const LightOptions& options);
void check_ranges(const LightOptions& options);
// `scene` holds the lights that Kj92Options::select names.
Kj92Settings kj92_of(const Kj92Options& options, const troffer::Scene& scene);

// Sets the options that pictures and measurements have in common.
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

// Returns the radiosity solution that the method needs. Null if it needs none or `stop` is set.
template <class Options>
std::unique_ptr<Preparation> prepared_for(const PreparedScene& scene, const Options& o,
                                          const StopFlag& stop) {
  return prepare(
      scene, o.method, o.kj92, o.indirect, std::nullopt, o.threads, [](double) {}, stop);
}

}  // namespace troffer::api
