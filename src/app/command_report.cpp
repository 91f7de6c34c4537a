#include "app/command_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>

#include "app/other_report.h"
#include "app/output_guard.h"
#include "app/outputs.h"
#include "app/printable.h"
#include "app/process.h"
#include "app/progress.h"
#include "app/report_folder.h"
#include "app/signals.h"
#include "app/unfinished.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/wildcard.h"
#include "image/output_set.h"
#include "image/read_image.h"
#include "import/file.h"
#include "import/luminaire/luminaire.h"
#include "lighting/attached_luminaires.h"
#include "lighting/dimming.h"
#include "lighting/luminaire_list.h"
#include "render/camera.h"
#include "render/framing.h"
#include "render/placement.h"
#include "report/plan_view.h"
#include "report/report.h"
#include "report/sha256.h"
#include "scene/names.h"
#include "scene/orientation.h"

namespace troffer {

namespace {

namespace fs = std::filesystem;

// Returns hashes of all files that were read, the scene's first.
std::vector<InputHash> hashes_of(const ReportCommand& c, const FilesRead& read) {
  constexpr size_t most_bytes = size_t(1) << 33;
  std::vector<std::string> files = read.paths();
  std::stable_partition(files.begin(), files.end(),
                        [&](const std::string& f) { return f == c.scene.file; });
  std::vector<InputHash> hashes;
  for (const std::string& f : files) {
    const std::vector<uint8_t> bytes = read_file_bytes(f, most_bytes);
    hashes.push_back({f, bytes.size(), sha256(bytes)});
  }
  return hashes;
}

// Returns the scene under the overcast sky of daylight factors, and no other light.
Scene overcast_scene(const ReportCommand& c) {
  DaylightOptions sky = c.daylight;
  sky.sky = fmt::format("overcast,{}", overcast_lx);
  sky.sun = sky.at = sky.weather = sky.date = sky.environment = "";
  sky.turbidity = 0;
  sky.dims.clear();  // the sky is not dimmed, and luminaires are off
  UpUse same;
  const Scene scene = with_daylight_apart(load_scene(c.scene, {}, &sky, true, same));
  std::vector<std::string> names;
  for (const Light& e : scene.lights)
    if (e.kind == LightKind::sky) names.push_back(e.name);
  return with_only_lights(scene, names);
}

// Returns the cameras with these names.
std::vector<Camera> named_cameras(const Scene& scene, const std::vector<std::string>& names) {
  std::vector<Camera> chosen;
  for (const std::string& name : names) {
    const auto at = std::find_if(scene.cameras.begin(), scene.cameras.end(),
                                 [&](const Camera& e) { return e.name == name; });
    if (at == scene.cameras.end()) throw UsageError(no_camera_named(scene, name));
    chosen.push_back(*at);
  }
  return chosen;
}

std::vector<Camera> cameras_of(const PreparedScene& scene, const ReportCommand& c, const Vec3& up) {
  const std::vector<Camera>& all = scene.scene.cameras;
  if (!c.cameras.empty()) return named_cameras(scene.scene, c.cameras);
  return {all.empty() ? framing_camera(scene, up) : all.front()};
}

// Renders the pictures. Returns false if stopped.
bool add_pictures(const PreparedScene& scene, const ReportCommand& c, const Vec3& up,
                  const StopFlag& stop, Report& report) {
  for (const Camera& camera : cameras_of(scene, c, up)) {
    RenderOptions options;
    options.method = report.options.measure.method;
    options.indirect = Indirect::automatic;
    options.error = c.picture_error;
    options.threads = c.threads;
    options.seed = c.seed;
    const ImageSize usual = image_size(camera, 0, 0);
    options.width = c.width;
    options.height = std::max(1, int(std::lround(double(c.width) * usual.height / usual.width)));
    check_options(scene, camera, options);
    ProgressBar bar("picture", c.is_quiet);
    report.pictures.push_back(make_picture(
        scene, camera, options, [&](double f) { bar.update(f); }, stop));
    if (!report.pictures.back().is_complete) return false;
  }
  return true;
}

// Returns the power that luminaire files state; values of the command line come after them and
// override them.
std::vector<PowerRequest> power_of_files(const ReportCommand& c, const Scene& scene,
                                         const Vec3& up) {
  std::vector<PowerRequest> power;
  const auto add = [&](const std::string& name, double watts) {
    const bool is_lit = std::any_of(scene.lights.begin(), scene.lights.end(),
                                    [&](const Light& e) { return fits_wildcard(e.name, name); });
    if (is_lit && watts > 0) power.push_back({name, watts});
  };
  for (const auto& [node, watts] : watts_of_luminaires(c.daylight.luminaires)) add(node, watts);
  if (c.daylight.luminaire_list.empty()) return power;
  const std::vector<double> listed = watts_of_luminaire_list(c.daylight.luminaire_list, -up);
  for (size_t i = 0; i < listed.size(); ++i) add("luminaire" + std::to_string(i), listed[i]);
  return power;
}

// Stated power holds for undimmed lights: scales the power of lights that --dim changes.
void dim_power(const ReportCommand& c, const Scene& scene, std::vector<PowerRequest>& power) {
  if (c.daylight.dims.empty()) return;
  std::vector<PowerRequest> dimmed;
  for (const std::string& name : daylight_and_luminaires(scene).second) {
    const auto last = std::find_if(power.rbegin(), power.rend(), [&](const PowerRequest& r) {
      return fits_wildcard(name, r.name);
    });
    if (last != power.rend())
      dimmed.push_back({name, last->watts * dimming_of(name, c.daylight.dims)});
  }
  power.insert(power.end(), dimmed.begin(), dimmed.end());
}

// Returns product descriptions by photometric file.
std::map<std::string, std::string> products_of(const Scene& scene) {
  std::map<std::string, std::string> products;
  for (const LightWeb& web : scene.webs) {
    const std::string ending = lower_case_ending(web.name);
    std::error_code error;
    if ((ending != "ies" && ending != "ldt") || products.contains(web.name) ||
        !fs::is_regular_file(web.name, error))
      continue;
    WarningLog ignored;  // already reported when the scene was loaded
    products[web.name] = read_luminaire(web.name, ignored).description;
  }
  return products;
}

ReportInfo info_of(const ReportCommand& c, const Scene& scene, const FilesRead& read,
                   const UpDecision& up) {
  ReportInfo info;
  info.scene = c.scene.file;
  info.title = c.title.empty() ? fs::path(c.scene.file).filename().string() : c.title;
  info.date = c.date;
  info.version = TROFFER_VERSION;
  info.command = c.command_line;
  info.settings = {{"Method", c.method},
                   {"Samples per point", std::to_string(c.spp)},
                   {"Allowed error of a point", fmt::format("{}", c.error)},
                   {"Allowed error of a picture's pixel", fmt::format("{}", c.picture_error)},
                   {"Seed", std::to_string(c.seed)},
                   {"Profile", c.profile},
                   {"Maintenance factor", fmt::format("{}", c.maintenance)},
                   {"Upward direction", fmt::format("{}, {}", name_of_up(up.up), up.reason)}};
  info.inputs = hashes_of(c, read);
  for (const Warning& w : scene.warnings.entries())
    info.warnings.push_back(w.count > 1 ? fmt::format("{} ({} times)", w.text, w.count) : w.text);
  return info;
}

// Writes all files. The page comes last: people open it first.
void write_report(const Report& report, const ReportFolder& folder) {
  OutputSet files;
  for (size_t i = 0; i < report.pictures.size(); ++i) {
    files.add(folder.file(fmt::format("luminance{}.png", i + 1)), report.pictures[i].luminances);
    files.add(folder.file(fmt::format("picture{}.png", i + 1)), report.pictures[i].seen);
  }
  const std::vector<std::string> plans = report_plans(report);
  for (size_t i = 0; i < plans.size(); ++i)
    files.add(folder.file(i == 0 ? "plan.svg" : fmt::format("plan{}.svg", i + 1)), plans[i]);
  files.add(folder.file("points.csv"), report_points(report));
  files.add(folder.file("report.json"), report_json(report));
  files.add(folder.file("report.html"), report_page(report));
  files.commit();
}

// Warns of misplaced luminaires, on the page, too.
void note_misplaced(Scene& scene, bool is_quiet) {
  const PreparedScene prepared{Scene(scene)};
  warn_of_misplaced(prepared, is_quiet);
  for (const std::string& text : misplaced_luminaires(prepared)) scene.warnings.add(text);
}

// Guards the files of every report; the number of pictures is the number of cameras.
void guard_files(const ReportCommand& c, OutputGuard& guard) {
  guard.add_inputs(c.scene, c.daylight);
  for (const std::string& file : c.surface_files) guard.add_input("--surfaces", file);
  guard.add_input("--compare", c.compare);
  const auto add = [&](const std::string& name) {
    guard.add_output("-o:", (fs::path(c.output) / name).string());
  };
  for (const char* name : {"report.html", "report.json", "points.csv", "plan.svg"}) add(name);
  const size_t pictures = std::max<size_t>(c.cameras.size(), 1);
  for (size_t i = 1; i <= pictures && c.pictures == "on"; ++i)
    for (const char* name : {"luminance", "picture"}) add(fmt::format("{}{}.png", name, i));
}

int tell_interrupted(const ReportFolder& folder) {
  Unfinished left;
  left.note(folder.file("report.html"), "");
  fmt::print(stderr, "interrupted: {}\n", left.text());
  return exit_interrupted;
}

}  // namespace

int run_report(const ReportCommand& c) {
  const Clock::time_point start = Clock::now();
  OutputGuard guard;
  guard_files(c, guard);
  Report report;
  check_method(parse_method(c.method), Indirect::automatic, "");
  assessment_options(c, {0, 0, 1});  // reports mistakes before any work
  if (!c.compare.empty()) report.other = read_other_report(c.compare);
  const ThreadLimit limit(c.threads);
  UpUse use{true, {}};
  Scene scene = load_scene(c.scene, c.lights, &c.daylight, c.is_quiet, use);
  guard.check_files_read();
  note_misplaced(scene, c.is_quiet);
  const Vec3 up = use.decision.up;
  report.options = assessment_options(c, up);
  for (const std::string& note : report.options.notes) {
    if (!c.is_quiet) fmt::print(stderr, "warning: {}\n", printable(note));
    scene.warnings.add(note);
  }
  report.options.north = north_of(normalize(Vec3d(up)), c.daylight.north_deg, is_mirrored(scene));
  report.options.products = products_of(scene);
  const std::vector<PowerRequest> stated = power_of_files(c, scene, up);
  report.options.power.insert(report.options.power.begin(), stated.begin(), stated.end());
  dim_power(c, scene, report.options.power);
  if (c.daylight_factor != "off") report.options.overcast = [&] { return overcast_scene(c); };
  named_cameras(scene, c.cameras);
  report.info = info_of(c, scene, guard.files_read(), use.decision);
  const ReportFolder folder(c.output);
  const std::vector<OutputReservation> reserved = reserve_outputs(
      {folder.file("report.html"), folder.file("report.json")}, folder.file("points.csv"));
  const StopFlag& stop = install_stop_handlers();
  {
    ProgressBar bar("measure", c.is_quiet);
    report.assessment = assess(
        scene, report.options, [&](double f) { bar.update(f); }, stop);
  }
  if (!report.assessment.is_complete) return tell_interrupted(folder);
  if (c.pictures == "on" && !add_pictures(PreparedScene(Scene(scene)), c, up, stop, report))
    return tell_interrupted(folder);
  write_report(report, folder);
  if (!c.is_quiet)
    tell_done({folder.file("report.html"), folder.file("report.json"), folder.file("points.csv")},
              seconds_since(start), std::nullopt);
  return exit_done;
}

}  // namespace troffer
