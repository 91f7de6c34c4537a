// Converts cameras, vectors and numbers between the page's requests and the program, as JSON.
// ViewService uses it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace troffer {

// Parses a body as a JSON object. Throws UsageError if it is none.
nlohmann::json parse_object(const std::string& body);

// Returns a finite number within bounds. Throws UsageError with the key's name.
double number_in(const nlohmann::json& object, const char* key, double least, double most);

// Returns a camera as JSON, with positions in the file's coordinates. `hand`: 1 if right = forward
// × up, −1 in mirrored worlds.
nlohmann::json json_of_camera(const Camera& camera, const Vec3d& origin);

// Returns `base` moved to another place: "eye", "forward" and "up" of three numbers each,
// "half_extent". Throws UsageError if they do not make a camera.
Camera camera_of_json(const nlohmann::json& object, const Camera& base, const Vec3d& origin);

nlohmann::json json_of(const Vec3d& v);

// Serializes JSON for the page. Invalid UTF-8 is replaced.
std::string text_of_json(const nlohmann::json& j);

}  // namespace troffer
