// Options that bring light to a scene, beside what its file has: --luminaire, --luminaires,
// --light-radius, --dim; and from beyond it: --sky, --sun, --at, --turbidity, --weather,
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
  std::vector<std::string> dims;        // lighting/dimming.h
  std::string sky, sun, at;
  std::string weather, date;  // lighting/weather.h
  double light_radius = 0;    // m; 0: points stay points
  std::string environment;
  std::vector<std::string> portals;  // lighting/asked_portals.h
  std::string up;                    // parse_up()'s; empty: decide_up()'s
  double north_deg = 0, ground = 0.2, environment_rotation_deg = 0;
  double turbidity = 0;  // Linke's; 0: what is typical
  // A scene without light gets an even sky. False for figures and verdicts, which must not rest on
  // light that nobody asked for: check_light() refuses it.
  bool invents_sky = true;

  // Whether light from beyond the scene is asked for, or darkness (--sky none).
  bool asks_for_sky() const {
    return !sky.empty() || !sun.empty() || !at.empty() || !weather.empty() || !environment.empty();
  }
};

// Adds to the scene the lights that are asked for, and dims lights. A scene that has none gets an
// even sky, which a warning tells of, where options.invents_sky and unless it is told to stay dark.
// UsageError for values that make no sense, InputError for images that cannot be read.
void add_daylight(Scene& scene, const DaylightOptions& options);
// The same by a decision that has been made (options.up does not count). A doubt of it becomes a
// warning where the lights depend on what is up.
void add_daylight(Scene& scene, const DaylightOptions& options, const UpDecision& up);

// Whether the lights that are asked for depend on which way is up.
bool depends_on_up(const DaylightOptions& options);

// x, y, z, -x …, or three numbers; UsageError for others and for 0,0,0.
Vec3 parse_up(const std::string& text);

// The warning of an invented sky.
extern const char* const invented_sky;

// InputError, which says what to do, where nothing in the scene shines though options.invents_sky
// is false and darkness was not asked for. `lights`: names of the only ones that are to shine.
void check_light(const Scene& scene, const DaylightOptions& options,
                 const std::vector<std::string>& lights);

// Three numbers "x,y,z"; UsageError that names the option for others.
Vec3d parse_vector(const std::string& text, const char* option);

}  // namespace troffer
