// A small Honeybee model for tests: a box of 4 × 3 × 2.5 m with one window to the south, a shade,
// a dynamic group, a sensor grid and a view.
#pragma once

#include <fmt/format.h>

#include <array>
#include <initializer_list>
#include <string>

namespace troffer::test {

// Parts of the model that tests change.
struct HbjsonRoom {
  std::string units = "Meters";
  double scale = 1;       // factor on all coordinates
  std::string window;     // members of the window's Radiance properties
  std::string set;        // "modifier_set": "…", or empty
  std::string modifiers;  // of the model, with a comma behind each
  std::string model;      // further members of the model, with a comma behind each
  std::string radiance;   // further members of its Radiance properties, likewise
  std::string boundary = "Outdoors";

  std::string text() const;

 private:
  std::string face(const std::string& id, const std::string& type, const std::string& corners,
                   const std::string& more = "") const;
  std::string points(std::initializer_list<std::array<double, 3>> list) const;
};

inline std::string HbjsonRoom::points(std::initializer_list<std::array<double, 3>> list) const {
  std::string out;
  for (const auto& p : list)
    out += fmt::format("{}[{},{},{}]", out.empty() ? "" : ",", p[0] * scale, p[1] * scale,
                       p[2] * scale);
  return "[" + out + "]";
}

inline std::string HbjsonRoom::face(const std::string& id, const std::string& type,
                                    const std::string& corners, const std::string& more) const {
  return "{\"type\":\"Face\",\"identifier\":\"" + id + "\",\"face_type\":\"" + type +
         "\",\"geometry\":{\"type\":\"Face3D\",\"boundary\":" + corners +
         "},\"boundary_condition\":{\"type\":\"" + boundary +
         "\"},\"properties\":{\"radiance\":{}}" + more + "}";
}

inline std::string HbjsonRoom::text() const {
  const std::string opening =
      ",\"apertures\":[{\"type\":\"Aperture\",\"identifier\":\"window\",\"geometry\":{"
      "\"boundary\":" +
      points({{1, 0, 1}, {3, 0, 1}, {3, 0, 2}, {1, 0, 2}}) +
      "},\"boundary_condition\":{\"type\":\"Outdoors\"},\"properties\":{\"radiance\":{" + window +
      "}}}]";
  // Corners run counterclockwise as seen from outside.
  const std::string faces =
      face("floor", "Floor", points({{0, 0, 0}, {0, 3, 0}, {4, 3, 0}, {4, 0, 0}})) + "," +
      face("roof", "RoofCeiling", points({{0, 0, 2.5}, {4, 0, 2.5}, {4, 3, 2.5}, {0, 3, 2.5}})) +
      "," +
      face("south", "Wall", points({{0, 0, 0}, {4, 0, 0}, {4, 0, 2.5}, {0, 0, 2.5}}), opening) +
      "," + face("east", "Wall", points({{4, 0, 0}, {4, 3, 0}, {4, 3, 2.5}, {4, 0, 2.5}})) + "," +
      face("north", "Wall", points({{4, 3, 0}, {0, 3, 0}, {0, 3, 2.5}, {4, 3, 2.5}})) + "," +
      face("west", "Wall", points({{0, 3, 0}, {0, 0, 0}, {0, 0, 2.5}, {0, 3, 2.5}}));
  return "{\"type\":\"Model\",\"identifier\":\"m\",\"units\":\"" + units +
         "\",\"tolerance\":0.01," + model +
         "\"rooms\":[{\"type\":\"Room\",\"identifier\":\"room_1\",\"display_name\":\"Office\"," +
         "\"faces\":[" + faces + "],\"properties\":{\"radiance\":{" + set + "}}}]," +
         "\"orphaned_shades\":[{\"type\":\"Shade\",\"identifier\":\"tree\",\"is_detached\":true," +
         "\"geometry\":{\"boundary\":" + points({{0, -5, 0}, {4, -5, 0}, {4, -5, 1}, {0, -5, 1}}) +
         "},\"properties\":{\"radiance\":{}}}]," + "\"properties\":{\"radiance\":{" + radiance +
         "\"modifiers\":[" + modifiers +
         "{\"type\":\"Void\"}],\"sensor_grids\":[{\"identifier\":\"desk\",\"room_identifier\":" +
         "\"room_1\",\"sensors\":[{\"pos\":" +
         fmt::format("[{},{},{}]", 2 * scale, 1 * scale, 0.8 * scale) +
         ",\"dir\":[0,0,2]},{\"pos\":" +
         fmt::format("[{},{},{}]", 2 * scale, 2 * scale, 0.8 * scale) +
         ",\"dir\":[0,0,1]}]}],\"views\":[{\"identifier\":\"eye\",\"view_type\":\"a\"," +
         "\"position\":" + fmt::format("[{},{},{}]", 2 * scale, 2.5 * scale, 1.2 * scale) +
         ",\"direction\":[0,-1,0],\"up_vector\":[0,0,1],\"h_size\":180,\"v_size\":180}]}}}";
}

}  // namespace troffer::test
