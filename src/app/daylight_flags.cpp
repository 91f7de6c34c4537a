#include "app/daylight_flags.h"

#include <CLI/CLI.hpp>

#include "app/option_values.h"

namespace troffer {

namespace {

void add_luminaire_options(CLI::App& command, DaylightOptions& o) {
  command
      .add_option(
          "--luminaire", o.luminaires,
          "NODE=FILE[,LUMENS[,KELVIN]]: a flat surface, a point or a spot shines as an .ies "
          "or .ldt file says, in the colour of a black body; NODE* stands for all that begin so; "
          "may be repeated")
      ->allow_extra_args(false);
  command.add_option(
      "--luminaires", o.luminaire_list,
      "LIST.csv of luminaires to add: file,x,y,z[,dx,dy,dz][,rotation][,dimming][,lumens]"
      "[,kelvin]");
  command
      .add_option("--dim", o.dims,
                  "NAME=F: this light sends F times as much (and takes F times the power); NAME* "
                  "stands for all that begin so; may be repeated")
      ->allow_extra_args(false);
}

}  // namespace

void add_daylight_options(CLI::App& command, DaylightOptions& o) {
  command.add_option("--sky", o.sky,
                     "Light of a sky: even, overcast, clear, cie:1 to cie:15 [,LUX of a horizontal "
                     "plane]; perez:DNI,DHI in W/m²; none [even where a scene has no light]");
  command.add_option("--sun", o.sun,
                     "The sun: AZIMUTH,ALTITUDE[,LUX], degrees clockwise from north and above the "
                     "horizon; with a clear sky unless --sky or --environment says else");
  command.add_option("--at", o.at,
                     "The sun by LATITUDE,LONGITUDE,TIME, such as "
                     "48.2,16.4,2026-06-21T12:00+02:00");
  command
      .add_option("--turbidity", o.turbidity, "Linke turbidity of a clear sky; more dims the sun")
      ->check(number_between(1, 10));
  command.add_option("--weather", o.weather,
                     "Sky and sun of an hour of a weather file (.epw), by Perez' model and --date "
                     "or --at");
  command.add_option("--date", o.date, "Of --weather: MM-DDTHH:MM, in the file's standard time");
  command
      .add_option("--north", o.north_deg,
                  "Direction of north: degrees clockwise, seen from above, from -z (from +y where "
                  "z is up)")
      ->check(number_between(-360, 360))
      ->capture_default_str();
  command.add_option("--ground", o.ground, "Reflectance of the ground below a sky")
      ->check(number_between(0, 1))
      ->capture_default_str();
  command.add_option(
      "--environment", o.environment,
      "Image of the surroundings, FILE[,SCALE]: .exr .hdr .pfm .png .jpg, azimuth by "
      "height, or square and equal-area");
  command
      .add_option("--environment-rotation", o.environment_rotation_deg,
                  "Turns --environment clockwise, seen from above, in degrees")
      ->check(number_between(-360, 360))
      ->capture_default_str();
  command
      .add_option("--portal", o.portals,
                  "Rectangle through which all light from outside enters: four corners x,y,z,…, "
                  "counterclockwise seen from inside, or the name of a part of the scene whose "
                  "front faces inside; may be repeated")
      ->allow_extra_args(false);
  add_luminaire_options(command, o);
  command
      .add_option(
          "--light-radius", o.light_radius,
          "Radius in metres that turns point and spot lights into spheres, for soft shadows")
      ->check(number_between(1e-6, 1e6));
}

}  // namespace troffer
