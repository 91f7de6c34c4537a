// The analytical cases of CIE 171:2006 on the command line, with default settings. If the
// environment has TROFFER_CIE171=FILE, all cases run and the table of docs/results/cie171.md is
// written to FILE. Otherwise only some of the skies run. References: [1] CIE 171:2006, "Test cases
// to assess the accuracy of lighting computer programs".
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "base/units.h"
#include "daylit_rooms.h"
#include "program.h"
#include "support/quadrature.h"

using namespace troffer;
using namespace troffer::test;

namespace test_cie171 {

namespace {

constexpr double allowed = 0.005;

const char* table_file() {
  return std::getenv("TROFFER_CIE171");
}

// Adds a row of the table: the largest deviation of all points, and the range of expected values.
void tell(const std::string& number, const std::string& what, const std::vector<double>& lx,
          const std::vector<double>& expected) {
  REQUIRE(lx.size() == expected.size());
  double worst = 0, sum = 0;
  double least = expected[0], most = expected[0];
  for (size_t i = 0; i < lx.size(); ++i) {
    CAPTURE(number);
    CAPTURE(what);
    CAPTURE(i);
    CAPTURE(lx[i]);
    CAPTURE(expected[i]);
    // Values below 1 lx count relative to 1 lx: a wall of 1 km is not infinite.
    const double off = std::abs(lx[i] - expected[i]) / std::max(expected[i], 1.0);
    CHECK(off < allowed);
    worst = std::max(worst, off);
    sum += expected[i] > 0 ? lx[i] / expected[i] - 1 : 0;
    least = std::min(least, expected[i]);
    most = std::max(most, expected[i]);
  }
  if (table_file() == nullptr) return;
  std::FILE* f = std::fopen(table_file(), "a");
  REQUIRE(f != nullptr);
  fmt::print(f, "| {} | {} | {} | {:.4g} to {:.4g} | {:+.2f} % | {:.2f} % |\n", number, what,
             lx.size(), least, most, 100 * sum / double(lx.size()), 100 * worst);
  std::fclose(f);
}

std::vector<double> measure(const std::string& world, const std::vector<Point>& points,
                            const std::vector<std::string>& options) {
  const Folder folder;
  const std::string scene = folder.write("scene.pbrt", "WorldBegin\n" + world);
  std::string rows = "x,y,z,nx,ny,nz\n";
  for (const Point& p : points)
    rows += fmt::format("{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g}\n", p.position.x,
                        p.position.y, p.position.z, p.normal.x, p.normal.y, p.normal.z);
  std::vector<std::string> words{"measure", scene, "--points", folder.write("p.csv", rows)};
  words.insert(words.end(), options.begin(), options.end());
  const Finished f = run_program(folder, words);
  CAPTURE(f.err);
  REQUIRE(f.status == 0);
  std::vector<double> lx;
  for (const Measured& m : measured(f)) lx.push_back(m.lx);
  return lx;
}

const Vec3d up{0, 0, 1}, down{0, 0, -1};

// Points on the floor and walls of a room of 4 × 4 × 3 m, away from its edges.
std::vector<Point> room_points() {
  return {{{0, 0, 0}, up},           {{1, .5, 0}, up},          {{1.75, -1.5, 0}, up},
          {{2, 0, .5}, {-1, 0, 0}},  {{2, 1, 1.5}, {-1, 0, 0}}, {{.5, 2, 2}, {0, -1, 0}},
          {{-2, -1, .25}, {1, 0, 0}}};
}

std::string black_room(bool has_roof) {
  Room room;
  if (!has_roof) room.width = room.height = 4;
  return pbrt_rectangles(room.walls(), 0);
}

}  // namespace

TEST_CASE("CIE 171, 5.2: a point source, uniform and with its photometric file") {
  constexpr double candela = 800;
  const Vec3d lamp{0, 0, 2.9};
  const std::string world =
      black_room(false) + fmt::format(
                              "LightSource \"point\" \"rgb I\" [{0:.9g} {0:.9g} {0:.9g}] "
                              "\"point3 from\" [0 0 2.9]\n",
                              candela / luminous_efficacy);
  std::vector<double> even, by_cosine;
  for (const Point& p : room_points()) {
    const Vec3d d = lamp - p.position;
    const double d2 = dot(d, d), e = candela * dot(d, p.normal) / (d2 * std::sqrt(d2));
    even.push_back(e);
    by_cosine.push_back(e * std::pow(d.z / std::sqrt(d2), 3));
  }
  tell("5.2", "a point of 800 cd on all sides", measure(world, room_points(), {}), even);
  const Folder folder;
  std::string ies = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 181 1 1 2 0 0 0\n1 1 25\n";
  for (int i = 0; i <= 180; ++i) ies += fmt::format("{:.9g}\n", 0.5 * i);
  ies += "0\n";
  for (int i = 0; i <= 180; ++i)
    ies += fmt::format("{:.9g}\n", candela * std::pow(std::cos(rad_from_deg(0.5 * i)), 3));
  const std::string file = folder.write("cubed.ies", ies);
  tell("5.2", "a luminaire's file of 800 cos³ γ cd, every half degree",
       measure(world, room_points(), {"--luminaire", "light0=" + file}), by_cosine);
}

TEST_CASE("CIE 171, 5.3: an area source of 1 m² at the ceiling") {
  constexpr double luminance = 2000;
  const Rectangle panel{{-.5, -.5, 2.99}, {0, 1, 0}, {1, 0, 0}};  // faces down
  const std::string world =
      black_room(true) +
      fmt::format("AreaLightSource \"diffuse\" \"rgb L\" [{0:.9g} {0:.9g} {0:.9g}]\n",
                  luminance / luminous_efficacy) +
      pbrt_rectangles({panel}, 0);
  std::vector<double> expected;
  for (const Point& p : room_points()) expected.push_back(illuminance_of(panel, p, luminance));
  tell("5.3", "a diffuse panel of 2000 cd/m²", measure(world, room_points(), {}), expected);
}

namespace {

// The flux that arrives in a room below its opening in the ceiling. By symmetry, a quarter of the
// floor and half a wall suffice.
struct InnerFlux {
  std::vector<Point> points;
  std::vector<double> weights;
  InnerFlux() {
    const auto& rule = gauss_legendre<double>(5);
    for (size_t i = 0; i < 5; ++i)
      for (size_t k = 0; k < 5; ++k) {
        const double u = 2 * rule.nodes[i], v = rule.nodes[k],
                     w = rule.weights[i] * rule.weights[k];
        points.push_back({{u, 2 * v, 0}, up});
        weights.push_back(4 * 4 * w);
        points.push_back({{2, u, 3 * v}, {-1, 0, 0}});
        weights.push_back(8 * 2 * 3 * w);
      }
  }
  double sum(const std::vector<double>& lx) const {
    double flux = 0;
    for (size_t i = 0; i < lx.size(); ++i) flux += weights[i] * lx[i];
    return flux;
  }
};

}  // namespace

TEST_CASE("CIE 171, 5.4: the light that enters through an opening arrives inside") {
  Room room;
  const std::string world = pbrt_rectangles(room.walls(), 0);
  const InnerFlux inner;
  tell("5.4", "even sky of 10 000 lx, opening of 1 m²: lumens on floor and walls",
       {inner.sum(measure(world, inner.points, {"--sky", "even,10000", "--ground", "0"}))},
       {10'000});
}

TEST_CASE("CIE 171, 5.5: the directional transmittance of clear glass") {
  constexpr double lx = 10'000;
  std::vector<double> shares, expected;
  for (const int angle : {0, 10, 20, 30, 40, 50, 60, 70, 80, 85}) {
    const double a = rad_from_deg(double(angle));
    const std::string beam = fmt::format(
        "LightSource \"distant\" \"point3 from\" [{0:.9g} 0 {1:.9g}] \"point3 to\" [0 0 0] "
        "\"rgb L\" [{2:.9g} {2:.9g} {2:.9g}]\n",
        std::sin(a), std::cos(a), lx / luminous_efficacy);
    const std::string pane = pbrt_glass({{{-50, -50, 1}, {100, 0, 0}, {0, 100, 0}}});
    // faces the beam
    const Point p{{0, 0, 0}, {std::sin(a), 0, std::cos(a)}};
    shares.push_back(measure(beam + pane, {p}, {})[0]);
    expected.push_back(pane_transmittance(std::cos(a)) * lx);
  }
  tell("5.5", "10 000 lx in a parallel beam at 0° to 85° through a pane of index 1.5", shares,
       expected);
}

TEST_CASE("CIE 171, 5.6 and 5.7: light reflected by a diffuse square, and past an obstruction") {
  // A vertical beam hits the square y in [0, size]. Vertical and downward-facing points above its
  // edge see only the light that it reflects.
  constexpr double lx = 10'000, reflectance = 0.3;
  const std::string sun = fmt::format(
      "LightSource \"distant\" \"point3 from\" [0 0 1] \"point3 to\" [0 0 0] "
      "\"rgb L\" [{0:.9g} {0:.9g} {0:.9g}]\n",
      lx / luminous_efficacy);
  const auto of_square = [](const Point& p, const Rectangle& square) {
    return illuminance_of(square, p, lx * reflectance / pi);
  };
  for (const double size : {0.5, 4.0, 500.0}) {
    const Rectangle square{{-size / 2, 0, 0}, {size, 0, 0}, {0, size, 0}};
    std::vector<Point> points;
    std::vector<double> expected;
    for (const double h : {0.5, 1.5, 3.0}) {
      points.push_back({{0, 0, h}, {0, 1, 0}});
      points.push_back({{0, 1, h}, down});
    }
    for (const Point& p : points) expected.push_back(of_square(p, square));
    tell("5.6", fmt::format("square of {:g} m, reflectance .3", size),
         measure(sun + pbrt_rectangles({square}, reflectance), points, {}), expected);
  }
  // A black screen, as wide as the square of 4 m, stands across the middle of the square.
  constexpr double screen = 1;
  const Rectangle square{{-2, 0, 0}, {4, 0, 0}, {0, 4, 0}};
  const std::string world = sun + pbrt_rectangles({square}, reflectance) +
                            pbrt_rectangles({{{-2, 2, 0}, {4, 0, 0}, {0, 0, screen}}}, 0);
  std::vector<Point> points;
  std::vector<double> expected;
  for (const double h : {0.75, 1.5, 3.0}) {
    points.push_back({{0, 0, h}, {0, 1, 0}});
    points.push_back({{0, 0, h}, down});
    const double beyond = h > screen ? 2 + 2 * screen / (h - screen) : 4;
    for (size_t i = points.size() - 2; i < points.size(); ++i) {
      expected.push_back(of_square(points[i], {{-2, 0, 0}, {4, 0, 0}, {0, 2, 0}}));
      if (beyond < 4)
        expected.back() += of_square(points[i], {{-2, beyond, 0}, {4, 0, 0}, {0, 4 - beyond, 0}});
    }
  }
  tell("5.7", "the same of 4 m, a black screen of 1 m across it", measure(world, points, {}),
       expected);
}

TEST_CASE("CIE 171, 5.8: interreflections in a closed room") {
  // A cube of 4 m with one reflectance and a point light in its middle. By symmetry each face gets
  // a sixth of the flux, and each sixth of a face an equal part.
  constexpr double candela = 800;
  const Vec3d x{4, 0, 0}, y{0, 4, 0}, z{0, 0, 4};
  const std::vector<Rectangle> faces{{{-2, -2, 0}, x, y}, {{-2, -2, 4}, x, y}, {{-2, -2, 0}, x, z},
                                     {{-2, 2, 0}, x, z},  {{-2, -2, 0}, y, z}, {{2, -2, 0}, y, z}};
  std::vector<Point> points;
  std::vector<double> weights;
  const auto& rule = gauss_legendre<double>(6);
  for (size_t i = 0; i < 6; ++i)
    for (size_t k = 0; k < 6; ++k) {
      points.push_back({{2 * rule.nodes[i], 2 * rule.nodes[k], 0}, up});
      weights.push_back(rule.weights[i] * rule.weights[k]);
    }
  std::vector<double> means, expected;
  for (const double reflectance : {0.0, 0.3, 0.5, 0.8, 0.9}) {
    const auto lx =
        measure(pbrt_rectangles(faces, reflectance) +
                    fmt::format("LightSource \"point\" \"rgb I\" [{0:.9g} {0:.9g} {0:.9g}] "
                                "\"point3 from\" [0 0 2]\n",
                                candela / luminous_efficacy),
                points, {});
    means.push_back(0);
    for (size_t i = 0; i < lx.size(); ++i) means.back() += weights[i] * lx[i];
    expected.push_back(4 * pi * candela / (6 * 16 * (1 - reflectance)));
  }
  tell("5.8", "a cube of 4 m, reflectances 0, .3, .5, .8, .9: mean of a wall", means, expected);
}

namespace {

struct SkyCase {
  std::string number, what;
  Room room;
  double ground = 0;
  double overhang = 0;     // depth of a black roof over the opening's upper edge, m
  double obstruction = 0;  // distance of a black wall of 4 m from the façade, m
  bool is_glazed = false;
};

std::vector<Point> facade_points() {
  return {{{0, -1.5, 0}, up},        {{0, 0, 0}, up},          {{1, 1.5, 0}, up},
          {{0, 2, 1.2}, {0, -1, 0}}, {{2, 0, .7}, {-1, 0, 0}}, {{.5, -.5, 3}, down}};
}

// Returns the rectangles in front of the opening, 1 km wide.
std::vector<Rectangle> outside(const SkyCase& c) {
  std::vector<Rectangle> all;
  constexpr double wide = 500;
  const double top = c.room.sill + c.room.height;
  if (c.overhang > 0)
    all.push_back({{-wide, -2 - c.overhang, top}, {2 * wide, 0, 0}, {0, c.overhang, 0}});
  if (c.obstruction > 0)
    all.push_back({{-wide, -2 - c.obstruction, -wide}, {2 * wide, 0, 0}, {0, 0, wide + 4}});
  return all;
}

double expected_at(const SkyCase& c, const Point& p, const Luminance& sky) {
  // Heights of the edges of outside objects, projected from p onto the opening.
  const double inside = p.position.y + 2;
  const auto height_at_opening = [&](double distance, double z) {
    return p.position.z + (z - p.position.z) * inside / (inside + distance);
  };
  const double top = c.room.sill + c.room.height;
  const double hidden_from = c.overhang > 0 ? height_at_opening(c.overhang, top) : 1e9;
  const double hidden_to = c.obstruction > 0 ? height_at_opening(c.obstruction, 4) : -1e9;
  const auto luminance = [&](const Vec3d& from, const Vec3d& w) {
    const double glass =
        c.is_glazed ? pane_transmittance(std::abs(c.room.has_roof_opening ? w.z : w.y)) : 1;
    if (c.room.has_roof_opening) return glass * sky(w);
    const double z = from.z + w.z * inside / -w.y;
    return z > hidden_from || z < hidden_to ? 0.0 : glass * sky(w);
  };
  return illuminance_through(c.room.opening(), p, luminance,
                             {p.position.z, hidden_from, hidden_to});
}

void check_skies(const SkyCase& c, const std::vector<int>& types) {
  std::vector<Rectangle> rectangles = c.room.walls();
  for (const Rectangle& r : outside(c)) rectangles.push_back(r);
  const std::vector<Point> points = c.room.has_roof_opening ? room_points() : facade_points();
  std::vector<double> lx, expected;
  for (const int type : types) {
    const Luminance sky = cie_sky_of(type, c.ground);
    for (const Point& p : points) expected.push_back(expected_at(c, p, sky));
    const auto values = measure(pbrt_rectangles(rectangles, 0) +
                                    (c.is_glazed ? pbrt_glass({c.room.opening()}) : std::string()),
                                points,
                                {"--sky", fmt::format("cie:{},10000", type), "--sun", "180,60,0",
                                 "--up", "0,0,1", "--ground", fmt::format("{}", c.ground)});
    lx.insert(lx.end(), values.begin(), values.end());
  }
  tell(c.number, c.what, lx, expected);
}

}  // namespace

TEST_CASE("CIE 171, 5.9 to 5.14: sky and ground through openings, clear and obstructed") {
  const Room small_roof, large_roof{true, 4, 4}, window{false, 2, 1, 1}, facade{false, 4, 3, 0};
  const SkyCase cases[] = {{"5.9", "roof opening of 1 × 1 m", small_roof},
                           {"5.9", "roof opening of 4 × 4 m", large_roof},
                           {"5.10", "glazed roof opening of 1 × 1 m", small_roof, 0, 0, 0, true},
                           {"5.10", "glazed roof opening of 4 × 4 m", large_roof, 0, 0, 0, true},
                           {"5.11", "window of 2 × 1 m, ground .3", window, 0.3},
                           {"5.11", "façade of 4 × 3 m, ground .3", facade, 0.3},
                           {"5.12", "glazed window, ground .3", window, 0.3, 0, 0, true},
                           {"5.12", "glazed façade, ground .3", facade, 0.3, 0, 0, true},
                           {"5.13", "window, black roof of 1 m above it", window, 0.3, 1},
                           {"5.14", "window, black wall of 4 m at 6 m", window, 0.3, 0, 6}};
  std::vector<int> types{1, 12};
  if (table_file() != nullptr) {
    types.clear();
    for (int type = 1; type <= 15; ++type) types.push_back(type);
  }
  for (const SkyCase& c : cases) check_skies(c, types);
}

}  // namespace test_cie171
