// Shading normals that differ much from the surface: all methods compute the same light.
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "base/random.h"
#include "base/units.h"
#include "import/import.h"
#include "import/temp_folder.h"
#include "render/pictures.h"

using namespace troffer;
using namespace troffer::test;

namespace {

std::string quad(const std::string& points, const std::string& more = "") {
  return "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [" + points + "] " +
         more + "\n";
}

// A room with a light in its ceiling and a low one on the wall, whose light grazes the objects in
// the middle.
std::string room_with(const std::string& inside) {
  return "LookAt 0 -3.5 2  0 0 0.2  0 0 1\nCamera \"perspective\" \"float fov\" 30\n"
         "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 24\nWorldBegin\n"
         "Material \"diffuse\" \"rgb reflectance\" [.6 .6 .6]\n" +
         inside + quad("-4 -4 -1 4 -4 -1 4 4 -1 -4 4 -1") + quad("-4 4 -1 4 4 -1 4 4 3 -4 4 3") +
         quad("-4 -4 -1 -4 4 -1 -4 4 3 -4 -4 3") + quad("4 4 -1 4 -4 -1 4 -4 3 4 4 3") +
         quad("4 -4 -1 -4 -4 -1 -4 -4 3 4 -4 3") + quad("-4 -4 3 -4 4 3 4 4 3 4 -4 3") +
         "AreaLightSource \"diffuse\" \"rgb L\" [10 10 10]\n" +
         quad("1 -1 2.9 1 1 2.9 2.5 1 2.9 2.5 -1 2.9") +
         quad("3.9 -1 -.9 3.9 -1 .9 3.9 1 .9 3.9 1 -.9");
}

std::string numbers(const Vec3d& v) {
  return std::to_string(v.x) + " " + std::to_string(v.y) + " " + std::to_string(v.z) + " ";
}

// A table top whose normals are tilted sideways by this angle.
std::string leaning(double angle_deg) {
  const double a = rad_from_deg(angle_deg);
  const std::string n = numbers({std::sin(a), 0, std::cos(a)});
  return quad("-1 -1 0 1 -1 0 1 1 0 -1 1 0", "\"normal N\" [" + n + n + n + n + "]");
}

// A ball with random normals.
std::string ragged_ball() {
  constexpr int n = 8;
  Random random(7);
  std::string points, normals, indices;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i < 2 * n; ++i) {
      const double theta = pi * j / n, phi = pi * i / n;
      const Vec3d d{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                    std::cos(theta)};
      points += numbers(d * 0.7);
      const auto off = [&] { return 4 * double(random.next_float()) - 2; };
      normals += numbers(d + Vec3d{off(), off(), off()});
    }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < 2 * n; ++i) {
      const int a = j * 2 * n + i, b = j * 2 * n + (i + 1) % (2 * n), c = a + 2 * n, d = b + 2 * n;
      for (const int v : {a, c, d, a, d, b}) indices += std::to_string(v) + " ";
    }
  return "Shape \"trianglemesh\" \"integer indices\" [" + indices + "] \"point3 P\" [" + points +
         "] \"normal N\" [" + normals + "]\n";
}

}  // namespace

TEST_CASE("the default method and path agree for tilted shading normals, up to grazing ones") {
  for (const std::string& inside : {leaning(45), leaning(80), leaning(90), ragged_ball()}) {
    const TempFolder folder;
    const PreparedScene scene(import_scene(folder.write("scene.pbrt", room_with(inside))));
    RenderOptions o;
    o.error = 0.03;
    const Image mine = render_now(scene, scene.scene.cameras.at(0), o).layers.at(0).image;
    o.method = Method::path;
    o.spp = 256;
    const Image truth = render_now(scene, scene.scene.cameras.at(0), o).layers.at(0).image;
    CHECK(mean(mine) == doctest::Approx(mean(truth)).epsilon(0.01));
    double squares = 0;
    for (size_t i = 0; i < truth.pixels.size(); ++i)
      squares += std::pow(double(luminance(mine.pixels[i] - truth.pixels[i])), 2);
    // Noise of both: .03, and that of 256 paths.
    CHECK(std::sqrt(squares / double(truth.pixels.size())) < 0.06 * mean(truth));
  }
}
