#include "view/year_answers.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "view/json_values.h"

namespace troffer {

namespace {

using YearJson = nlohmann::json;

template <class T>
HttpResponse numbers_response(const std::vector<T>& numbers) {
  return {200, "application/octet-stream",
          std::string(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(T)),
          ""};
}

template <class T>
T whole_number(std::string_view text, const char* what) {
  T number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size())
    throw UsageError(std::string(what) + ": a whole number is needed");
  return number;
}

// Parses "-1,0,2": a state of every window group.
StoredStates parse_states(const std::string& text) {
  StoredStates states;
  for (size_t at = 0; !text.empty() && at <= text.size();) {
    const size_t end = std::min(text.find(',', at), text.size());
    states.push_back(whole_number<int>(std::string_view(text).substr(at, end - at), "states"));
    at = end + 1;
  }
  return states;
}

StoredPart parse_part(const std::string& text) {
  if (text == "total") return StoredPart::total;
  if (text == "direct") return StoredPart::direct;
  throw UsageError("part: total or direct");
}

size_t points_outside(const std::vector<MeasuringPoint>& points, const Boxd& box) {
  const double rounding = 1e-4 * box.diagonal();
  const auto is_outside = [&](const MeasuringPoint& p) {
    for (size_t a = 0; a < 3; ++a)
      if (p.position[a] < box.lower[a] - rounding || p.position[a] > box.upper[a] + rounding)
        return true;
    return false;
  };
  return size_t(std::count_if(points.begin(), points.end(), is_outside));
}

}  // namespace

YearAnswers::YearAnswers(std::shared_ptr<StoredHours> year, const Boxd& bounds,
                         const std::string& file)
    : hours_(std::move(year)) {
  const StoredYear& y = hours_->year();
  const auto name = [](const std::string& path) {
    return std::filesystem::path(path).filename().string();
  };
  if (name(y.scene) != name(file))
    notes_.push_back(
        fmt::format("the year in {} was computed for {}, not {}", y.folder, y.scene, name(file)));
  const size_t outside = bounds.is_empty() ? 0 : points_outside(y.points, bounds);
  if (outside > 0)
    notes_.push_back(fmt::format(
        "{} of the {} sensors of {} lie outside of this scene: the year may belong to another one",
        outside == y.points.size() ? "all" : std::to_string(outside), y.points.size(), y.folder));
}

HttpResponse YearAnswers::answer(const HttpRequest& r) {
  if (r.path == "year") return description();
  if (r.path == "year/points") return positions();
  if (r.path == "year/glare") return glare();
  const bool is_hour = r.path == "year/hour";
  if (!is_hour && r.path != "year/sensor") throw UsageError("there is no such answer of the year");
  const StoredPart part = parse_part(r.value("part"));
  const StoredStates states = parse_states(r.value("states"));
  const auto number = whole_number<size_t>(r.value("number"), "number");
  if (is_hour) return numbers_response(hours_->all_sensors(number, part, states));
  std::vector<float> values = hours_->all_hours(number, part, states);
  if (part == StoredPart::total &&
      std::all_of(states.begin(), states.end(), [](int s) { return s == by_schedule; })) {
    const std::vector<float> errors = hours_->errors(number);
    values.insert(values.end(), errors.begin(), errors.end());
  }
  return numbers_response(values);
}

HttpResponse YearAnswers::description() const {
  const StoredYear& y = hours_->year();
  YearJson j = {{"folder", y.folder},
                {"place", y.place},
                {"zone_hours", y.zone_hours},
                {"steps_per_hour", y.steps_per_hour},
                {"has_leap_day", y.has_leap_day},
                {"hours", y.hours},
                {"sensors", y.points.size()},
                {"notes", notes_}};
  j["groups"] = YearJson::array();
  for (const StoredGroup& g : y.groups)
    j["groups"].push_back({{"name", g.name}, {"states", g.states}, {"schedule", g.schedule}});
  j["grids"] = YearJson::array();
  for (const StoredGrid& g : y.grids)
    j["grids"].push_back({{"name", g.name}, {"first", g.first}, {"count", g.count}});
  j["eyes"] = YearJson::array();
  for (const StoredEye& e : hours_->eyes()) {
    const Vec3d &p = e.eye.position, d(e.eye.normal);
    j["eyes"].push_back({{"position", {p.x, p.y, p.z}}, {"direction", {d.x, d.y, d.z}}});
  }
  return {200, "application/json", text_of_json(j), ""};
}

HttpResponse YearAnswers::glare() const {
  std::vector<float> all;
  for (const StoredEye& e : hours_->eyes())
    for (const std::vector<float>* v : {&e.dgp, &e.vertical_lx})
      all.insert(all.end(), v->begin(), v->end());
  return numbers_response(all);
}

HttpResponse YearAnswers::positions() const {
  std::vector<double> all;
  for (const MeasuringPoint& p : points())
    for (const Vec3d& v : {p.position, Vec3d(p.normal)})
      for (size_t a = 0; a < 3; ++a) all.push_back(v[a]);
  return numbers_response(all);
}

std::vector<uint8_t> points_in_sight(const PreparedScene& scene, const Camera& camera,
                                     const std::vector<MeasuringPoint>& points) {
  std::vector<Ray> rays;
  std::vector<uint8_t> is_hidden(points.size()), is_seen(points.size());
  const bool is_parallel = camera.kind == CameraKind::orthographic;
  for (const MeasuringPoint& p : points) {
    const Vec3 at(p.position - scene.scene.origin);
    const float along = dot(at - camera.position, camera.forward);
    Ray r = segment(is_parallel ? at - camera.forward * along : camera.position, at);
    constexpr float surface = 1 - 1e-3f;  // sensors may lie on a surface
    r.t_max = surface;
    if (along > 0) r.t_min = std::clamp(camera.near_clip / along, 0.0f, surface);
    rays.push_back(r);
  }
  scene.tracer.occluded(rays, is_hidden);
  for (size_t i = 0; i < points.size(); ++i) {
    const Vec3 at(points[i].position - scene.scene.origin);
    is_seen[i] = is_hidden[i] == 0 && dot(at - camera.position, camera.forward) > 0 ? 1 : 0;
  }
  return is_seen;
}

}  // namespace troffer
