#include "view/json_values.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace troffer {

namespace {

float hand_of(const Camera& c) {
  return dot(cross(c.forward, c.up), c.right) < 0 ? -1.0f : 1.0f;
}

Vec3d vector_in(const nlohmann::json& object, const char* key) {
  constexpr double most = 1e9;
  const auto at = object.find(key);
  if (at == object.end() || !at->is_array() || at->size() != 3)
    throw UsageError(std::string(key) + ": three numbers are needed");
  Vec3d v;
  for (size_t a = 0; a < 3; ++a) {
    const nlohmann::json& number = (*at)[a];
    if (!number.is_number() || !(std::abs(number.get<double>()) <= most))
      throw UsageError(std::string(key) + ": three numbers are needed");
    v[a] = number.get<double>();
  }
  return v;
}

}  // namespace

nlohmann::json parse_object(const std::string& body) {
  nlohmann::json j = nlohmann::json::parse(body, nullptr, false);
  if (!j.is_object()) throw UsageError("a JSON object is needed");
  return j;
}

double number_in(const nlohmann::json& object, const char* key, double least, double most) {
  const auto at = object.find(key);
  if (at == object.end() || !at->is_number() || !(at->get<double>() >= least) ||
      !(at->get<double>() <= most))
    throw UsageError(std::string(key) + ": a number between " + std::to_string(least) + " and " +
                     std::to_string(most) + " is needed");
  return at->get<double>();
}

nlohmann::json json_of(const Vec3d& v) {
  return {v.x, v.y, v.z};
}

nlohmann::json json_of_camera(const Camera& any, const Vec3d& origin) {
  const Camera c = without_fisheye(any);
  return {{"name", c.name},
          {"eye", json_of(Vec3d(c.position) + origin)},
          {"forward", json_of(Vec3d(c.forward))},
          {"up", json_of(Vec3d(c.up))},
          {"hand", hand_of(c)},
          {"half_extent", c.half_extent},
          {"is_vertical", c.fov_is_vertical},
          {"is_perspective", c.kind == CameraKind::perspective},
          {"window", c.has_screen_window ? nlohmann::json(c.screen_window) : nlohmann::json()}};
}

Camera camera_of_json(const nlohmann::json& object, const Camera& base, const Vec3d& origin) {
  Camera c = without_fisheye(base);
  c.position = Vec3(vector_in(object, "eye") - origin);
  const Vec3 forward(vector_in(object, "forward")), up(vector_in(object, "up"));
  const Vec3 side = cross(forward, up);
  constexpr float shortest = 1e-6f;  // squares of much shorter vectors lose digits
  if (!(std::min(length(forward), length(up)) >= shortest) ||
      !(length(side) > 1e-6f * length(forward) * length(up)))
    throw UsageError("forward and up must have a length and different directions");
  c.forward = normalize(forward);
  c.right = normalize(side) * hand_of(base);
  c.up = cross(normalize(side), c.forward);
  c.half_extent = float(number_in(object, "half_extent", 1e-4, 1e6));
  return c;
}

std::string text_of_json(const nlohmann::json& j) {
  return j.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace troffer
