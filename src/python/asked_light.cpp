#include "python/asked_light.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace troffer::bindings {

namespace py = pybind11;

namespace {

// Returns the path in a str or an os.PathLike.
std::string path(const py::handle& value) {
  return py::module_::import("os").attr("fspath")(value).cast<std::string>();
}

std::string text(const py::handle& value, const char* expected) {
  if (!py::isinstance<py::str>(value)) throw py::type_error(expected);
  return value.cast<std::string>();
}

// Returns the shortest text that reads back as the same number.
std::string number(const py::handle& value) {
  return fmt::format("{}", py::float_(py::reinterpret_borrow<py::object>(value)).cast<double>());
}

std::string joined(const std::vector<std::string>& parts) {
  return fmt::format("{}", fmt::join(parts, ","));
}

// Returns the items of a sequence. Throws TypeError for a str and for other objects.
std::vector<py::object> items(const py::handle& value, const char* expected) {
  if (py::isinstance<py::str>(value) || !py::hasattr(value, "__iter__"))
    throw py::type_error(expected);
  std::vector<py::object> all;
  for (const py::handle item : value) all.push_back(py::reinterpret_borrow<py::object>(item));
  return all;
}

std::string numbers(const py::handle& value, const char* expected) {
  std::vector<std::string> parts;
  for (const py::object& item : items(value, expected)) parts.push_back(number(item));
  return joined(parts);
}

// Accepts a path, or a tuple or list of a path and at most `most` numbers. None stands for an empty
// number; empty ones at the end are dropped.
std::vector<std::string> path_and_numbers(const py::handle& value, size_t most,
                                          const char* expected) {
  if (!py::isinstance<py::tuple>(value) && !py::isinstance<py::list>(value)) return {path(value)};
  const std::vector<py::object> all = items(value, expected);
  if (all.empty() || all.size() > 1 + most) throw py::type_error(expected);
  std::vector<std::string> parts{path(all[0])};
  for (size_t i = 1; i < all.size(); ++i)
    parts.push_back(all[i].is_none() ? std::string() : number(all[i]));
  while (parts.back().empty() && parts.size() > 1) parts.pop_back();
  return parts;
}

// Accepts a datetime with a time zone, or its text.
std::string moment(const py::handle& value) {
  if (!py::hasattr(value, "isoformat")) return text(value, "at: its time is a text or a datetime");
  if (value.attr("utcoffset")().is_none())
    throw api::UsageError("at: a datetime must have a time zone");
  return value.attr("isoformat")(py::arg("timespec") = "seconds").cast<std::string>();
}

std::string place_and_time(const py::handle& value) {
  static constexpr const char* expected = "at: (latitude, longitude, time)";
  const std::vector<py::object> all = items(value, expected);
  if (all.size() != 3) throw py::type_error(expected);
  return joined({number(all[0]), number(all[1]), moment(all[2])});
}

std::string date(const py::handle& value) {
  if (!py::hasattr(value, "strftime")) return text(value, "date: a text or a datetime");
  return value.attr("strftime")("%m-%dT%H:%M").cast<std::string>();
}

std::string portal(const py::handle& value) {
  static constexpr const char* expected = "portal: a name, or four corners (x, y, z), or several";
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  std::vector<std::string> corners;
  for (const py::object& corner : items(value, expected))
    corners.push_back(numbers(corner, expected));
  return joined(corners);
}

// Accepts one portal or several. The first item of one portal is a corner, so its items are
// numbers. The first item of several is a name or a list of corners.
std::vector<std::string> portals(const py::handle& value) {
  if (py::isinstance<py::str>(value)) return {portal(value)};
  const std::vector<py::object> all = items(value, "portal: a name, or four corners (x, y, z)");
  const bool is_named = !all.empty() && py::isinstance<py::str>(all[0]);
  if (!all.empty() && !is_named) {
    const std::vector<py::object> first = items(all[0], "portal: a corner is (x, y, z)");
    if (first.empty() || !py::hasattr(first[0], "__iter__")) return {portal(value)};
  }
  std::vector<std::string> texts;
  for (const py::object& item : all) texts.push_back(portal(item));
  return texts;
}

std::string environment(const py::handle& value) {
  std::vector<std::string> parts =
      path_and_numbers(value, 1, "environment: a path, or (path, scale)");
  // An explicit scale: otherwise a comma in the file name would be taken for the one before a
  // scale.
  if (parts.size() == 1) parts.emplace_back("1");
  return joined(parts);
}

std::vector<std::string> luminaires(const py::handle& value) {
  static constexpr const char* expected =
      "luminaires: {name: path}, {name: (path, lumens)} or {name: (path, lumens, kelvin)}";
  if (!py::isinstance<py::dict>(value)) throw py::type_error(expected);
  std::vector<std::string> all;
  for (const auto& [name, file] : py::reinterpret_borrow<py::dict>(value)) {
    const std::string node = text(name, expected);
    if (node.find('=') != std::string::npos)
      throw api::UsageError("luminaires: a name with '=' cannot be told from its file");
    all.push_back(node + "=" + joined(path_and_numbers(file, 2, expected)));
  }
  return all;
}

double in_range(const py::handle& value, double least, double most, const char* what) {
  const auto v = py::float_(py::reinterpret_borrow<py::object>(value)).cast<double>();
  if (!(v >= least && v <= most))
    throw api::UsageError(fmt::format("{} lies between {} and {}", what, least, most));
  return v;
}

using Taker = std::function<void(api::AddedLight&, const py::handle&)>;

const std::map<std::string, Taker>& takers() {
  using O = api::AddedLight;
  using V = const py::handle&;
  static const std::map<std::string, Taker> all{
      {"sky", [](O& o, V v) { o.sky = text(v, "sky: a text"); }},
      {"sun", [](O& o, V v) { o.sun = numbers(v, "sun: (azimuth, altitude) or with lux"); }},
      {"at", [](O& o, V v) { o.at = place_and_time(v); }},
      {"turbidity", [](O& o, V v) { o.turbidity = in_range(v, 1, 10, "turbidity"); }},
      {"weather", [](O& o, V v) { o.weather = path(v); }},
      {"date", [](O& o, V v) { o.date = date(v); }},
      {"north", [](O& o, V v) { o.north = in_range(v, -360, 360, "north"); }},
      {"ground", [](O& o, V v) { o.ground = in_range(v, 0, 1, "ground"); }},
      {"environment", [](O& o, V v) { o.environment = environment(v); }},
      {"environment_rotation",
       [](O& o, V v) { o.environment_rotation = in_range(v, -360, 360, "environment_rotation"); }},
      {"portal", [](O& o, V v) { o.portals = portals(v); }},
      {"luminaires", [](O& o, V v) { o.luminaires = luminaires(v); }},
      {"luminaire_list", [](O& o, V v) { o.luminaire_list = path(v); }},
      {"light_radius", [](O& o, V v) { o.light_radius = in_range(v, 1e-6, 1e6, "light_radius"); }},
      {"up", [](O& o, V v) { o.up = numbers(v, "up: (x, y, z)"); }},
  };
  return all;
}

}  // namespace

api::AddedLight added_light(const py::kwargs& asked) {
  api::AddedLight o;
  for (const auto& [key, value] : asked) {
    const auto name = py::cast<std::string>(key);
    const auto taker = takers().find(name);
    if (taker == takers().end()) throw py::type_error("add_light() has no argument '" + name + "'");
    if (!value.is_none()) taker->second(o, value);
  }
  return o;
}

const char* const add_light_help =
    "Adds light as the program's options do. Parts of the scene can become luminaires. Added "
    "lights behave like those of the file: light() finds them, and they have dimmers.\n\nsky: "
    "'even', 'overcast', 'clear', 'cie:1' to 'cie:15', each with or without ',LUX' (illuminance of "
    "a horizontal plane); 'perez:DNI,DHI' in W/m2; or 'none'\nsun: (azimuth, altitude) or "
    "(azimuth, altitude, lux), in degrees clockwise from north and above the horizon\nat: "
    "(latitude, longitude, time), which place the sun; time is a datetime with a time zone, or a "
    "string such as '2026-06-21T12:00+02:00'\nturbidity: Linke turbidity of a clear sky, 1 to "
    "10\nweather, date: path of an .epw file, and 'MM-DDTHH:MM' (or a datetime) in its standard "
    "time; `at` can replace `date`\nnorth: angle by which north lies clockwise from the file's "
    "north, degrees\nground: reflectance of the ground\nenvironment: path of an image, or (path, "
    "scale)\nenvironment_rotation: degrees\nportal: name of a part of the scene, or four corners "
    "(x, y, z), or a list of either\nluminaires: {name: path of .ies or .ldt}, or {name: (path, "
    "lumens[, kelvin])}; lumens may be None\nluminaire_list: path of a .csv list of luminaires to "
    "add\nlight_radius: metres; points and spots become spheres of this radius\nup: (x, y, "
    "z)\n\nRaises ValueError, TypeError, or InputError for files. The scene is then unchanged.";

}  // namespace troffer::bindings
