#include "app/daylight_flags.h"

#include <CLI/CLI.hpp>

#include "app/option_values.h"

namespace troffer {

namespace {

void add_luminaire_options(CLI::App& command, DaylightOptions& o) {
  command
      .add_option("--luminaire", o.luminaires,
                  "Photometric file (.ies, .ldt) for a flat surface, a point or a spot; LUMENS "
                  "replaces its flux, KELVIN gives the colour of a black body; NODE* matches all "
                  "names that begin with NODE; may be repeated")
      ->allow_extra_args(false);
  command.add_option("--luminaires", o.luminaire_list,
                     "List of luminaires to add, a .csv with columns "
                     "file,x,y,z[,dx,dy,dz][,rotation][,dimming][,lumens][,kelvin]");
  command
      .add_option("--dim", o.dims,
                  "Multiply the light that this source sends, and its power, by FACTOR; NAME* "
                  "matches all names that begin with NAME; may be repeated")
      ->allow_extra_args(false);
}

}  // namespace

void add_daylight_options(CLI::App& command, DaylightOptions& o) {
  command.add_option(
      "--sky", o.sky,
      "Sky: even (uniform), overcast, clear or cie:1 to cie:15, each with ,LUX on a horizontal "
      "plane or without; perez:DNI,DHI in W/m²; or none [for scenes without light: even]");
  command.add_option("--sun", o.sun,
                     "Sun, in degrees clockwise from north and above the horizon; LUX on a plane "
                     "that faces it; adds a clear sky unless --sky or --environment is given");
  command.add_option("--at", o.at,
                     "Sun by place and time, such as 48.2,16.4,2026-06-21T12:00+02:00");
  command
      .add_option("--turbidity", o.turbidity,
                  "Linke turbidity of a clear sky; higher values dim the sun")
      ->check(number_between(1, 10));
  command.add_option("--weather", o.weather,
                     "Sky and sun of one hour of a weather file (.epw), by the Perez model; --date "
                     "or --at chooses the hour");
  command.add_option("--date", o.date, "Date and time for --weather, in the file's standard time");
  command
      .add_option("--north", o.north_deg,
                  "Direction of north, in degrees clockwise as seen from above, from -z (from +y "
                  "if z is up)")
      ->check(number_between(-360, 360))
      ->capture_default_str();
  command.add_option("--ground", o.ground, "Reflectance of the ground below a sky")
      ->check(number_between(0, 1))
      ->capture_default_str();
  command.add_option("--environment", o.environment,
                     "Image of the surroundings, with a factor: .exr .hdr .pfm .png .jpg, "
                     "latitude-longitude or square equal-area");
  command
      .add_option("--environment-rotation", o.environment_rotation_deg,
                  "Turn --environment clockwise as seen from above, in degrees")
      ->check(number_between(-360, 360))
      ->capture_default_str();
  command
      .add_option("--portal", o.portals,
                  "Rectangle through which all light from outside enters: four corners x,y,z,…, "
                  "counterclockwise as seen from inside, or the name of a flat node whose front "
                  "faces inside; may be repeated")
      ->allow_extra_args(false);
  add_luminaire_options(command, o);
  command
      .add_option(
          "--light-radius", o.light_radius,
          "Radius in metres that turns point and spot lights into spheres, for soft shadows")
      ->check(number_between(1e-6, 1e6));
}

}  // namespace troffer
