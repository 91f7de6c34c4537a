// Feeds libFuzzer's data to a reader of lists, and the result to its users: weather files, lists of
// luminaires and points, files for `report`, parts of a picture. They may be refused with
// InputError, or with UsageError if the numbers contradict each other. Accepted numbers must be
// finite.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "app/part_note.h"
#include "app/points_csv.h"
#include "app/report_files.h"
#include "base/error.h"
#include "image/layered_image.h"
#include "input_folder.h"
#include "lighting/daylight_options.h"
#include "lighting/luminaire_list.h"
#include "report/report.h"
#include "report/room.h"
#include "support/beam_ies.h"

namespace {

using namespace troffer;

constexpr std::string_view ending = FUZZ_ENDING;
const StopFlag never = false;

void check_finite(const Vec3d& v) {
  if (!std::isfinite(v.x + v.y + v.z)) std::abort();
}

// Checks that lights are usable: prepares them and lights a point.
void sample_direct_light(Scene scene) {
  for (const Light& e : scene.lights) {
    check_finite(Vec3d(e.position));
    check_finite(Vec3d(e.direction));
    if (!is_finite(e.radiance)) std::abort();
  }
  if (scene.lights.size() > 32) return;
  const uint32_t grey = test::add_diffuse(scene, Rgb{0.5f});
  test::add_quad(scene, grey, {Vec3{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}});
  MeasureOptions options;
  options.method = Method::path;
  options.spp = 2;
  options.threads = 1;
  measure(PreparedScene(std::move(scene)), {{{0, 0, 0.5}, {0, 0, 1}}}, options, {}, never);
}

void read_weather_of(const std::string& path) {
  for (const bool is_dated : {true, false}) {
    DaylightOptions options;
    options.weather = path;
    (is_dated ? options.date : options.at) =
        is_dated ? "06-21T11:30" : "48.2,16.4,2005-06-21T11:30+01:00";
    options.up = "0,0,1";
    Scene scene;
    add_daylight(scene, options);
    sample_direct_light(std::move(scene));
  }
}

void read_list(const InputFolder& folder, const std::string& path) {
  static const std::string lamp = test::beam_ies(1, {0, 45, 90}, {0});
  folder.write("a.ies", lamp.data(), lamp.size());
  Scene scene;
  add_luminaire_list(scene, path, {0, 0, -1});
  watts_of_luminaire_list(path, {0, 0, -1});
  sample_direct_light(std::move(scene));
}

void measure_few(const std::string& path) {
  static const PreparedScene room{test::small_office()};
  constexpr size_t most = 4;
  std::vector<MeasuringPoint> points = read_points(path);
  if (points.size() > most) points.resize(most);
  MeasureOptions options;
  options.method = Method::path;
  options.spp = 2;
  options.threads = 1;
  if (!points.empty()) measure(room, points, options, {}, never);
}

void assess_asked(const std::string& path) {
  static const Scene room = test::small_office();
  Report report;
  AssessmentOptions& o = report.options;
  read_report_file(path, o);
  o.measure.method = Method::path;
  o.measure.spp = 2;
  o.measure.threads = 1;
  o.has_contributions = o.has_cylindrical = false;
  report.assessment = assess(room, o, {}, never);
  for (const SurfaceResult& s : report.assessment.surfaces)
    for (const GridPoint& p : s.grid.points) check_finite(p.position);
  report_json(report);
  report_page(report);
  report_points(report);
}

void read(const InputFolder& folder, const std::string& path) {
  if constexpr (ending == "epw")
    read_weather_of(path);
  else if constexpr (ending == "luminaires")
    read_list(folder, path);
  else if constexpr (ending == "points")
    measure_few(path);
  else if constexpr (ending == "report")
    assess_asked(path);
  else
    parse_part_note(read_layers(path, size_t(1) << 20).note, path);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const InputFolder folder;
  const std::string path = folder.write("input." + std::string(ending), data, size);
  try {
    read(folder, path);
  } catch (const InputError&) {
    return 0;
  } catch (const UsageError&) {
    return 0;
  }
  return 0;
}
