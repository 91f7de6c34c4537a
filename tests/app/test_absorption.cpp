// Coloured glass, distant textures and one-sided surfaces, rendered by `path` and by the default.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "image/read_image.h"
#include "program.h"

using namespace troffer;
using namespace troffer::test;

namespace test_absorption {

namespace {

// Returns the mean of a picture of 16 × 16 pixels.
Rgb mean_seen(const std::string& name, const std::string& scene,
              const std::vector<std::string>& options) {
  const Folder folder;
  std::vector<std::string> words{
      "render", folder.write(name, scene), "-o", folder.path("o.pfm"), "--size", "16x16",
      "--quiet"};
  words.insert(words.end(), options.begin(), options.end());
  const Finished f = run_program(folder, words);
  CAPTURE(f.err);
  REQUIRE(f.status == 0);
  const Image image = read_image(folder.path("o.pfm"));
  Rgb sum;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) sum += image.at(x, y);
  return sum / float(image.width * image.height);
}

// A slab of glass in front of a white sky, seen through a narrow field of view.
std::string slab(double thickness, const std::string& absorption) {
  return fmt::format(
      "LookAt 0 0 3  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 2\nWorldBegin\n"
      "LightSource \"infinite\" \"rgb L\" [1 1 1]\n"
      "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [{1}] "
      "\"rgb sigma_s\" [0 0 0]\nMediumInterface \"m\" \"\"\n"
      "Material \"dielectric\" \"float eta\" 1.5\n"
      "Shape \"trianglemesh\" \"point3 P\" [-3 -3 -{0}  3 -3 -{0}  3 3 -{0}  -3 3 -{0}  "
      "-3 -3 0  3 -3 0  3 3 0  -3 3 0] \"integer indices\" [0 2 1 0 3 2  4 5 6 4 6 7  "
      "0 1 5 0 5 4  1 2 6 1 6 5  2 3 7 2 7 6  3 0 4 3 4 7]\n",
      thickness, absorption);
}

// Returns the radiance for normal incidence: reflection and transmission, summed over all orders.
double slab_closed_form(double absorption, double thickness) {
  const double r = 0.04, a = std::exp(-absorption * thickness);
  const double through = (1 - r) * (1 - r) * a / (1 - r * r * a * a);
  return through + r + r * a * through;
}

}  // namespace

TEST_CASE("a slab of glass absorbs by its thickness, a pane as well") {
  for (const double thickness : {1.0, 0.1})  // the thinner one is treated as a thin sheet
    for (const char* method : {"path", "certified"}) {
      const Rgb seen =
          mean_seen("s.pbrt", slab(thickness, ".5 1 2"), {"--method", method, "--spp", "256"});
      CAPTURE(method);
      CAPTURE(thickness);
      for (size_t c = 0; c < 3; ++c) {
        const double expected = slab_closed_form(c == 0 ? .5 : c == 1 ? 1 : 2, thickness);
        CHECK(std::abs(double(seen[c]) - expected) < 0.004);
      }
    }
}

TEST_CASE("a pane absorbs more of oblique light, by every method") {
  // One light over a pane 1 m above the floor: straight above, and 60 degrees off.
  const std::string scene =
      "WorldBegin\nMaterial \"diffuse\" \"rgb reflectance\" [0 0 0]\n"
      "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] "
      "\"point3 P\" [-50 -50 0  50 -50 0  50 50 0  -50 50 0]\n"
      "LightSource \"point\" \"rgb I\" [7 7 7] \"point3 from\" [0 0 2]\n";
  const auto pane = [](const std::string& medium) {
    return "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [" + medium +
           "] \"rgb sigma_s\" [0 0 0]\nMediumInterface \"m\" \"\"\n"
           "Material \"dielectric\" \"float eta\" 1.5\n"
           "Shape \"trianglemesh\" \"point3 P\" [-90 -90 .9  90 -90 .9  90 90 .9  -90 90 .9  "
           "-90 -90 1  90 -90 1  90 90 1  -90 90 1] \"integer indices\" [0 2 1 0 3 2  4 5 6 4 6 7 "
           " 0 1 5 0 5 4  1 2 6 1 6 5  2 3 7 2 7 6  3 0 4 3 4 7]\n";
  };
  const auto measure = [&](const std::string& medium, const char* method) {
    const Folder folder;
    const Finished f = run_program(
        folder, {"measure", folder.write("s.pbrt", scene + pane(medium)), "--points",
                 folder.write("p.csv", "x,y,z,nx,ny,nz\n0,0,0,0,0,1\n3.4641016,0,0,0,0,1\n"),
                 "--method", method});
    CAPTURE(f.err);
    REQUIRE(f.status == 0);
    return measured(f);
  };
  for (const char* method : {"certified", "path", "fixed"}) {
    const auto clear = measure("0 0 0", method), grey = measure("5 5 5", method);
    for (size_t i = 0; i < 2; ++i) {
      // 60 degrees outside, refracted by index 1.5; internal reflections change little
      const double inside = i == 0 ? 1 : std::sqrt(1 - 0.75 / 2.25);
      const double expected = std::exp(-0.5 / inside);
      CAPTURE(method);
      CHECK(grey[i].lx / clear[i].lx == doctest::Approx(expected).epsilon(0.008));
    }
  }
}

TEST_CASE("one viewing ray shows the mean of a distant checkered floor") {
  const std::string scene =
      "LookAt 0 0 50  0 300 0  0 0 1\nCamera \"perspective\" \"float fov\" 10\nWorldBegin\n"
      "LightSource \"infinite\" \"rgb L\" [1 1 1]\n"
      "Texture \"c\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [1 1 1] \"rgb tex2\" [.2 .2 .2] "
      "\"float uscale\" 20000 \"float vscale\" 20000\n"
      "Material \"diffuse\" \"texture reflectance\" \"c\"\n"
      "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point2 uv\" [0 0 1 0 1 1 0 1] "
      "\"point3 P\" [-5000 -5000 0  5000 -5000 0  5000 5000 0  -5000 5000 0]\n";
  const Folder folder;
  const Finished f =
      run_program(folder, {"render", folder.write("s.pbrt", scene), "-o", folder.path("o.pfm"),
                           "--size", "16x16", "--quiet", "--method", "fixed", "--spp", "1"});
  CAPTURE(f.err);
  REQUIRE(f.status == 0);
  // Check every pixel, not only the mean.
  const Image seen = read_image(folder.path("o.pfm"));
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) CHECK(std::abs(seen.at(x, y).g - 0.6f) < 0.02f);
}

// Rows of black and white, of holes and white, and of dark and bright emission. Nearby they are as
// wide as a pixel, further away narrower.
TEST_CASE("textures, masks and emissive textures keep their mean at half the resolution") {
  const std::string look =
      "LookAt 0 -4 6  0 4 0  0 0 1\nCamera \"perspective\" \"float fov\" 40\nWorldBegin\n";
  const std::string floor =
      "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point2 uv\" [0 0 1 0 1 1 0 1] "
      "\"point3 P\" [-20 -20 0  20 -20 0  20 20 0  -20 20 0]\n";
  const std::string image =
      "\"imagemap\" \"string filename\" \"t.pfm\" \"string encoding\" \"linear\" "
      "\"float uscale\" 13 \"float vscale\" 13\n";
  const std::string sky = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";
  const std::string diffuse = "Material \"diffuse\" \"rgb reflectance\" [.8 .8 .8]\n";
  const std::string scenes[] = {
      look + sky + "Texture \"t\" \"spectrum\" " + image +
          "Material \"diffuse\" \"texture reflectance\" \"t\"\n" + floor,
      look + sky + diffuse + "Texture \"a\" \"float\" " + image +
          floor.substr(0, floor.size() - 1) + " \"texture alpha\" \"a\"\n",
      look + diffuse +
          "AreaLightSource \"diffuse\" \"string filename\" \"t.pfm\" \"float scale\" .7\n" + floor};
  std::string texels = "Pf\n64 64\n-1.0\n";
  for (int i = 0; i < 64 * 64; ++i) {
    const float v = (i / 64 + i % 64) % 2 == 0 ? 1.0f : 0.0f;
    texels.append(reinterpret_cast<const char*>(&v), sizeof v);
  }
  for (const std::string& scene : scenes)
    for (const char* method : {"path", "certified"}) {
      const Folder folder;
      folder.write("t.pfm", texels);
      const auto seen = [&](const std::string& size, const std::string& spp) {
        const Finished f = run_program(
            folder, {"render", folder.write("s.pbrt", scene), "-o", folder.path("o.pfm"), "--size",
                     size, "--quiet", "--method", method, "--depth", "1", "--spp", spp});
        CAPTURE(f.err);
        REQUIRE(f.status == 0);
        return read_image(folder.path("o.pfm"));
      };
      const Image fine = seen("48x48", "16"), coarse = seen("24x24", "16");
      double difference = 0, most = 0, sum = 0;
      for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 24; ++x) {
          const Rgb four = fine.at(2 * x, 2 * y) + fine.at(2 * x + 1, 2 * y) +
                           fine.at(2 * x, 2 * y + 1) + fine.at(2 * x + 1, 2 * y + 1);
          const double d = double(coarse.at(x, y).g) - double(four.g) / 4;
          difference += d;
          most = std::max(most, std::abs(d));
          sum += double(four.g) / 4;
        }
      CAPTURE(scene);
      CAPTURE(method);
      CAPTURE(most);
      CHECK(std::abs(difference) < 0.01 * sum);
    }
}

TEST_CASE(
    "back sides: black in Mitsuba's files; in glTF's files invisible to the camera but present for "
    "light") {
  const auto panel = [](const std::string& bsdf) {
    return "<scene version='3.0.0'><sensor type='perspective'><float name='fov' value='5'/>"
           "<transform name='to_world'><lookat origin='0,0,-5' target='0,0,0' up='0,1,0'/>"
           "</transform></sensor><emitter type='constant'><rgb name='radiance' value='1'/>"
           "</emitter><shape type='rectangle'>" +
           bsdf + "</shape></scene>";
  };
  const std::string white = "<bsdf type='diffuse'><rgb name='reflectance' value='.5'/></bsdf>";
  for (const char* method : {"path", "certified", "fixed"}) {
    CAPTURE(method);
    CHECK(mean_seen("b.xml", panel(white), {"--method", method}).g == 0);
    const float both = mean_seen("t.xml", panel("<bsdf type='twosided'>" + white + "</bsdf>"),
                                 {"--method", method, "--spp", "16"})
                           .g;
    CHECK(both == doctest::Approx(0.5).epsilon(0.02));
  }
}

}  // namespace test_absorption
