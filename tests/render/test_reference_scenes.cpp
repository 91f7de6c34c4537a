// Rooms with agreed reference values from other renderers.
#include <doctest/doctest.h>

#include <cmath>

#include "import/import.h"
#include "pictures.h"

using namespace troffer;
using namespace troffer::test;

namespace {

const std::string folder = std::string(TROFFER_SOURCE_DIR) + "/scenes/";

// Mean over pixels and channels. It does not depend on the resolution, since pixels are boxes.
Moments mean_of(const PreparedScene& scene, const Camera& camera, RenderOptions o, int sets) {
  Moments m;
  for (int s = 0; s < sets; ++s) {
    m.add(mean(render_now(scene, camera, o).layers[0].image));
    ++o.seed;
  }
  return m;
}

// Checks that the mean is within `tolerance` (relative) of the value and its noise is small enough.
void check_mean(const Moments& m, double expected, double tolerance) {
  CAPTURE(m.mean());
  CAPTURE(m.standard_error());
  CHECK(3 * m.standard_error() < tolerance * expected);
  CHECK(std::abs(m.mean() - expected) < tolerance * expected);
}

constexpr double direct_mean = 0.1761, full_mean = 0.3704;  // scenes/README.md

}  // namespace

TEST_CASE("kj92room: direct and full light, from pbrt and glTF") {
  const PreparedScene pbrt(import_scene(folder + "kj92room/kj92room_direct.pbrt"));
  const PreparedScene gltf(import_scene(folder + "kj92room/kj92room.gltf"));
  const PreparedScene obj(import_scene(folder + "kj92room/kj92room.obj"));
  REQUIRE(pbrt.scene.cameras.size() == 1);
  REQUIRE(gltf.scene.cameras.size() == 1);
  const Camera camera = pbrt.scene.cameras[0];
  RenderOptions o;
  o.method = Method::path;
  o.width = o.height = 64;
  for (const bool is_direct : {true, false}) {
    o.indirect = is_direct ? Indirect::none : Indirect::automatic;
    o.spp = is_direct ? 16 : 32;
    const Moments a = mean_of(pbrt, camera, o, 8);
    const Moments b = mean_of(gltf, gltf.scene.cameras[0], o, 8);
    check_mean(a, is_direct ? direct_mean : full_mean, 3e-3);
    check_mean(b, is_direct ? direct_mean : full_mean, 3e-3);
    CHECK(std::abs(a.mean() - b.mean()) < 2e-3 * a.mean());
  }
  o.indirect = Indirect::none;
  o.method = Method::fixed;
  o.shadow_rays = 4;
  o.spp = 4;
  check_mean(mean_of(pbrt, camera, o, 4), direct_mean, 3e-3);
  check_mean(mean_of(obj, camera, o, 4), direct_mean, 3e-3);
}

TEST_CASE("modern-hall-diffuse: as bright as its reference") {
  const PreparedScene scene(import_scene(folder + "modern-hall/modern-hall-diffuse.pbrt"));
  RenderOptions o;
  o.method = Method::path;
  o.width = 160;
  o.height = 120;
  o.spp = 8;
  // The reference was rendered with spectra, which accounts for 0.4 % of its mean.
  check_mean(mean_of(scene, scene.scene.cameras.at(0), o, 4), 0.47233, 6.5e-3);
}
