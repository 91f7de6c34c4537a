// Builds a room of 4 x 5 x 2.8 m from arrays, renders it, and measures the light on its desk.
//
//     room [picture.png]
#include <cstdio>
#include <exception>
#include <string>

#include "troffer/troffer.h"

namespace {

using troffer::api::Point;

// Returns two triangles between four corners. Their front is the side from which the corners run
// counterclockwise.
troffer::api::MeshData quad(const std::string& name, const Point& a, const Point& b, const Point& c,
                            const Point& d, const std::string& material) {
  troffer::api::MeshData mesh;
  mesh.name = name;
  mesh.positions = {a, b, c, d};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.material = material;
  return mesh;
}

troffer::api::Scene make_room() {
  troffer::api::Scene scene;  // z is up; emission is in cd/m²
  scene.add_material("white", troffer::api::Material::matte({0.8F, 0.8F, 0.8F}));
  scene.add_material("floor", troffer::api::Material::plastic({0.35F, 0.25F, 0.18F}, 0.3));
  scene.add_material("desk", troffer::api::Material::matte({0.5F, 0.4F, 0.3F}));
  const double w = 4, l = 5, h = 2.8;
  scene.add_mesh(quad("floor", {0, 0, 0}, {w, 0, 0}, {w, l, 0}, {0, l, 0}, "floor"));
  scene.add_mesh(quad("ceiling", {0, 0, h}, {0, l, h}, {w, l, h}, {w, 0, h}, "white"));
  scene.add_mesh(quad("south", {0, 0, 0}, {0, 0, h}, {w, 0, h}, {w, 0, 0}, "white"));
  scene.add_mesh(quad("north", {0, l, 0}, {w, l, 0}, {w, l, h}, {0, l, h}, "white"));
  scene.add_mesh(quad("west", {0, 0, 0}, {0, l, 0}, {0, l, h}, {0, 0, h}, "white"));
  scene.add_mesh(quad("east", {w, 0, 0}, {w, 0, h}, {w, l, h}, {w, l, 0}, "white"));
  scene.add_mesh(
      quad("desk", {1.2, 2, 0.75}, {2.8, 2, 0.75}, {2.8, 2.8, 0.75}, {1.2, 2.8, 0.75}, "desk"));
  troffer::api::MeshData lamp =
      quad("lamp", {1.7, 2.2, 2.6}, {1.7, 2.8, 2.6}, {2.3, 2.8, 2.6}, {2.3, 2.2, 2.6}, "white");
  lamp.emission = troffer::api::Emission{{6000, 6000, 6000}, false, {}, ""};
  scene.add_mesh(lamp);
  scene.add_camera("door", {{0.4, 0.4, 1.6}, {2.4, 3, 1}, {}, 75, 0, 0});
  return scene;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    troffer::api::Scene scene = make_room();
    const std::vector<troffer::api::MeasurePoint> desk{{{2, 2.4, 0.76}, {0, 0, 1}}};
    const troffer::api::Measurements lux = troffer::api::measure(scene, desk);
    std::printf("desk: %.0f lx +- %.1f\n", lux.values[0].illuminance, lux.values[0].standard_error);
    troffer::api::RenderOptions options;
    options.width = 160;
    options.height = 120;
    options.light.error = 0.05;
    const troffer::api::Picture picture = troffer::api::render(scene, options);
    picture.save(argc > 1 ? argv[1] : "room.png");
    std::printf("picture: estimated error %.3f, %.2f s\n", picture.statistics().estimated_error,
                picture.statistics().render_seconds);
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "error: %s\n", e.what());
    return 1;
  }
}
