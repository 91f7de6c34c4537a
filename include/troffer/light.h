/// @file
/// Lights for scenes: emission of surfaces, lights without a surface, skies and measured
/// luminaires.
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
  Color radiance{1, 1, 1};    ///< W/(m² sr), or cd/m² if the scene is photometric
  bool is_two_sided = false;  ///< emits from both sides of the triangles
  TextureId texture{};        ///< factor on radiance; needs texture coordinates
  std::string name{};         ///< name of the light; empty: the name of the mesh
};

/// A point that emits equally in all directions.
struct PointLight {
  std::string name{};        ///< lights of the same name share a dimmer
  Point position{};          ///< metres
  Color intensity{1, 1, 1};  ///< W/sr, or cd if the scene is photometric
};

/// A point that emits into a cone. The intensity falls to zero between two angles from the axis.
struct SpotLight {
  std::string name{};         ///< lights of the same name share a dimmer
  Point position{};           ///< metres
  Point direction{0, 0, -1};  ///< axis of the beam; of any length above zero
  Color intensity{1, 1, 1};   ///< on the axis; W/sr, or cd if the scene is photometric
  double inner_degrees = 0;   ///< angle from the axis; full intensity inside it
  double outer_degrees = 45;  ///< angle from the axis, at most 90; no light outside it
};

/// Parallel light from infinity.
struct DistantLight {
  std::string name{};         ///< lights of the same name share a dimmer
  Point direction{0, 0, -1};  ///< in which light travels; of any length above zero
  Color irradiance{1, 1, 1};  ///< on a surface that faces it; W/m², or lx if photometric
};

/// A luminaire with measured intensities, from an IES LM-63 or EULUMDAT file.
struct Luminaire {
  std::string name{};              ///< lights of the same name share a dimmer
  std::string file{};              ///< path of the .ies or .ldt file
  Point position{};                ///< its centre, metres
  std::optional<Point> nadir{};    ///< direction of its nadir; none: straight down
  double rotation = 0;             ///< of plane C0 about the nadir, degrees from the scene's x axis
  double dimming = 1;              ///< factor on its light
  std::optional<double> lumens{};  ///< luminous flux, lm; none: the file's
  std::optional<double> kelvin{};  ///< colour temperature, 1000 to 40000 K; none: white
};

/// A sky, with a sun if requested. The lights are named "sky" and "sun".
struct Sky {
  std::string kind = "overcast";  ///< "even" (uniform), "overcast", "clear", "cie:1" to "cie:15"
  std::optional<double> lux{};    ///< horizontal illuminance by the sky alone; none: typical
  std::optional<std::pair<double, double>> sun{};  ///< azimuth from north and altitude, degrees
  double north = 0;     ///< direction of north, degrees clockwise from -z; from +y if z is up
  double ground = 0.2;  ///< reflectance of the ground, 0 to 1
};

/// Light as options of the program describe it. Each member stands for one option, and texts have
/// the form that the command line takes (docs/reference/options.md).
struct AddedLight {
  std::string sky{};                      ///< --sky
  std::string sun{};                      ///< --sun
  std::string at{};                       ///< --at
  std::string weather{};                  ///< --weather: path of an .epw file
  std::string date{};                     ///< --date
  std::string environment{};              ///< --environment: path[,scale]
  std::vector<std::string> portals{};     ///< --portal, one text each
  std::vector<std::string> luminaires{};  ///< --luminaire, one text each
  std::string luminaire_list{};           ///< --luminaires: path of a .csv file
  std::string up{};                       ///< --up; empty: Scene::up()
  double turbidity = 0;                   ///< --turbidity, 1 to 10; 0: typical
  double north = 0;                       ///< --north, degrees
  double ground = 0.2;                    ///< --ground, 0 to 1
  double environment_rotation = 0;        ///< --environment-rotation, degrees
  double light_radius = 0;                ///< --light-radius, metres; 0: points stay points
};

/// The lights of one name in a scene.
struct LightInfo {
  std::string name{};  ///< name of the lights
  /// "polygon", "disk", "sphere", "mesh", "point", "spot", "distant", "environment", "sky" or
  /// "sun"; the kind of the first light
  std::string kind{};
  std::size_t count = 0;  ///< number of lights of that name
  double dimmer = 1;      ///< factor on their light
  Color radiance{};       ///< of the first light, without dimmer; see Scene::set_radiance()
};

}  // namespace troffer::api
