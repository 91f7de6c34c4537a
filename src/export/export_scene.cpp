#include "export/export_scene.h"

#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "base/units.h"
#include "export/gltf_writer.h"
#include "export/pbrt_writer.h"
#include "export/vertex_colors.h"
#include "light/web.h"
#include "scene/orientation.h"
#include "scene/projected_image.h"

namespace troffer {

namespace {

std::string ending_of(const std::string& path) {
  return std::filesystem::path(path).extension().string();
}

// Replaces measured luminaires by uniform ones of the same flux; returns their number.
size_t make_even(Scene& scene) {
  size_t count = 0;
  for (Light& e : scene.lights) {
    if (e.web == no_web) continue;
    ++count;
    const LightWeb& web = scene.webs[size_t(e.web)];
    double over = 4 * pi;  // point light: solid angle
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

// Returns the mean over all directions of the image that multiplies a light's intensity.
Rgb mean_of_image(const Scene& scene, const Light& e) {
  if (e.texture >= 0) return projected_flux(scene, e) / float(4 * pi);
  const EnvironmentMap& map = scene.environments[size_t(e.environment)];
  Rgb sum;
  double weights = 0;
  for (int y = 0; y < map.height; ++y) {
    const double weight = map.projection == SphereMap::equal_area
                              ? 1
                              : std::sin(pi * (double(y) + 0.5) / double(map.height));
    for (int x = 0; x < map.width; ++x)
      sum += map.texels[size_t(y) * size_t(map.width) + size_t(x)] * float(weight);
    weights += weight * double(map.width);
  }
  return sum / float(weights);
}

// Replaces images that lights project by their mean, because glTF has none; returns their number.
size_t drop_images_of_lights(Scene& scene) {
  size_t count = 0;
  for (Light& e : scene.lights) {
    if (e.kind != LightKind::point || (e.environment < 0 && e.texture < 0)) continue;
    e.radiance *= mean_of_image(scene, e);
    e.environment = no_environment;
    e.texture = no_texture;
    ++count;
  }
  return count;
}

std::vector<Warning> write_scene(Scene scene, const std::string& path, const BakedLight* baked,
                                 const std::optional<Vec3>& up, OutputFolder& files) {
  check_scene_format(path);
  const size_t measured = make_even(scene);
  const size_t relays = scene.relays.size();
  const bool is_pbrt = ending_of(path) == ".pbrt";
  const size_t pictures = is_pbrt ? 0 : drop_images_of_lights(scene);
  WarningLog changed;
  flatten_second_sets(scene, !is_pbrt, changed);
  flatten_round_shapes(scene);
  std::vector<Warning> lost =
      is_pbrt ? write_pbrt(scene, files)
              : write_gltf(scene, up ? *up : decide_up(scene).up, path, files, baked);
  for (const Warning& w : changed.entries()) lost.push_back(w);
  if (pictures > 0)
    lost.push_back(
        {"lights that project an image are written as uniform lights of the same flux", pictures});
  if (relays > 0)
    lost.push_back(
        {"mirrors that only reflect light from sources (Radiance's \"mirror\" with an alternate "
         "material) are left out",
         relays});
  if (measured > 0)
    lost.push_back(
        {"measured luminaires are written as uniform sources of the same flux", measured});
  return lost;
}

}  // namespace

void check_scene_format(const std::string& path) {
  const std::string ending = ending_of(path);
  if (ending != ".pbrt" && ending != ".gltf" && ending != ".glb")
    throw UsageError("cannot write " + path + ": its name should end in .pbrt, .gltf or .glb");
}

std::vector<Warning> export_scene(Scene scene, const std::string& path, const BakedLight* baked,
                                  const std::optional<Vec3>& up, OutputFolder* files) {
  if (files) return write_scene(std::move(scene), path, baked, up, *files);
  OutputFolder own(path);
  return write_scene(std::move(scene), path, baked, up, own);
}

}  // namespace troffer
