// Cameras and numbers between requests and the program, as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace troffer {

// A body as an object; UsageError for what is none.
nlohmann::json parse_object(const std::string& body);

// A finite number within bounds; UsageError names the key.
double number_in(const nlohmann::json& object, const char* key, double least, double most);

// Positions in the file's coordinates. `hand`: 1 where right = forward × up, −1 in mirrored worlds.
nlohmann::json json_of_camera(const Camera& camera, const Vec3d& origin);

// `base` seen from another place: "eye", "forward", "up" of three numbers each, "half_extent".
// UsageError where they make no camera.
Camera camera_of_json(const nlohmann::json& object, const Camera& base, const Vec3d& origin);

nlohmann::json json_of(const Vec3d& v);

// Text for the page: what is no UTF-8 is replaced.
std::string text_of_json(const nlohmann::json& j);

}  // namespace troffer
