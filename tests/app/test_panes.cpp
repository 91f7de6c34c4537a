// Clear thin glass in front of lights, by every method: light passes by Fresnel's equations,
// exactly once.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/units.h"
#include "daylit_rooms.h"
#include "image/read_image.h"
#include "program.h"
#include "support/quadrature.h"

using namespace troffer;
using namespace troffer::test;

namespace test_panes {

namespace {

// A pane, 1 km wide, at a given height.
std::string pane(double height) {
  return pbrt_glass({{{-500, -500, height}, {1000, 0, 0}, {0, 1000, 0}}});
}
// Wider than the pane, which would otherwise mirror the surroundings below it.
const char* const floor_below =
    "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n"
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] "
    "\"point3 P\" [-600 -600 0  600 -600 0  600 600 0  -600 600 0]\n";
const char* const two_points = "x,y,z,nx,ny,nz\n.3,.1,0,0,0,1\n1.7,0,0,0,0,1\n";

std::vector<Measured> measure(const std::string& world, const std::vector<std::string>& options) {
  const Folder folder;
  std::vector<std::string> words{"measure", folder.write("s.pbrt", "WorldBegin\n" + world),
                                 "--points", folder.write("p.csv", two_points)};
  words.insert(words.end(), options.begin(), options.end());
  const Finished f = run_program(folder, words);
  CAPTURE(f.err);
  REQUIRE(f.status == 0);
  return measured(f);
}

// Transmittance of several panes, without reflections between them.
double through(double cosine, int panes) {
  return std::pow(pane_transmittance(cosine), panes);
}

struct Case {
  const char* name;
  std::string light;
  double (*irradiance)(double x, double y, int panes);
};

const Case cases[] = {
    {"point", "LightSource \"point\" \"rgb I\" [7 7 7] \"point3 from\" [0 0 2]\n",
     [](double x, double y, int panes) {
       const double d2 = x * x + y * y + 4, c = 2 / std::sqrt(d2);
       return 7 * c / d2 * through(c, panes);
     }},
    {"panel",
     "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [5 5 5]\n"
     "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] "
     "\"point3 P\" [-.5 -.5 2  -.5 .5 2  .5 .5 2  .5 -.5 2]\nAttributeEnd\n",
     [](double x, double y, int panes) {
       return 5 * integrate_2d(
                      [&](double u, double v) {
                        const double d2 = (u - x) * (u - x) + (v - y) * (v - y) + 4;
                        const double c = 2 / std::sqrt(d2);
                        return c * c / d2 * through(c, panes);
                      },
                      -.5, .5, -.5, .5, 20);
     }},
    {"surroundings", "LightSource \"infinite\" \"rgb L\" [2 2 2]\n",
     [](double, double, int panes) {
       return 2 * 2 * pi *
              integrate([&](double c) { return c * through(c, panes); }, 0.0, 1.0, 100);
     }},
};

}  // namespace

TEST_CASE("a pane transmits light by Fresnel's formulas, applied once, by every method") {
  const std::vector<std::vector<std::string>> methods{
      {"--method", "certified"},
      {"--method", "certified", "--indirect", "none"},
      {"--method", "path", "--spp", "8192"},
      {"--method", "path", "--spp", "8192", "--indirect", "none"},
      {"--method", "path", "--spp", "8192", "--depth", "1"},
      {"--method", "fixed"},
      {"--method", "kj92"}};
  for (const Case& c : cases)
    for (const int panes : {1, 2})
      for (const auto& method : methods) {
        // Paths include reflections between two panes, which the closed form leaves out.
        const bool is_whole = method.size() == 2 || method.size() == 4;
        if (panes == 2 && is_whole && method[1] != "fixed" && method[1] != "kj92") continue;
        const auto values =
            measure(floor_below + pane(1) + (panes == 2 ? pane(1.5) : "") + c.light, method);
        const double xs[] = {.3, 1.7}, ys[] = {.1, 0};
        for (size_t i = 0; i < 2; ++i) {
          const double expected = luminous_efficacy * c.irradiance(xs[i], ys[i], panes);
          CAPTURE(c.name);
          CAPTURE(panes);
          CAPTURE(fmt::format("{}", fmt::join(method, " ")));
          CAPTURE(values[i].lx);
          CAPTURE(expected);
          const double bias = method[1] == "kj92" ? 2e-3 : 1e-4;  // rays that agree by chance
          CHECK(std::abs(values[i].lx - expected) < bias * expected + 5 * values[i].error);
          CHECK(values[i].error < 0.02 * expected);
        }
      }
}

TEST_CASE(
    "a glazed window is as free of noise as an open one, and transmits what the glass lets "
    "through") {
  // A room lit by the sky alone through its window. Glass raises the noise by at most an eighth,
  // and paths and the default agree.
  Room room;
  room.has_roof_opening = false;
  room.width = 2;
  room.height = room.sill = 1;
  const std::string walls = pbrt_rectangles(room.walls(), 0.6);
  const std::vector<std::string> sky{"--sky", "even,10000", "--up", "0,0,1"};
  const auto by = [&](const std::string& world, std::vector<std::string> options) {
    options.insert(options.end(), sky.begin(), sky.end());
    return measure(world, options);
  };
  const std::vector<std::string> paths{"--method", "path", "--spp", "16384"};
  const auto open = by(walls, paths), glazed = by(walls + pbrt_glass({room.opening()}), paths);
  const auto usual = by(walls + pbrt_glass({room.opening()}), {});
  for (size_t i = 0; i < open.size(); ++i) {
    CAPTURE(i);
    CAPTURE(open[i].lx);
    CAPTURE(glazed[i].lx);
    CHECK(glazed[i].error < 1.125 * 1.3 * open[i].error);  // 1.3: estimated errors vary themselves
    CHECK(glazed[i].lx > 0.82 * open[i].lx);
    CHECK(glazed[i].lx < 0.92 * open[i].lx);
    CHECK(std::abs(usual[i].lx - glazed[i].lx) <
          5 * std::hypot(usual[i].error, glazed[i].error) + 0.005 * glazed[i].lx);
  }
}

TEST_CASE(
    "a picture through and beside glass: same bytes for 1 and 4 threads, same mean by all "
    "methods") {
  const Folder folder;
  Room room;
  room.has_roof_opening = false;
  room.width = 2;
  room.height = room.sill = 1;
  const std::string scene = folder.write(
      "s.pbrt", "WorldBegin\n" + pbrt_rectangles(room.walls(), 0.6) + pbrt_glass({room.opening()}) +
                    "LightSource \"point\" \"rgb I\" [9 9 9] \"point3 from\" [.5 -4 2]\n" +
                    "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [50 50 50]\n" +
                    "Shape \"disk\" \"float radius\" .3 \"float height\" 1\nAttributeEnd\n" +
                    // A screen of tinted glass within the room, next to the disk.
                    "Material \"dielectric\" \"float eta\" 1\n" +
                    pbrt_glass({{{-1, -1, 0}, {2, 0, 0}, {0, 0, 2}}}));
  std::vector<double> means;
  for (const char* method : {"path", "certified"}) {
    std::vector<std::string> bytes;
    for (const char* threads : {"1", "4"}) {
      const std::string out = folder.path("o.pfm");
      const Finished f =
          run_program(folder, {"render",   scene,         "-o",
                               out,        "--size",      "24x16",
                               "--eye",    "1.8,1.8,2.6", "--target",
                               "-1,-2,.8", "--up",        "0,0,1",
                               "--fov",    "80",          "--method",
                               method,     "--spp",       method[0] == 'p' ? "1024" : "4",
                               "--sky",    "overcast",    "--threads",
                               threads,    "--quiet",     "--error",
                               ".03"});
      CAPTURE(f.err);
      REQUIRE(f.status == 0);
      bytes.push_back(read_file(out));
    }
    CAPTURE(method);
    CHECK(bytes[0] == bytes[1]);
    double sum = 0;
    for (const Rgb& p : read_image(folder.path("o.pfm")).pixels) sum += double(p.g);
    means.push_back(sum);
  }
  CHECK(means[1] == doctest::Approx(means[0]).epsilon(0.02));
}

}  // namespace test_panes
