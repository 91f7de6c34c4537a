/// @file
/// Light for scenes: what surfaces emit, lamps without a surface, skies, measured luminaires.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "troffer/material.h"
#include "troffer/types.h"

namespace troffer::api {

/// Emission of a mesh or a sphere: the same radiance in all directions.
struct Emission {
  Color radiance{1, 1, 1};    ///< W/(m² sr), or cd/m² where the scene is photometric
  bool is_two_sided = false;  ///< emits from the back of its triangles too
  TextureId texture{};        ///< multiplies radiance; needs texture coordinates
  std::string name{};         ///< name of the light; empty: the name of the mesh
};

/// A point that shines equally in all directions.
struct PointLight {
  std::string name{};        ///< lights of the same name share a dimmer
  Point position{};          ///< metres
  Color intensity{1, 1, 1};  ///< W/sr, or cd where the scene is photometric
};

/// A point that shines into a cone. The intensity fades between its two angles.
struct SpotLight {
  std::string name{};         ///< lights of the same name share a dimmer
  Point position{};           ///< metres
  Point direction{0, 0, -1};  ///< axis of the beam; any length but zero
  Color intensity{1, 1, 1};   ///< on the axis; W/sr, or cd where the scene is photometric
  double inner_degrees = 0;   ///< from the axis: full intensity within
  double outer_degrees = 45;  ///< from the axis: nothing beyond; at most 90
};

/// Parallel light from infinity.
struct DistantLight {
  std::string name{};         ///< lights of the same name share a dimmer
  Point direction{0, 0, -1};  ///< that the light takes; any length but zero
  Color irradiance{1, 1, 1};  ///< of a surface that faces it; W/m², or lx where photometric
};

/// A measured luminaire: an IES LM-63 or EULUMDAT file.
struct Luminaire {
  std::string name{};              ///< lights of the same name share a dimmer
  std::string file{};              ///< path of the .ies or .ldt file
  Point position{};                ///< its middle, metres
  std::optional<Point> nadir{};    ///< direction of its nadir; none: straight down
  double rotation = 0;             ///< degrees of plane C0 about the nadir, from the scene's x axis
  double dimming = 1;              ///< factor on its light
  std::optional<double> lumens{};  ///< flux; none: the file's
  std::optional<double> kelvin{};  ///< 1000 to 40000: colour of a black body; none: white
};

/// A sky, and a sun in it. The lights are named "sky" and "sun".
struct Sky {
  std::string kind = "overcast";  ///< "even", "overcast", "clear", "cie:1" to "cie:15"
  std::optional<double> lux{};    ///< of the sky on a horizontal plane; none: what is typical
  std::optional<std::pair<double, double>> sun{};  ///< azimuth from north and altitude, degrees
  double north = 0;     ///< degrees clockwise from -z, or from +y where z is up
  double ground = 0.2;  ///< reflectance of the ground, 0 to 1
};

/// Light in the words of the program's options; texts have the form that the command line takes
/// (docs/reference/options.md).
struct AddedLight {
  std::string sky{};                      ///< --sky
  std::string sun{};                      ///< --sun
  std::string at{};                       ///< --at
  std::string weather{};                  ///< --weather: path of an .epw file
  std::string date{};                     ///< --date
  std::string environment{};              ///< --environment: path[,scale]
  std::vector<std::string> portals{};     ///< --portal, each
  std::vector<std::string> luminaires{};  ///< --luminaire, each: "NODE=FILE[,LUMENS[,KELVIN]]"
  std::string luminaire_list{};           ///< --luminaires: path of a .csv file
  std::string up{};                       ///< --up; empty: the scene's
  double turbidity = 0;                   ///< --turbidity, 1 to 10; 0: typical
  double north = 0;                       ///< --north, degrees
  double ground = 0.2;                    ///< --ground, 0 to 1
  double environment_rotation = 0;        ///< --environment-rotation, degrees
  double light_radius = 0;                ///< --light-radius, metres; 0: points stay points
};

/// The lights of one name in a scene.
struct LightInfo {
  std::string name{};  ///< name of all of them
  /// "polygon", "disk", "sphere", "mesh", "point", "spot", "distant", "environment", "sky" or
  /// "sun": the kind of the first
  std::string kind{};
  std::size_t count = 0;  ///< how many lights have the name
  double dimmer = 1;      ///< factor on what they send
  Color radiance{};       ///< undimmed, of the first; see Scene::set_radiance()
};

}  // namespace troffer::api
