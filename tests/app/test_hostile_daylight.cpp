// Skies and suns in difficult geometry: through a pane and slats, in rooms of a millimetre and of
// kilometres, far from the origin, with the sun at the horizon and in a wall's plane, and by images
// with all light in one pixel.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "program.h"

using namespace troffer;
using namespace troffer::test;

namespace test_hostile_daylight {

namespace {

// Scales, then moves.
struct Place {
  double scale = 1;
  std::array<double, 3> shift{0, 0, 0};
  std::string at(const std::array<double, 3>& p) const {
    return fmt::format("{:.9g} {:.9g} {:.9g} ", scale * p[0] + shift[0], scale * p[1] + shift[1],
                       scale * p[2] + shift[2]);
  }
};

using Corner = std::array<double, 3>;

std::string quad(const Place& place, const Corner& a, const Corner& b, const Corner& c,
                 const Corner& d) {
  return "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [" + place.at(a) +
         place.at(b) + place.at(c) + place.at(d) + "]\n";
}

std::string box(const Place& p, const Corner& a, const Corner& b) {
  const auto corner = [&](int i) {
    return Corner{i % 2 ? b[0] : a[0], i / 2 % 2 ? b[1] : a[1], i / 4 ? b[2] : a[2]};
  };
  std::string s;
  for (const auto& f : {std::array{0, 1, 3, 2},
                        {4, 6, 7, 5},
                        {0, 4, 5, 1},
                        {2, 3, 7, 6},
                        {0, 2, 6, 4},
                        {1, 5, 7, 3}})
    s += quad(p, corner(f[0]), corner(f[1]), corner(f[2]), corner(f[3]));
  return s;
}

// Thick walls, a glazed window in the wall at x = 5 with twenty slats outside, and shelves with
// books.
std::string room(const Place& p) {
  std::string s = "WorldBegin\nMaterial \"diffuse\" \"rgb reflectance\" [.6 .6 .6]\n";
  s += box(p, {-.2, -.2, -.2}, {5.2, 4.2, 0}) + box(p, {-.2, -.2, 2.7}, {5.2, 4.2, 2.9});
  s += box(p, {-.2, -.2, 0}, {0, 4.2, 2.7}) + box(p, {0, -.2, 0}, {5, 0, 2.7});
  s += box(p, {0, 4, 0}, {5, 4.2, 2.7});
  s += box(p, {5, -.2, 0}, {5.2, 1, 2.7}) + box(p, {5, 3, 0}, {5.2, 4.2, 2.7});
  s += box(p, {5, 1, 0}, {5.2, 3, .9}) + box(p, {5, 1, 2.1}, {5.2, 3, 2.7});
  for (int i = 0; i < 20; ++i) {
    const double z = .9 + .06 * (i + .5);
    s += quad(p, {4.95, 1, z - .015}, {4.95, 3, z - .015}, {4.975, 3, z + .015},
              {4.975, 1, z + .015});
  }
  for (int k = 0; k < 4; ++k)
    for (int i = 0; i < 12; ++i)
      s += box(p, {.05, 2.4 + .12 * i, .1 + .4 * k}, {.25, 2.46 + .12 * i, .35 + .4 * k});
  return s + "Material \"thindielectric\" \"float eta\" 1.5\n" +
         quad(p, {5.1, 1, .9}, {5.1, 3, .9}, {5.1, 3, 2.1}, {5.1, 1, 2.1});
}

std::string points(const Place& p) {
  std::string s = "x,y,z,nx,ny,nz\n";
  for (const Corner& c : {Corner{1, .6, .9}, {4.2, 2.1, .6}, {2, 2, .9}, {.6, 3, 1.2}}) {
    std::string at = p.at(c);
    for (char& x : at)
      if (x == ' ') x = ',';
    s += at + (c[0] < .7 ? "1,0,0\n" : "0,0,1\n");
  }
  return s;
}

std::vector<Measured> measure(const Place& place, const std::vector<std::string>& options) {
  const Folder folder;
  return measure_direct(folder, folder.write("s.pbrt", room(place)),
                        folder.write("p.csv", points(place)), options);
}

std::vector<std::string> with(std::vector<std::string> options, std::vector<std::string> more) {
  options.insert(options.end(), more.begin(), more.end());
  return options;
}

// share: relative difference between methods that is allowed beyond their errors.
void check_agreement(const std::vector<std::string>& light, const Place& place = {},
                     double share = 3e-3) {
  const auto proved = measure(place, light);
  const auto cast = measure(place, with(light, {"--method", "fixed", "--spp", "32768"}));
  const auto paths =
      measure(place, with(light, {"--method", "path", "--depth", "1", "--spp", "32768"}));
  for (size_t i = 0; i < proved.size(); ++i) {
    CAPTURE(light.back());
    CAPTURE(i);
    CHECK(proved[i].lx > 0);
    CHECK(std::abs(proved[i].lx - cast[i].lx) <
          5 * (cast[i].error + proved[i].error) + share * proved[i].lx);
    CHECK(std::abs(proved[i].lx - paths[i].lx) <
          5 * (paths[i].error + proved[i].error) + share * proved[i].lx);
  }
}

}  // namespace

TEST_CASE(
    "sky and sun through a pane and slats: the sun high, at the horizon, and in the plane of the "
    "wall") {
  for (const char* sun : {"92,30", "90,0.2", "0,40"})
    check_agreement({"--sky", "clear", "--sun", sun});
}

TEST_CASE(
    "a room gives the same picture at any scale, far from the origin, and for any number of "
    "threads") {
  const std::vector<std::string> light{"--sky", "clear", "--sun", "92,30"};
  const auto here = measure({}, with(light, {"--threads", "1"}));
  const auto again = measure({}, with(light, {"--threads", "2"}));
  for (size_t i = 0; i < here.size(); ++i) CHECK(here[i].lx == again[i].lx);
  for (const double scale : {1e-3, 400.0}) {
    const auto there = measure({scale, {0, 0, 0}}, light);
    for (size_t i = 0; i < here.size(); ++i) {
      CAPTURE(scale);
      CAPTURE(i);
      CHECK(std::abs(there[i].lx - here[i].lx) <
            2e-3 * here[i].lx + 5 * (there[i].error + here[i].error));
    }
  }
  // Far from the origin, points start further off the surface. This moves the shadows of the
  // slats, equally for all methods.
  check_agreement(light, {1, {10240, -10240, 0}});
}

TEST_CASE(
    "an environment image with all its light in one pixel lights the room through the window") {
  const Folder folder;
  // East is in the middle of a row; the pixel is 30 degrees high.
  std::string pfm = "PF\n128 64\n-1\n";
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 128; ++x) {
      const float v = x == 63 && y == 42 ? 1e6f : 10.0f;
      for (int c = 0; c < 3; ++c) pfm.append(reinterpret_cast<const char*>(&v), sizeof v);
    }
  // A slat's shadow hides .5 % of what paths find, and the estimated errors do not include it.
  check_agreement({"--environment", folder.write("hot.pfm", pfm)}, {}, 4e-3);
}

}  // namespace test_hostile_daylight
