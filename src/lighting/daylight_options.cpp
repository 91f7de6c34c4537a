#include "lighting/daylight_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/sun_position.h"
#include "daylight/sky_lights.h"
#include "import/environment_file.h"
#include "import/light_radius.h"
#include "lighting/attached_luminaires.h"
#include "lighting/dimming.h"
#include "lighting/luminaire_list.h"
#include "lighting/option_text.h"
#include "lighting/portal_options.h"
#include "lighting/weather.h"

namespace troffer {

namespace {

constexpr double most_lx = 1e9;

[[noreturn]] void fail(const char* option, const std::string& text, const char* expected) {
  throw UsageError(fmt::format("{}: cannot read '{}' as {}", option, text, expected));
}

// Returns the numbers in parts[first] and after; between `least` and `most` of them are expected.
std::vector<double> numbers(const std::vector<std::string>& parts, size_t first, size_t least,
                            size_t most, const char* option, const std::string& text,
                            const char* expected) {
  std::vector<double> v;
  for (size_t i = first; i < parts.size(); ++i) {
    const auto number = parse_number(parts[i]);
    if (!number) fail(option, text, expected);
    v.push_back(*number);
  }
  if (v.size() < least || v.size() > most) fail(option, text, expected);
  return v;
}

bool is_light(double lx) {
  return lx >= 0 && lx <= most_lx;
}

SkyRequest parse_sky(const std::string& text) {
  static constexpr const char* expected =
      "even, overcast, clear or cie:1 … cie:15, each with ,LUX or without, perez:DNI,DHI, or none";
  const std::vector<std::string> parts = split_text(text, ',');
  const std::vector<std::string> name = split_text(parts[0], ':');
  SkyRequest r;
  if (name[0] == "perez" && name.size() == 2) {
    const auto v = numbers(split_text(text.substr(6), ','), 0, 2, 2, "--sky", text, expected);
    if (!(v[0] >= 0 && v[0] <= 2000 && v[1] >= 0 && v[1] <= 2000 && v[0] + v[1] > 0))
      fail("--sky", text, expected);
    r.kind = SkyKind::perez;
    r.direct_normal = v[0];
    r.diffuse_horizontal = v[1];
    return r;
  }
  const auto lux = numbers(parts, 1, 0, 1, "--sky", text, expected);
  if (!lux.empty()) r.diffuse_lx = lux[0];
  if (r.diffuse_lx && !is_light(*r.diffuse_lx)) fail("--sky", text, expected);
  if (name[0] == "even" && name.size() == 1) return r;
  r.kind = SkyKind::cie;
  const auto type = name[0] == "overcast" ? 1 : name[0] == "clear" ? 12 : 0;
  if (type > 0 && name.size() == 1) {
    r.cie_type = type;
    return r;
  }
  const auto number = name[0] == "cie" && name.size() == 2 ? parse_number(name[1]) : std::nullopt;
  if (!number || *number != std::floor(*number) || *number < 1 || *number > 15)
    fail("--sky", text, expected);
  r.cie_type = int(*number);
  return r;
}

struct PlaceAndTime {
  double latitude_deg = 0, longitude_deg = 0, julian_day_ut = 0;
};

// Parses an angle within ±most degrees.
double parse_degrees(const std::string& part, const char* what, double most,
                     const std::string& text) {
  const size_t first = part.find_first_not_of(' '), last = part.find_last_not_of(' ');
  const auto v =
      first == part.npos ? std::nullopt : parse_number(part.substr(first, last - first + 1));
  if (!v)
    throw UsageError(fmt::format("--at: '{}': the {} '{}' is not a number", text, what, part));
  if (std::abs(*v) > most)
    throw UsageError(fmt::format("--at: '{}': the {} {} is not between -{} and {} degrees", text,
                                 what, *v, most, most));
  return *v;
}

PlaceAndTime parse_at(const std::string& text) {
  const std::vector<std::string> parts = split_text(text, ',');
  if (parts.size() != 3)
    throw UsageError(fmt::format(
        "--at: '{}' has {} part{} between commas, not three: LATITUDE,LONGITUDE,TIME, such as "
        "48.2,16.4,2026-06-21T12:00+02:00",
        text, parts.size(), parts.size() == 1 ? "" : "s"));
  const double latitude = parse_degrees(parts[0], "latitude", 90, text);
  const double longitude = parse_degrees(parts[1], "longitude", 360, text);
  return {latitude, longitude, parse_time(parts[2], "--at")};
}

std::optional<SunRequest> parse_sun(const DaylightOptions& o) {
  if (!o.sun.empty() && !o.at.empty()) throw UsageError("--sun and --at exclude each other");
  SunRequest sun;
  if (!o.sun.empty()) {
    static constexpr const char* expected = "AZIMUTH,ALTITUDE[,LUX], in degrees and lx";
    const auto v = numbers(split_text(o.sun, ','), 0, 2, 3, "--sun", o.sun, expected);
    if (std::abs(v[0]) > 360 || std::abs(v[1]) > 90) fail("--sun", o.sun, expected);
    sun.azimuth_deg = v[0];
    sun.altitude_deg = v[1];
    if (v.size() == 3) sun.direct_lx = v[2];
    if (v.size() == 3 && !is_light(v[2])) fail("--sun", o.sun, expected);
    return sun;
  }
  if (o.at.empty()) return std::nullopt;
  const PlaceAndTime at = parse_at(o.at);
  const SunPosition p = sun_position(at.latitude_deg, at.longitude_deg, at.julian_day_ut);
  sun.azimuth_deg = p.azimuth_deg;
  sun.altitude_deg = p.altitude_deg;
  sun.distance_au = p.distance_au;
  return sun;
}

// Adds sky and sun of a weather file; nothing at night.
void add_weather(Scene& scene, const DaylightOptions& o, const Compass& compass) {
  if (!o.sky.empty() || !o.sun.empty() || o.turbidity > 0)
    throw UsageError("--weather excludes --sky, --sun and --turbidity");
  if (o.date.empty() == o.at.empty())
    throw UsageError("--weather needs --date MM-DDTHH:MM, or --at LATITUDE,LONGITUDE,TIME");
  Weather weather;
  SunPosition p;
  if (o.at.empty()) {
    weather = read_weather(o.weather, o.date);
    p = sun_position(weather.latitude_deg, weather.longitude_deg, weather.julian_day_ut);
  } else {
    const PlaceAndTime at = parse_at(o.at);
    weather = read_weather(o.weather, at.julian_day_ut);
    p = sun_position(at.latitude_deg, at.longitude_deg, at.julian_day_ut);
  }
  if (!(p.altitude_deg > 0)) {
    scene.warnings.add(
        fmt::format("--weather: the sun is {:.2f} degrees below the horizon: neither it nor the "
                    "sky gives light",
                    -p.altitude_deg));
    return;
  }
  if (!(weather.diffuse_horizontal > 0 || weather.direct_normal > 0)) {
    scene.warnings.add(
        weather.global_horizontal > 0
            ? fmt::format("--weather: this hour has {:.5g} W/m2 of global irradiance but neither "
                          "direct nor diffuse irradiance: the sky stays dark",
                          weather.global_horizontal)
            : std::string("--weather: no light comes from sky and sun at that hour"));
    return;
  }
  SkyRequest request;
  request.kind = SkyKind::perez;
  request.direct_normal = weather.direct_normal;
  request.diffuse_horizontal = weather.diffuse_horizontal;
  request.sun = SunRequest{p.azimuth_deg, p.altitude_deg, p.distance_au, {}};
  request.ground_reflectance = o.ground;
  add_sky(scene, request, compass);
}

void add_asked_sky(Scene& scene, const DaylightOptions& o, const Compass& compass) {
  SkyRequest request;
  request.sun = parse_sun(o);
  const bool has_sky = !o.sky.empty() && o.sky != "none";
  if (has_sky) {
    const auto sun = request.sun;
    request = parse_sky(o.sky);
    request.sun = sun;
  } else if (request.sun) {
    request.kind = SkyKind::cie;
    request.cie_type = 12;
    // An environment image contains its own sky and ground.
    if (o.sky == "none" || !o.environment.empty()) request.diffuse_lx = 0;
  }
  if (o.turbidity > 0) {
    const bool is_clear = request.kind == SkyKind::cie && request.cie_type >= 11;
    if (!request.sun || !is_clear)
      throw UsageError(
          "--turbidity goes with --sun or --at and a clear sky (clear, cie:11 … cie:15)");
    request.turbidity = o.turbidity;
  }
  const bool has_own_ground = !has_sky && !o.environment.empty();
  request.ground_reflectance = has_own_ground ? 0 : o.ground;
  if (has_sky && needs_sun(request) && !request.sun)
    throw UsageError("--sky " + o.sky + " depends on the position of the sun: give --sun or --at");
  if (request.sun && !(request.sun->altitude_deg > 0)) {
    // With the sun below the horizon, only a sky that is independent of the sun keeps its requested
    // brightness.
    const bool is_left = has_sky && request.diffuse_lx && !needs_sun(request);
    scene.warnings.add(fmt::format(
        "the sun is {:.2f} degrees below the horizon: {}", std::abs(request.sun->altitude_deg),
        is_left ? "it gives no light" : "neither it nor a sky gives light"));
    if (!is_left) return;
    request.sun.reset();
  }
  const size_t before = scene.lights.size();
  add_sky(scene, request, compass);
  const bool has_sun = scene.lights.size() > before && scene.lights.back().kind == LightKind::sun;
  const bool is_dark = request.sun && request.sun->direct_lx && *request.sun->direct_lx == 0;
  if (request.sun && !has_sun && !is_dark)
    scene.warnings.add("--sky " + o.sky +
                       " hides the sun (--sun AZIMUTH,ALTITUDE,LUX shows it anyway)");
}

void warn_of_unused(Scene& scene, const DaylightOptions& o) {
  if (o.environment_rotation_deg != 0 && o.environment.empty())
    scene.warnings.add("--environment-rotation does nothing without --environment");
  const bool has_sky = std::any_of(scene.lights.begin(), scene.lights.end(), [](const Light& e) {
    return e.kind == LightKind::sky || e.kind == LightKind::sun;
  });
  if (o.north_deg != 0 && !has_sky && o.environment.empty())
    scene.warnings.add("--north does nothing without a sky or a sun");
  if (o.ground != DaylightOptions().ground && !has_sky)
    scene.warnings.add("--ground does nothing without a sky");
}

}  // namespace

const char* const default_sky_warning =
    "the scene has no light: a uniform sky of 10000 lx is added (--sky chooses another, --sky none "
    "keeps it dark)";

Vec3d parse_vector(const std::string& text, const char* option) {
  Vec3d v;
  const char* p = text.c_str();
  for (size_t a = 0; a < 3; ++a) {
    char* end = nullptr;
    v[a] = std::strtod(p, &end);
    const bool is_last = a == 2;
    if (end == p || *end != (is_last ? '\0' : ',') || !(std::abs(v[a]) <= 1e9))
      throw UsageError(fmt::format("{}: cannot read '{}' as x,y,z", option, text));
    p = end + 1;
  }
  return v;
}

Vec3 parse_up(const std::string& text) {
  const bool has_sign = !text.empty() && (text[0] == '-' || text[0] == '+');
  const std::string axis = has_sign ? text.substr(1) : text;
  if (axis.size() == 1 && axis[0] >= 'x' && axis[0] <= 'z') {
    Vec3 up{0};
    up[size_t(axis[0] - 'x')] = text[0] == '-' ? -1.0f : 1.0f;
    return up;
  }
  if (text.find(',') == std::string::npos)
    throw UsageError(
        fmt::format("--up: cannot read '{}': write an axis, such as z or -y, or x,y,z", text));
  const Vec3 up(parse_vector(text, "--up"));
  if (!(length(up) > 0)) throw UsageError("--up has no length");
  return up;
}

bool depends_on_up(const DaylightOptions& o) {
  return (!o.sky.empty() && o.sky != "none") || !o.sun.empty() || !o.at.empty() ||
         !o.weather.empty() || !o.environment.empty() || !o.luminaires.empty() ||
         !o.luminaire_list.empty();
}

void add_daylight(Scene& scene, const DaylightOptions& o) {
  add_daylight(scene, o, o.up.empty() ? decide_up(scene) : requested_up(parse_up(o.up)));
}

void add_daylight(Scene& scene, const DaylightOptions& o, const UpDecision& up) {
  // The command line's range checks let NaN pass.
  for (const double v :
       {o.north_deg, o.ground, o.environment_rotation_deg, o.light_radius, o.turbidity})
    if (!std::isfinite(v))
      throw UsageError(
          "--north, --ground, --environment-rotation, --light-radius and --turbidity: not a "
          "number");
  const Compass compass = make_compass(up.up, o.north_deg, is_mirrored(scene));
  bool is_up_used = depends_on_up(o);
  attach_luminaires(scene, o.luminaires, Vec3(-compass.up));
  if (!o.luminaire_list.empty()) add_luminaire_list(scene, o.luminaire_list, Vec3(-compass.up));
  if (o.light_radius > 0) give_radius(scene, o.light_radius);
  const bool had_light = shines(scene);
  if (!o.environment.empty()) {
    const size_t comma = o.environment.rfind(',');
    const auto scale =
        comma == std::string::npos ? std::nullopt : parse_number(o.environment.substr(comma + 1));
    if (scale && !(*scale >= 0 && *scale <= 1e9))
      throw UsageError("--environment: its scale must lie between 0 and 1e9");
    add_environment(
        scene,
        read_environment(scale ? o.environment.substr(0, comma) : o.environment, scene.warnings),
        scale.value_or(1), o.environment_rotation_deg, compass);
  }
  const bool is_asked = !o.sky.empty() || !o.sun.empty() || !o.at.empty();
  if (!o.date.empty() && o.weather.empty()) throw UsageError("--date goes with --weather");
  if (o.turbidity > 0 && o.weather.empty() && o.sun.empty() && o.at.empty())
    throw UsageError("--turbidity goes with --sun or --at");
  if (!o.weather.empty()) {
    add_weather(scene, o, compass);
  } else if ((is_asked && o.sky != "none") || !o.sun.empty() || !o.at.empty()) {
    add_asked_sky(scene, o, compass);
  } else if (!had_light && o.adds_default_sky && o.environment.empty() && o.sky != "none" &&
             !bounds(scene).is_empty()) {
    SkyRequest even;
    even.ground_reflectance = o.ground;
    add_sky(scene, even, compass);
    scene.warnings.add(default_sky_warning);
    is_up_used = true;
  }
  if (is_up_used && !up.doubt.empty()) scene.warnings.add(up.doubt);
  add_portals(scene, o.portals);
  dim_lights(scene, o.dims);
  warn_of_unused(scene, o);
}

void check_light(const Scene& scene, const DaylightOptions& o,
                 const std::vector<std::string>& lights) {
  if (o.adds_default_sky || shines(scene) || (o.requests_sky() && lights.empty()) ||
      o.sky == "none")
    return;
  const char* const why = !o.dims.empty()   ? "; --dim leaves no light"
                          : !lights.empty() ? "; --light leaves no light"
                          : !o.luminaire_list.empty()
                              ? "; the luminaires of the list are dimmed to 0"
                          : scene.lights.empty() ? ", or only lights of strength 0"
                                                 : "; its lights have strength 0";
  throw InputError(scene.file, 0, 0,
                   fmt::format("no light shines in it{}: give lamps a strength, add luminaires "
                               "(--luminaire, --luminaires) or daylight (--sky, --sun, --at, "
                               "--weather), or ask for darkness (--sky none)",
                               why));
}

}  // namespace troffer
