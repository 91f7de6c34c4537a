// Options that bring light to a scene, beside what its file has: --luminaire, --luminaires,
// --light-radius; and from beyond it: --sky, --sun, --at, --turbidity, --weather,
// --north, --ground, --environment, --portal.
#pragma once

#include <string>
#include <vector>

#include "scene/orientation.h"
#include "scene/scene.h"

namespace troffer {

// As typed.
struct DaylightOptions {
  std::vector<std::string> luminaires;  // light of the scene's own: attached_luminaires.h
  std::string luminaire_list;           // lighting/luminaire_list.h
  std::string sky, sun, at;
  std::string weather, date;  // lighting/weather.h
  double light_radius = 0;    // m; 0: points stay points
  std::string environment;
  std::vector<std::string> portals;  // lighting/asked_portals.h
  std::string up;                    // parse_up()'s; empty: decide_up()'s
  double north_deg = 0, ground = 0.2, environment_rotation_deg = 0;
  double turbidity = 0;  // Linke's; 0: what is typical
};

// Adds to the scene the lights that are asked for; to one that has none the even sky that a warning
// tells of, unless it is told to stay dark. UsageError for values that make no sense, InputError
// for images that cannot be read.
void add_daylight(Scene& scene, const DaylightOptions& options);
// The same by a decision that has been made (options.up does not count). A doubt of it becomes a
// warning where the lights depend on what is up.
void add_daylight(Scene& scene, const DaylightOptions& options, const UpDecision& up);

// Whether the lights that are asked for depend on which way is up.
bool depends_on_up(const DaylightOptions& options);

// x, y, z, -x …, or three numbers; UsageError for others and for 0,0,0.
Vec3 parse_up(const std::string& text);

// Three numbers "x,y,z"; UsageError that names the option for others.
Vec3d parse_vector(const std::string& text, const char* option);

}  // namespace troffer
