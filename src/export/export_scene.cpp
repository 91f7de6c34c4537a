#include "export/export_scene.h"

#include <filesystem>

#include "base/error.h"
#include "base/units.h"
#include "export/gltf_writer.h"
#include "export/pbrt_writer.h"
#include "light/web.h"

namespace troffer {

namespace {

std::string ending_of(const std::string& path) {
  return std::filesystem::path(path).extension().string();
}

// Measured luminaires become even ones of the same flux; returns how many there were.
size_t make_even(Scene& scene) {
  size_t count = 0;
  for (Light& e : scene.lights) {
    if (e.web == no_web) continue;
    ++count;
    const LightWeb& web = scene.webs[size_t(e.web)];
    double over = 4 * pi;  // a point: steradians
    if (has_surface(e.kind)) {
      double area = 4 * double(web.cross_section);
      for (const Vec3& face : web.faces) area += double(length(face));
      over = pi * area;
    }
    e.radiance *= over > 0 ? float(flux(web) / over) : 0;
    e.web = no_web;
  }
  return count;
}

}  // namespace

void check_scene_format(const std::string& path) {
  const std::string ending = ending_of(path);
  if (ending != ".pbrt" && ending != ".gltf" && ending != ".glb")
    throw UsageError("cannot write " + path + ": its name should end in .pbrt, .gltf or .glb");
}

std::vector<Warning> export_scene(Scene scene, const std::string& path, const BakedLight* baked) {
  check_scene_format(path);
  const size_t measured = make_even(scene);
  std::vector<Warning> lost =
      ending_of(path) == ".pbrt" ? write_pbrt(scene, path) : write_gltf(scene, path, baked);
  if (measured > 0)
    lost.push_back({"measured luminaires are written as even sources of the same flux", measured});
  return lost;
}

}  // namespace troffer
