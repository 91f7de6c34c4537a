// The up direction in the JSON of `info` and --stats.
#pragma once

#include <nlohmann/json.hpp>

#include "scene/orientation.h"

namespace troffer {

inline nlohmann::ordered_json up_json(const UpDecision& up) {
  return {{"direction", {up.up.x, up.up.y, up.up.z}}, {"reason", up.reason}, {"doubt", up.doubt}};
}

}  // namespace troffer
