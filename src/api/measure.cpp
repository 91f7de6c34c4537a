// measure() of the public interface.
#include "render/measure.h"

#include <fmt/format.h>

#include <atomic>
#include <cmath>

#include "api/light_settings.h"
#include "api/measuring_points.h"
#include "api/scene_impl.h"
#include "api/watched.h"
#include "base/error.h"
#include "troffer/measure.h"

namespace troffer::api {

std::vector<MeasuringPoint> measuring_points(const std::vector<MeasurePoint>& points,
                                             const std::string& owner) {
  std::vector<MeasuringPoint> made;
  made.reserve(points.size());
  for (size_t i = 0; i < points.size(); ++i) {
    const std::string its = fmt::format("{}point {}: its ", owner, i);
    const Vec3d normal = direction(points[i].normal, its + "normal");
    (void)normal;  // checked only: the normal keeps its given length
    made.push_back({place(points[i].position, its + "position"), Vec3(vec(points[i].normal))});
  }
  return made;
}

Measurements measure(Scene& scene, const std::vector<MeasurePoint>& points,
                     const LightOptions& options, const Progress& progress) {
  ScriptScene& script = scene.impl().script;
  MeasureOptions o;
  set_light(options, script.scene(), o);
  o.spp = options.spp;
  const std::vector<MeasuringPoint> at = measuring_points(points);
  MeasureResult found;
  std::atomic<double> fraction{0};
  double shown = 0;
  const auto work = [&](StopFlag& stop) {
    const std::shared_ptr<const PreparedScene> prepared = script.prepared();
    o.kj92.selection.only = kj92_of(options.kj92, prepared->scene).selection.only;
    const std::unique_ptr<Preparation> preparation = prepared_for(*prepared, o, stop);
    o.preparation = preparation.get();
    found = troffer::measure(
        *prepared, at, o, [&](double f) { fraction = f; }, stop);
  };
  run_watched(work, [&](StopFlag& stop) {
    shown = std::max(shown, fraction.load());
    if (progress && !progress(shown)) stop = true;
  });
  Measurements made;
  made.values.reserve(found.values.size());
  for (const troffer::Measurement& m : found.values)
    made.values.push_back({m.illuminance_lx, m.standard_error, color(m.irradiance)});
  made.is_complete = found.is_complete;
  made.is_measured = found.is_measured;
  made.shadow_rays = found.counters.shadow_rays;
  made.in_surfaces = found.in_surfaces;
  return made;
}

}  // namespace troffer::api
