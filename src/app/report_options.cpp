#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "app/command_report.h"
#include "app/common_options.h"
#include "app/daylight_flags.h"
#include "app/option_values.h"
#include "app/report_files.h"
#include "base/error.h"
#include "base/suggestion.h"

namespace troffer {

namespace {

// Parses "NODE[:PROFILE]". Names may contain colons, so a suffix that is no profile belongs to the
// name.
SurfaceRequest parse_surface(const std::string& text, const std::vector<Profile>& profiles) {
  SurfaceRequest r;
  const size_t colon = text.rfind(':');
  const bool has_profile = colon != std::string::npos && colon > 0 &&
                           find_profile(profiles, text.substr(colon + 1)) != nullptr;
  r.node = has_profile ? text.substr(0, colon) : text;
  if (has_profile) r.profile = text.substr(colon + 1);
  if (r.node.empty()) throw UsageError("--surface: a name is missing");
  return r;
}

PowerRequest parse_power(const std::string& text) {
  const size_t equals = text.rfind('=');
  if (equals != std::string::npos && equals > 0 && equals + 1 < text.size()) {
    char* end = nullptr;
    const double watts = std::strtod(text.c_str() + equals + 1, &end);
    if (*end == '\0' && watts >= 0 && watts <= 1e9) return {text.substr(0, equals), watts};
  }
  throw UsageError("--power: '" + text + "' is not NODE=WATTS");
}

Observer parse_observer(const std::string& text) {
  size_t comma = 0;
  for (int i = 0; i < 3 && comma != std::string::npos; ++i)
    comma = text.find(',', i == 0 ? 0 : comma + 1);
  if (comma == std::string::npos)
    throw UsageError("--observer: '" + text + "' is not X,Y,Z,DX,DY,DZ");
  Observer o{parse_vector(text.substr(0, comma), "--observer"),
             parse_vector(text.substr(comma + 1), "--observer")};
  if (!(length(o.direction) > 0)) throw UsageError("--observer: its direction has no length");
  o.direction = normalize(o.direction);
  return o;
}

// Quotes a word for a shell.
std::string in_quotes(const std::string& word) {
  const auto is_plain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           std::string_view("_-+=./,:@%").find(c) != std::string_view::npos;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

CLI::Option* add_switch(CLI::App& s, const char* name, std::string& value, const char* text) {
  return s.add_option(name, value, text)->check(one_of({"on", "off"}))->capture_default_str();
}

void add_what(CLI::App& s, ReportCommand& c) {
  s.add_option("--surface", c.surfaces,
               "Part of the scene to assess, and its task; may be repeated [desks and floors]")
      ->allow_extra_args(false);
  s.add_option(
       "--surfaces", c.surface_files,
       "JSON file of surfaces, observers and profiles, or .csv of surfaces; may be repeated")
      ->allow_extra_args(false);
  s.add_option("--profile", c.profile, "Task on desks and work planes, such as office-writing")
      ->capture_default_str();
  s.add_option("--maintenance", c.maintenance, "Maintenance factor of electric light")
      ->check(number_between(0.01, 1))
      ->capture_default_str();
  s.add_option("--work-plane", c.work_plane,
               "Height of work planes over floors without desks, in metres")
      ->check(number_between(0, 10))
      ->capture_default_str();
  s.add_option(
       "--power", c.power,
       "Watts of a luminaire; NODE* matches all names that begin with NODE; may be repeated")
      ->allow_extra_args(false);
  s.add_option(
       "--observer", c.observers,
       "Eye position and viewing direction for glare; may be repeated [chosen automatically]")
      ->allow_extra_args(false);
  s.add_option("--daylight-factor", c.daylight_factor,
               "Daylight factors; auto: if openings show the sky")
      ->check(one_of({"auto", "on", "off"}))
      ->capture_default_str();
  add_switch(s, "--contributions", c.contributions, "Each luminaire's share of the illuminance");
  add_switch(s, "--cylindrical", c.cylindrical, "Cylindrical illuminance");
}

void add_how(CLI::App& s, ReportCommand& c) {
  add_switch(s, "--pictures", c.pictures, "Luminance pictures");
  s.add_option("--camera", c.cameras, "Name of a picture's camera; may be repeated [the first]")
      ->allow_extra_args(false);
  s.add_option("--width", c.width, "Width of pictures in pixels")
      ->check(whole_number_between(16, 4096))
      ->capture_default_str();
  s.add_option("--picture-error", c.picture_error,
               "Allowed standard error of a pixel, relative to its light")
      ->check(number_between(1e-4, 1))
      ->capture_default_str();
  add_method(s, c.method);
  s.add_option("--spp", c.spp, "Samples per point")
      ->check(whole_number_between(2, 1 << 26))
      ->capture_default_str();
  s.add_option("--error", c.error,
               "certified: allowed standard error of a point, relative to its light")
      ->check(number_between(1e-6, 1))
      ->capture_default_str();
}

}  // namespace

void add_report(CLI::App& app, ReportCommand& c) {
  CLI::App* s = app.add_subcommand(
      "report", "Assess the lighting of a scene by EN 12464-1, as a page to print");
  add_scene_choice(*s, c.scene);
  s->add_option("-o,--output", c.output, "Folder for report.html, report.json, points.csv")
      ->required();
  s->add_option("--title", c.title, "Title [name of the scene's file]");
  s->add_option("--dated", c.date, "Date shown in the report, as text");
  s->add_option("--compare", c.compare,
                "report.json of another report: adds a comparison of both variants");
  add_what(*s, c);
  add_how(*s, c);
  add_light_choice(*s, c.lights);
  add_daylight_options(*s, c.daylight);
  c.daylight.adds_default_sky = false;  // no verdict may depend on a sky that nobody asked for
  add_threads(*s, c.threads);
  add_seed(*s, c.seed);
  s->add_flag("--quiet", c.is_quiet, "No progress bar, notes or warnings");
}

AssessmentOptions assessment_options(const ReportCommand& c, const Vec3& up) {
  for (const double v : {c.maintenance, c.work_plane, c.picture_error, c.error})
    if (!std::isfinite(v)) throw UsageError("report: an option is not a number");
  AssessmentOptions o;
  o.measure.method = parse_method(c.method);
  o.measure.spp = c.spp;
  o.measure.error = c.error;
  o.measure.threads = c.threads;
  o.measure.seed = c.seed;
  o.up = normalize(Vec3d(up));
  o.maintenance = c.maintenance;
  o.work_plane = c.work_plane;
  o.profile = c.profile;
  o.has_cylindrical = c.cylindrical == "on";
  o.has_contributions = c.contributions == "on";
  o.is_factor_forced = c.daylight_factor == "on";
  for (const std::string& file : c.surface_files) read_report_file(file, o);
  for (const std::string& s : c.surfaces) o.surfaces.push_back(parse_surface(s, o.profiles));
  for (const std::string& p : c.power) o.power.push_back(parse_power(p));
  for (const std::string& e : c.observers) o.observers.push_back(parse_observer(e));
  if (find_profile(o.profiles, o.profile) == nullptr) {
    std::vector<std::string> ids;
    for (const Profile& p : o.profiles) ids.push_back(p.id);
    throw UsageError("--profile: there is no '" + o.profile + "'" + did_you_mean(o.profile, ids) +
                     " (" + profile_ids(o.profiles) + ")");
  }
  return o;
}

std::string command_text(int argc, const char* const* argv) {
  std::string command = "troffer";
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.starts_with("--threads=")) continue;
    if (word == "--threads")
      ++i;
    else
      command += " " + in_quotes(word);
  }
  return command;
}

}  // namespace troffer
