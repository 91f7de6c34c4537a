#include "import/hbjson/hbjson_assets.h"

#include <fmt/format.h>

#include <cmath>

#include "import/hbjson/hbjson_face.h"
#include "import/radiance/radiance_view.h"

namespace troffer {

namespace {

Vec3d vector_of(const JsonNode& node) {
  const std::vector<double> v = node.as_numbers(3);
  return {v[0], v[1], v[2]};
}

std::string name_of_asset(const JsonNode& node) {
  const auto id = node.find_value("identifier");
  return id ? id->as_string() : node.member("display_name").as_string();
}

void add_sensors(const JsonNode& list, double unit_m, SensorGrid& grid) {
  for (size_t i = 0; i < list.size(); ++i) {
    const JsonNode sensor = list.element(i);
    const JsonNode way = sensor.member("dir");
    const Vec3d direction = vector_of(way);
    const double l = length(direction);
    if (!(l > 1e-15 && std::isfinite(l))) way.fail("has no direction");
    grid.positions.push_back(vector_of(sensor.member("pos")) * unit_m);
    grid.directions.push_back(Vec3(direction / l));
  }
}

void add_sensors_of_mesh(const JsonNode& mesh, double unit_m, SensorGrid& grid) {
  const Corners vertices = read_hbjson_points(mesh.member("vertices"), unit_m, 3);
  const JsonNode faces = mesh.member("faces");
  for (size_t i = 0; i < faces.size(); ++i) {
    const JsonNode face = faces.element(i);
    Corners corners;
    Vec3d middle;
    for (size_t k = 0; k < face.size(); ++k) {
      corners.push_back(vertices[face.element(k).as_index(vertices.size(), "vertices")]);
      middle += corners.back();
    }
    if (corners.size() < 3) face.fail("should have at least 3 vertices");
    const Vec3d n = normal_of(corners);
    if (n == Vec3d{}) continue;
    grid.positions.push_back(middle / double(corners.size()));
    grid.directions.push_back(Vec3(n));
  }
}

// A view in the form of Radiance's options.
std::string view_line(const JsonNode& view, double unit_m) {
  const auto number = [&](const char* key, double fallback) {
    const auto value = view.find_value(key);
    return value ? value->as_number() : fallback;
  };
  const auto given = view.find_value("view_type");
  const std::string type = given ? given->as_string() : "v";
  if (type.size() != 1 || type.find_first_of("vhlcas") != 0)
    given->fail("is not one of v, h, l, c, a and s");
  const Vec3d eye = vector_of(view.member("position")) * unit_m,
              way = vector_of(view.member("direction")), up = vector_of(view.member("up_vector"));
  const double size_unit = type == "l" ? unit_m : 1;
  return fmt::format("-vt{} -vp {} {} {} -vd {} {} {} -vu {} {} {} -vh {} -vv {} -vs {} -vl {}",
                     type, eye.x, eye.y, eye.z, way.x, way.y, way.z, up.x, up.y, up.z,
                     number("h_size", 60) * size_unit, number("v_size", 60) * size_unit,
                     number("shift", 0), number("lift", 0));
}

}  // namespace

void add_hbjson_grids(const JsonNode& radiance, double unit_m, Scene& scene) {
  const auto list = radiance.find_value("sensor_grids");
  for (size_t i = 0; list && i < list->size(); ++i) {
    const JsonNode node = list->element(i);
    SensorGrid grid;
    grid.name = name_of_asset(node);
    if (const auto room = node.find_value("room_identifier")) grid.room = room->as_string();
    const auto sensors = node.find_value("sensors");
    const auto mesh = node.find_value("mesh");
    if (sensors && sensors->size() > 0)
      add_sensors(*sensors, unit_m, grid);
    else if (mesh)
      add_sensors_of_mesh(*mesh, unit_m, grid);
    if (grid.positions.empty())
      scene.warnings.add("sensor grid '" + printable(grid.name) + "' has no sensors: left out");
    else
      scene.grids.push_back(std::move(grid));
  }
}

void add_hbjson_views(const JsonNode& radiance, double unit_m, Scene& scene) {
  const auto list = radiance.find_value("views");
  for (size_t i = 0; list && i < list->size(); ++i) {
    const JsonNode view = list->element(i);
    for (const char* clip : {"fore_clip", "aft_clip"})
      if (view.find_value(clip)) scene.warnings.add(fmt::format("views: {} is left out", clip));
    const std::string name = name_of_asset(view);
    if (!add_radiance_view(view_line(view, unit_m), name, scene))
      scene.warnings.add("view '" + printable(name) + "' cannot be used: left out");
  }
}

}  // namespace troffer
