// Tests of pbrt's film windows, of its cameras with real lenses, and of lights that are left out.
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "base/error.h"
#include "image/write_image.h"
#include "import/pbrt/pbrt.h"
#include "import/pbrt/pbrt_lens.h"
#include "scene_checks.h"
#include "temp_folder.h"

using namespace troffer;

namespace test_pbrt_camera {

namespace {

Scene import_options(const std::string& options, const std::string& world = "",
                     const std::string& lens = "") {
  const TempFolder folder;
  folder.write("lens.dat", lens);
  Image image(2, 1);
  image.at(0, 0) = image.at(1, 0) = {1, 1, 1};
  write_image(folder.path("wide.pfm"), image);
  return import_pbrt(folder.write("scene.pbrt", options + "\nWorldBegin\n" + world));
}

PbrtLens read(const std::string& text, double aperture_mm) {
  const TempFolder folder;
  return read_pbrt_lens(folder.write("lens.dat", text), aperture_mm);
}

const std::string film = "Film \"rgb\" \"integer xresolution\" 300 \"integer yresolution\" 200 ";
// Two faces with a radius of 100 mm and index 1.5: a focal length of 100 mm.
const std::string thin = "# radius sep n aperture\n0 0 0 40\n100 0 1.5 50\n-100 0 1 50\n";

}  // namespace

TEST_CASE("a film's window is that part of the picture") {
  const Scene all = import_options(film + "Camera \"perspective\" \"float fov\" 40");
  CHECK_FALSE(all.cameras.at(0).has_screen_window);
  for (const std::string window :
       {"\"float cropwindow\" [.5 1 .25 .75]", "\"integer pixelbounds\" [150 300 50 150]"}) {
    const Scene part = import_options(film + window + "Camera \"perspective\" \"float fov\" 40");
    const Camera& c = part.cameras.at(0);
    CHECK(part.warnings.total() == 0);
    CHECK(c.width == 150);
    CHECK(c.height == 100);
    CHECK(c.half_extent == all.cameras[0].half_extent);
    REQUIRE(c.has_screen_window);
    CHECK(c.screen_window == std::array<float, 4>{0, 1.5f, -0.5f, 0.5f});
  }
  const Scene windows = import_options(
      film +
      "\"float cropwindow\" [0 .5 0 .5] Camera \"perspective\" \"float screenwindow\" [-2 2 -1 3]");
  CHECK(windows.cameras.at(0).screen_window == std::array<float, 4>{-2, 0, 1, 3});
  CHECK_THROWS_AS(import_options(film + "\"float cropwindow\" [.5 .5 0 1]"), InputError);
  CHECK_THROWS_AS(import_options(film + "\"float cropwindow\" [.5 1]"), InputError);
}

TEST_CASE("lenses focus where thick lenses do") {
  const PbrtLens lens = read(thin, 20);
  CHECK(lens.focal_length == doctest::Approx(0.1));
  CHECK(lens.pupil_radius == doctest::Approx(0.01));
  CHECK(read(thin, 100).pupil_radius == doctest::Approx(0.02));  // no wider than the stop
  // Lensmaker's formula with thickness: 1/f = (n-1) (1/R1 - 1/R2 + (n-1) d / (n R1 R2)).
  const double f = 1 / (0.5 * (0.02 - 0.5 * 10 / (1.5 * 100 * 100)));
  CHECK(read("100 10 1.5 50\n-100 0 1 50\n", 1).focal_length == doctest::Approx(f / 1000));
  // A stop behind a lens appears larger, by f / (f - distance).
  const double seen = 10 * 100.0 / (100 - 20);
  CHECK(read("100 0 1.5 50\n-100 20 1 50\n0 0 0 40\n", 20).pupil_radius ==
        doctest::Approx(seen / 1000));
  for (const char* broken : {"", "1 2 3", "-100 0 1.5 50 100 0 1 50", "0 0 0 1", "1 2 three 4"})
    CHECK_THROWS_AS(read(broken, 1), InputError);
}

TEST_CASE("a realistic camera has its lens' field of view") {
  const std::string camera =
      "Camera \"realistic\" \"string lensfile\" \"lens.dat\" \"float focusdistance\" 2.1 \"float "
      "aperturediameter\" 20";
  const Scene scene = import_options(film + "\"float diagonal\" 36.05551275 " + camera, "", thin);
  const Camera& c = scene.cameras.at(0);
  // A film of 30 × 20 mm, 105 mm behind the lens.
  CHECK(c.half_extent == doctest::Approx(10.0 / 105));
  CHECK(c.lens_radius == doctest::Approx(0.01));
  CHECK(c.focal_distance == doctest::Approx(2.1));
  CHECK(has_warning(scene, "thin lens"));
  CHECK(has_warning(import_options(film + camera, "", "1 2 3"), "90 degrees"));
}

TEST_CASE("a light that is left out causes one warning, without its parameters") {
  for (const std::string light :
       {"LightSource \"goniometric\" \"string filename\" \"wide.pfm\" \"rgb I\" [1 2 3]",
        "LightSource \"goniometric\" \"string filename\" \"no.pfm\" \"rgb I\" [1 2 3]",
        "LightSource \"infinite\" \"string filename\" \"no.pfm\" \"float scale\" 2",
        "LightSource \"projection\" \"string filename\" \"../no.pfm\" \"float power\" 2"}) {
    const Scene scene = import_options("", light);
    CAPTURE(light);
    CHECK(scene.lights.empty());
    CHECK(scene.warnings.total() == 1);
    CHECK(has_warning(scene, "left out"));
  }
  const Scene scene = import_options("", "LightSource \"point\" \"float nonsense\" 2");
  CHECK(has_warning(scene, "nonsense"));
}

}  // namespace test_pbrt_camera
