// Options that add light to a scene: luminaires (--luminaire, --luminaires, --light-radius, --dim)
// and light from outside (--sky, --sun, --at, --turbidity, --weather, --north, --ground,
// --environment, --portal). All commands that render or measure use them.
#pragma once

#include <string>
#include <vector>

#include "scene/orientation.h"
#include "scene/scene.h"

namespace troffer {

// Values as typed.
struct DaylightOptions {
  std::vector<std::string> luminaires;  // lighting/attached_luminaires.h
  std::string luminaire_list;           // lighting/luminaire_list.h
  std::vector<std::string> dims;        // lighting/dimming.h
  std::string sky, sun, at;
  std::string weather, date;  // lighting/weather.h
  double light_radius = 0;    // m; 0: point lights stay points
  std::string environment;
  std::vector<std::string> portals;  // lighting/portal_options.h
  std::string up;                    // text for parse_up(); empty: decide_up()
  double north_deg = 0, ground = 0.2, environment_rotation_deg = 0;
  double turbidity = 0;  // Linke turbidity; 0: typical value
  // A scene without light gets a uniform sky. False for commands that report figures or verdicts,
  // which must not rest on light that the user did not ask for: check_light() then throws.
  bool adds_default_sky = true;

  // True if light from outside the scene, or darkness (--sky none), is requested.
  bool requests_sky() const {
    return !sky.empty() || !sun.empty() || !at.empty() || !weather.empty() || !environment.empty();
  }
};

// Adds the requested lights to the scene and dims lights. A scene without light gets a uniform sky
// and a warning, if options.adds_default_sky is set and darkness is not requested. Throws
// UsageError for invalid values, InputError for unreadable images.
void add_daylight(Scene& scene, const DaylightOptions& options);
// Same with a given decision about the up direction (options.up is ignored). A doubt about it
// becomes a warning if the lights depend on it.
void add_daylight(Scene& scene, const DaylightOptions& options, const UpDecision& up);

// True if the requested lights depend on the up direction.
bool depends_on_up(const DaylightOptions& options);

// Parses x, y, z, -x and so on, or three numbers. Throws UsageError for other texts and for 0,0,0.
Vec3 parse_up(const std::string& text);

// Text of the warning about an invented sky.
extern const char* const default_sky_warning;

// Throws InputError, with advice, if nothing in the scene emits light, options.adds_default_sky is
// false and darkness is not requested. `lights`: names to which the lights are restricted; may be
// empty.
void check_light(const Scene& scene, const DaylightOptions& options,
                 const std::vector<std::string>& lights);

// Parses three numbers "x,y,z". Throws UsageError, naming the option, for other texts.
Vec3d parse_vector(const std::string& text, const char* option);

}  // namespace troffer
