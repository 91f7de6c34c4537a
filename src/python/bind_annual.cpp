#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <memory>

#include "python/arguments.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "troffer/annual.h"

namespace troffer::bindings {

namespace py = pybind11;

namespace {

using api::AnnualDaylight;
using api::AnnualOptions;
using Hourly = std::vector<float> AnnualDaylight::*;

// A grid with the year that it belongs to.
struct GridOfYear {
  std::shared_ptr<const AnnualDaylight> year;
  size_t index = 0;

  const api::AnnualGrid& grid() const { return year->grids[index]; }
};

const ArgumentTable<AnnualOptions>& annual_arguments() {
  static const ArgumentTable<AnnualOptions> table{
      argument("north", &AnnualOptions::north),
      argument("ground", &AnnualOptions::ground),
      argument("threshold", &AnnualOptions::threshold),
      argument("sunlight_day", &AnnualOptions::sunlight_day),
      argument("electric_target", &AnnualOptions::electric_target),
      argument("subdivision", &AnnualOptions::subdivision),
      argument("gather_rays", &AnnualOptions::gather_rays),
      argument("threads", &AnnualOptions::threads),
      argument("seed", &AnnualOptions::seed),
  };
  return table;
}

// Arguments that are texts or paths.
bool set_path(const std::string& name, const py::handle& value, AnnualOptions& o) {
  std::string* to = name == "occupancy" ? &o.occupancy
                    : name == "groups"  ? &o.groups
                    : name == "blinds"  ? &o.blinds
                                        : nullptr;
  if (to == nullptr) return false;
  *to = value.is_none() ? "" : taken<std::filesystem::path>(value, name).string();
  return true;
}

// Arguments that are lists: points, and names of lights. One name may stand for its list.
bool set_list(const std::string& name, const py::handle& value, AnnualOptions& o) {
  if (name == "electric") {
    if (value.is_none() || py::isinstance<py::str>(value))
      o.electric.assign(value.is_none() ? 0 : 1,
                        value.is_none() ? "" : taken<std::string>(value, name));
    else
      o.electric = taken<std::vector<std::string>>(value, name);
    return true;
  }
  std::vector<api::MeasurePoint>* to = name == "eyes"       ? &o.eyes
                                       : name == "sunlight" ? &o.sunlight
                                                            : nullptr;
  if (to == nullptr) return false;
  to->clear();
  if (value.is_none()) return true;
  const auto points = taken<Points>(value, name);
  if (points.ndim() != 2 || points.shape(1) != 6)
    throw api::UsageError(name + ": an array (n, 6) of positions and normals is needed");
  *to = points_of(points, {});
  return true;
}

// Accepts None (grids of the scene's file), an array of points, or a dict from names to arrays.
std::vector<api::SensorGrid> grids_taken(const py::object& grids, const api::Point& up) {
  std::vector<api::SensorGrid> made;
  if (grids.is_none()) return made;
  if (!py::isinstance<py::dict>(grids))
    return {{"points", points_of(taken<Points>(grids, "grids"), up)}};
  for (const auto& [name, points] : py::reinterpret_borrow<py::dict>(grids))
    made.push_back(
        {taken<std::string>(name, "grids"), points_of(taken<Points>(points, "grids"), up)});
  if (made.empty()) throw api::UsageError("grids: the dict is empty");
  return made;
}

std::shared_ptr<AnnualDaylight> annual_of_scene(api::Scene& s, const std::filesystem::path& weather,
                                                const py::object& grids,
                                                const py::kwargs& arguments) {
  AnnualOptions options;
  py::object progress = py::none();
  for (const auto& [key, value] : arguments) {
    const auto name = py::cast<std::string>(key);
    if (name == "progress")
      progress = py::reinterpret_borrow<py::object>(value);
    else if (!set_path(name, value, options) && !set_list(name, value, options) &&
             !set_argument(annual_arguments(), name, value, options))
      fail_unknown("annual", name);
  }
  const std::vector<api::SensorGrid> given = grids_taken(grids, s.up());
  auto made = std::make_shared<AnnualDaylight>();
  run_for_python(progress, [&](const api::Progress& look) {
    *made = api::annual(s, weather.string(), given, options, look);
  });
  return made;
}

// A view of numbers per hour, which keeps `owner` alive.
template <class T>
py::array hours_view(const std::vector<T>& values, const py::object& owner) {
  return py::array_t<T>({py::ssize_t(values.size())}, {py::ssize_t(sizeof(T))}, values.data(),
                        owner);
}

// A view (count, hours) of sensors from `first` on.
py::array sensors_view(const AnnualDaylight& year, Hourly which, size_t first, size_t count,
                       const py::object& owner) {
  const std::vector<float>& all = year.*which;
  const py::ssize_t row = py::ssize_t(year.hours.size()), number = sizeof(float);
  return py::array_t<float>({py::ssize_t(count), row}, {row * number, number},
                            all.data() + first * year.hours.size(), owner);
}

py::array array_of(const std::vector<double>& values, size_t first, size_t count) {
  return py::array_t<double>(py::ssize_t(count), values.data() + first);
}

py::dict metrics_of_sensors(const GridOfYear& g, std::vector<double> api::SensorMetric::*which) {
  py::dict d;
  for (const api::SensorMetric& m : g.year->metrics)
    d[py::str(m.key)] = array_of(m.*which, g.grid().first, g.grid().count);
  return d;
}

py::list requirements_of(const GridOfYear& g) {
  py::list rows;
  for (const api::AnnualRequirement& r : g.grid().requirements) {
    py::dict row;
    row["title"] = r.title;
    row["need"] = r.need;
    row["value"] = r.value;
    row["standard_error"] = r.standard_error;
    row["verdict"] = r.verdict;
    rows.append(row);
  }
  return rows;
}

py::dict metrics_of_grid(const GridOfYear& g) {
  py::dict d;
  for (const api::AnnualMetric& m : g.grid().metrics)
    d[py::str(m.key)] = py::make_tuple(m.value, m.standard_error);
  return d;
}

GridOfYear grid_named(const std::shared_ptr<AnnualDaylight>& year, const std::string& name) {
  for (size_t i = 0; i < year->grids.size(); ++i)
    if (year->grids[i].name == name) return {year, i};
  throw py::key_error(name);
}

py::list grids_of_year(const std::shared_ptr<AnnualDaylight>& year) {
  py::list list;
  for (size_t i = 0; i < year->grids.size(); ++i) list.append(GridOfYear{year, i});
  return list;
}

py::dict states_of(const py::object& self) {
  const auto& year = self.cast<const AnnualDaylight&>();
  py::dict d;
  for (const api::WindowGroupYear& g : year.groups)
    d[py::str(g.name)] = py::make_tuple(g.states, hours_view(g.shown, self));
  return d;
}

// Returns the shares of glare by limit.
py::dict shares_of(const api::EyeGlare& e) {
  py::dict d;
  const std::array<double, 3> limits{0.35, 0.40, 0.45};
  for (size_t k = 0; k < limits.size(); ++k) d[py::float_(limits[k])] = e.shares[k];
  return d;
}

// An eye with the year that it belongs to.
struct EyeOfYear {
  std::shared_ptr<const AnnualDaylight> year;
  size_t index = 0;
  const api::EyeGlare& eye() const { return year->eyes[index]; }
};

py::list eyes_of_year(const std::shared_ptr<AnnualDaylight>& year) {
  py::list list;
  for (size_t i = 0; i < year->eyes.size(); ++i) list.append(EyeOfYear{year, i});
  return list;
}

void bind_eye(py::module_& m) {
  const auto hours = [](std::vector<float> api::EyeGlare::*which) {
    return [which](const py::object& self) {
      return hours_view(self.cast<const EyeOfYear&>().eye().*which, self);
    };
  };
  py::class_<EyeOfYear>(m, "AnnualEye", "Daylight glare at one eye in a year of daylight.")
      .def_property_readonly("vertical", hours(&api::EyeGlare::vertical_lx),
                             "Illuminance of the eye in lx, blinds as operated: float32 (hours,), "
                             "a view.")
      .def_property_readonly("dgp", hours(&api::EyeGlare::dgp),
                             "Daylight Glare Probability, 0 to 1, blinds as operated: float32 "
                             "(hours,), a view.")
      .def_property_readonly(
          "shares", [](const EyeOfYear& e) { return shares_of(e.eye()); },
          "Share of the occupied hours with a higher DGP, 0 to 1: dict from the limits .35, .40 "
          "and .45.")
      .def_property_readonly(
          "level", [](const EyeOfYear& e) { return e.eye().level; },
          "Protection from glare by EN 17037: 'high', 'medium', 'minimum' or 'none'.");
}

py::dict electric_of_grid(const GridOfYear& g) {
  py::dict d;
  for (const api::ElectricYear& e : g.year->electric)
    d[py::str(e.name)] =
        py::make_tuple(array_of(e.lx, g.grid().first, g.grid().count),
                       array_of(e.standard_errors, g.grid().first, g.grid().count));
  return d;
}

py::dict electric_of_year(const AnnualDaylight& year) {
  py::dict d;
  for (const api::ElectricYear& e : year.electric) {
    py::dict group;
    group["sensors"] = e.sensors;
    group["mean_lx"] = e.mean_lx;
    group["occupied_hours"] = e.occupied_hours;
    group["full_load_hours"] = e.full_load_hours;
    d[py::str(e.name)] = group;
  }
  return d;
}

py::list sunlight_of_year(const AnnualDaylight& year) {
  py::list list;
  for (const api::SunlightExposure& s : year.sunlight)
    list.append(py::make_tuple(s.hours, s.level));
  return list;
}

void bind_grid(py::module_& m) {
  py::class_<GridOfYear> grid(m, "AnnualGrid", "One grid of sensors in a year of daylight.");
  const auto hourly = [&](const char* name, Hourly which, const char* text) {
    grid.def_property_readonly(
        name,
        [which](const py::object& self) {
          const auto& g = self.cast<const GridOfYear&>();
          return sensors_view(*g.year, which, g.grid().first, g.grid().count, self);
        },
        text);
  };
  hourly("total", &AnnualDaylight::total,
         "Illuminance in lx, blinds as operated: float32 (sensors, hours), a view.");
  hourly("standard_error", &AnnualDaylight::standard_error,
         "Standard error of `total` in lx: float32 (sensors, hours), a view.");
  hourly("direct", &AnnualDaylight::direct,
         "Illuminance in lx straight from the sun, blinds open: float32 (sensors, hours), a view.");
  grid.def_property_readonly("name", [](const GridOfYear& g) { return g.grid().name; })
      .def_property_readonly(
          "metrics",
          [](const GridOfYear& g) { return metrics_of_sensors(g, &api::SensorMetric::values); },
          "Metrics of sensors: dict from names as in metrics.csv ('da', 'udi_autonomous', "
          "'sun_hours' ...) to float64 (sensors,). Shares are in %.")
      .def_property_readonly(
          "metric_errors",
          [](const GridOfYear& g) {
            return metrics_of_sensors(g, &api::SensorMetric::standard_errors);
          },
          "Standard errors of `metrics`: dict from names to float64 (sensors,).")
      .def_property_readonly(
          "figures", &metrics_of_grid,
          "Figures of the grid: dict from names as in annual.json ('sda', 'ase', 'da' ...) to "
          "(value, standard error). Shares are in %.")
      .def_property_readonly(
          "requirements", &requirements_of,
          "Requirements of EN 17037 and LEED v4.1: list of dicts with title, need, value and "
          "standard_error in %, and verdict ('met', 'not met' or 'undecided').")
      .def_property_readonly(
          "electric", &electric_of_grid,
          "Illuminance in lx by each electric group at full output: dict from names to (values, "
          "standard errors), both float64 (sensors,).")
      .def("__len__", [](const GridOfYear& g) { return g.grid().count; })
      .def("__repr__",
           [](const GridOfYear& g) { return "<troffer.AnnualGrid '" + g.grid().name + "'>"; });
}

constexpr const char* annual_text =
    "Computes a year of daylight, as `troffer annual` does. All light sources are off, except "
    "for "
    "`electric`.\n\n"
    "weather: an .epw file, or Radiance's .wea. grids: dict from names to points, float64 (n, "
    "6), x, y, z in metres and the normal, or (n, 3), which face up; or one such array; None "
    "takes the grids of a Honeybee model.\n\nKeywords: north=0: degrees clockwise. ground=0.2: "
    "its reflectance. occupancy='8-18', or a file. groups: file of window groups. "
    "blinds='lm-83', 'open', or a file. threshold=300: lx of daylight autonomy. subdivision=4: "
    "of the sky. gather_rays=0: per sensor. threads=0. seed=0. progress: as in render().\n\n"
    "eyes: float64 (n, 6), eyes and their lines of sight, rated for glare in every hour. "
    "sunlight: float64 (n, 6), points and normals whose hours of sunlight on sunlight_day="
    "'03-21' are found; '03-21,11' counts the sun from 11 degrees of altitude on. electric: list "
    "of groups of lights that daylight dims, each 'NAME[,NAME...]', where '*' stands for any "
    "letters. electric_target=500: lx that daylight and electric light reach together.\n\n"
    "Raises ValueError for files and arguments that cannot be used, and for names that no light "
    "has; TypeError for arguments of a wrong type or name.\n\n"
    "Memory: 12 bytes per sensor and hour. Ctrl-C raises KeyboardInterrupt.";

}  // namespace

void bind_annual(py::module_& m, SceneClass& scene) {
  bind_grid(m);
  bind_eye(m);
  py::class_<AnnualDaylight, std::shared_ptr<AnnualDaylight>>(
      m, "AnnualDaylight",
      "What Scene.annual() finds. Hours are the steps of the weather file in whose middle the sun "
      "is up. year['Desk'] is the grid of that name.")
      .def_property_readonly("grids", &grids_of_year, "List of AnnualGrid.")
      .def("__getitem__", &grid_named, py::arg("name"))
      .def_property_readonly(
          "hours",
          [](const py::object& self) {
            return hours_view(self.cast<const AnnualDaylight&>().hours, self);
          },
          "Middle of each hour, counted from the first of January: float64 (hours,).")
      .def_property_readonly(
          "occupied",
          [](const py::object& self) {
            return hours_view(self.cast<const AnnualDaylight&>().occupied, self)
                .attr("view")("bool");
          },
          "Whether each hour is occupied: bool (hours,).")
      .def_property_readonly(
          "states", &states_of,
          "Window groups: dict from names to (names of states, number of the state that the group "
          "shows: uint16 (hours,)).")
      .def_property_readonly("eyes", &eyes_of_year, "List of AnnualEye, as given.")
      .def_property_readonly(
          "sunlight", &sunlight_of_year,
          "Exposure to sunlight: list of (hours on sunlight_day, level by EN 17037: 'high', "
          "'medium', 'minimum' or 'none'), as given.")
      .def_property_readonly(
          "electric", &electric_of_year,
          "Electric groups: dict from names to dicts with `sensors`, the number that the group "
          "serves; `mean_lx`, their electric light at full output; `occupied_hours`; and "
          "`full_load_hours`, the equivalent hours of full output with dimming.")
      .def_readonly("place", &AnnualDaylight::place, "Place of the weather file.")
      .def_readonly("error", &AnnualDaylight::relative_error,
                    "Root mean square of the hours' standard errors, relative to that of the "
                    "illuminance.")
      .def_readonly("is_complete", &AnnualDaylight::is_complete,
                    "False after a stop; there are then no grids.");
  scene.def("annual", &annual_of_scene, py::arg("weather"), py::arg("grids") = py::none(),
            annual_text);
}

}  // namespace troffer::bindings
