// Luminous openings of measured luminaires on the command line.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/units.h"
#include "base/vec.h"
#include "program.h"

using namespace troffer;
using namespace troffer::test;

namespace test_luminous_openings {

namespace {

// Points, each with its normal times the area that it stands for.
using Surface = std::vector<std::pair<Vec3d, Vec3d>>;

// Adds the midpoints of n × n parts of a rectangle.
void add_rectangle(const Vec3d& middle, const Vec3d& u, const Vec3d& v, int n, Surface& out) {
  for (int k = 0; k < n * n; ++k)
    out.emplace_back(middle + u * ((k % n + .5) / n - .5) + v * ((k / n + .5) / n - .5),
                     cross(u, v) / double(n * n));
}

Surface box_points(int n) {
  Surface p;
  for (const double s : {1.0, -1.0}) {
    add_rectangle({0, 0, -.1 * s}, {1, 0, 0}, {0, -.6 * s, 0}, n, p);
    add_rectangle({.5 * s, 0, 0}, {0, .6 * s, 0}, {0, 0, .2}, n, p);
    add_rectangle({0, .3 * s, 0}, {0, 0, .2}, {1 * s, 0, 0}, n, p);
  }
  return p;
}
Surface sphere_points(int n) {
  Surface p;
  for (int k = 0; k < n * n; ++k) {
    const double z = 1 - 2 * (k / n + .5) / n, turn = 2 * pi * (k % n + .5) / n;
    const Vec3d d{std::sqrt(1 - z * z) * std::cos(turn), std::sqrt(1 - z * z) * std::sin(turn), z};
    p.emplace_back(d * .2, d * (4 * pi * .04 / (n * n)));
  }
  return p;
}
Surface cylinder_points(int n) {
  Surface p;
  for (int k = 0; k < n * n; ++k) {
    const double turn = 2 * pi * (k % n + .5) / n, r = .2 * std::sqrt((k / n + .5) / n);
    const Vec3d d{std::cos(turn), std::sin(turn), 0};
    p.emplace_back(d * .2 + Vec3d{0, 0, (k / n + .5) / n - .5}, d * (2 * pi * .2 / (n * n)));
    for (const double s : {1.0, -1.0})
      p.emplace_back(d * r + Vec3d{0, 0, .5 * s}, Vec3d{0, 0, s * pi * .04 / (n * n)});
  }
  return p;
}
Surface disc_points(int n) {
  Surface p;
  for (int k = 0; k < n * n; ++k) {
    const double turn = 2 * pi * (k % n + .5) / n, r = .2 * std::sqrt((k / n + .5) / n);
    p.emplace_back(Vec3d{r * std::cos(turn), r * std::sin(turn), 0},
                   Vec3d{0, 0, -pi * .04 / (n * n)});
  }
  return p;
}

// 1000 (.4 + .6 cos²γ): a smooth web with light in all directions.
double candela(double cosine) {
  return 1000 * (.4 + .6 * cosine * cosine);
}

// Areas that are seen from direction w, in closed form.
double seen_box(const Vec3d& w) {
  return .6 * .2 * std::abs(w.x) + 1 * .2 * std::abs(w.y) + 1 * .6 * std::abs(w.z);
}
double seen_sphere(const Vec3d&) {
  return pi * .04;
}
double seen_cylinder(const Vec3d& w) {
  return 2 * .2 * std::hypot(w.x, w.y) + pi * .04 * std::abs(w.z);
}
double seen_disc(const Vec3d& w) {
  return pi * .04 * std::abs(w.z);
}

}  // namespace

TEST_CASE(
    "openings of every shape give the measured light far away and agree with subdivided sums "
    "nearby") {
  const Folder folder;
  folder.write("floor.obj", "v -5 -5 -9\nv 5 -5 -9\nv 5 5 -9\nf 1 2 3\n");
  struct Opening {
    const char* dimensions;  // width, length, height
    Surface (*surface_of)(int);
    double (*seen_area)(const Vec3d&);
    bool is_flat;
  };
  for (const auto& [dimensions, surface_of, seen_area, is_flat] :
       {Opening{"0.6 1 0.2", box_points, seen_box, false},
        Opening{"-0.4 -0.4 -0.4", sphere_points, seen_sphere, false},
        Opening{"-0.4 -0.4 1", cylinder_points, seen_cylinder, false},
        Opening{"-0.4 -0.4 0", disc_points, seen_disc, true}}) {
    std::string text =
        fmt::format("IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 181 1 1 2 {}\n1 1 25\n", dimensions);
    for (int i = 0; i <= 180; ++i) text += fmt::format("{}\n", i);
    text += "0\n";
    for (int i = 0; i <= 180; ++i)
      text += fmt::format("{:.9g}\n", candela(std::cos(rad_from_deg(double(i)))));
    folder.write("body.ies", text);
    const std::string list = folder.write("list.csv", "file,x,y,z\nbody.ies,0,0,0\n");
    const std::vector<Vec3d> receivers{{.2, .1, -.9}, {.9, .3, -.3}, {.3, -.8, .7}, {20, 9, -31}};
    std::string rows = "x,y,z,nx,ny,nz\n";
    for (const Vec3d& x : receivers)
      rows += fmt::format("{},{},{},{},{},{}\n", x.x, x.y, x.z, -x.x, -x.y, -x.z);
    const std::string at = folder.write("p.csv", rows);
    const auto surface = surface_of(150);
    std::vector<double> sums;
    for (const Vec3d& x : receivers) {
      double sum = 0;
      for (const auto& [p, n] : surface) {
        const Vec3d d = x - p;
        const Vec3d w = normalize(d);
        const double out = is_flat ? std::abs(dot(n, w)) : std::max(0.0, dot(n, w));
        if (!(out > 0)) continue;
        sum += candela(w.z) / seen_area(w) * out * dot(w, normalize(x)) / dot(d, d);
      }
      sums.push_back(sum);
    }
    const Vec3d& far = receivers.back();
    CHECK(sums.back() ==
          doctest::Approx(candela(far.z / length(far)) / dot(far, far)).epsilon(2e-3));
    for (const char* method : {"certified", "path"}) {
      const Finished f =
          run_program(folder, {"measure", folder.path("floor.obj"), "--points", at, "--indirect",
                               "none", "--luminaires", list, "--method", method, "--spp", "4096"});
      CAPTURE(f.err);
      REQUIRE(f.status == 0);
      const auto lit = measured(f);
      for (size_t i = 0; i < receivers.size(); ++i) {
        CAPTURE(dimensions);
        CAPTURE(method);
        CAPTURE(i);
        CHECK(std::abs(lit[i].lx - sums[i]) < 3e-3 * sums[i] + 5 * lit[i].error);
      }
    }
  }
}

TEST_CASE("certified: the light of half-hidden measured openings agrees with rays") {
  const Folder folder;
  // A box with luminous sides, with a board in front of it.
  std::string text = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 181 3 1 2 0.6 1.2 0.1\n1 1 25\n";
  for (int i = 0; i <= 180; ++i) text += fmt::format("{}\n", i);
  text += "0\n45\n90\n";
  for (int plane = 1; plane <= 3; ++plane)
    for (int i = 0; i <= 180; ++i) {
      const double c = std::max(0.0, std::cos(rad_from_deg(i * .8)));
      text += fmt::format("{:.9g}\n", 300.0 * plane * std::pow(c, 2 + plane));
    }
  folder.write("box.ies", text);
  const std::string list =
      folder.write("list.csv", "file,x,y,z,dx,dy,dz,rotation\nbox.ies,0,0,2.5,0,.2,-1,30\n");
  const std::string scene = folder.write(
      "board.obj",
      "v -5 -5 0\nv 5 -5 0\nv 5 5 0\nv -5 5 0\nf 1 2 3 4\nv -.4 -.3 1.6\nv .5 -.4 1.6\n"
      "v .4 .3 1.7\nv -.3 .3 1.6\nf 5 6 7 8\n");
  std::string rows = "x,y,z,nx,ny,nz\n";
  for (int i = 0; i < 60; ++i)
    rows += fmt::format("{},{},0,0,0,1\n", -1.5 + .3 * (i % 10), -1 + .4 * double(i / 10));
  const std::string at = folder.write("p.csv", rows);
  const auto lit = [&](const char* method, const char* spp) {
    const Finished f =
        run_program(folder, {"measure", scene, "--points", at, "--indirect", "none", "--luminaires",
                             list, "--method", method, "--spp", spp});
    CAPTURE(f.err);
    REQUIRE(f.status == 0);
    return measured(f);
  };
  const auto proved = lit("certified", "64"), by_rays = lit("fixed", "16384");
  double chi2 = 0;
  int hidden = 0;
  for (size_t i = 0; i < proved.size(); ++i) {
    // Noise of rays and of masks, and a thousandth, since their errors are estimates.
    const double allowed = std::hypot(by_rays[i].error, proved[i].error) + 1e-3 * by_rays[i].lx;
    CAPTURE(i);
    CHECK(std::abs(proved[i].lx - by_rays[i].lx) <= 5 * allowed);
    if (!(allowed > 0)) continue;
    chi2 += std::pow((proved[i].lx - by_rays[i].lx) / allowed, 2) / double(proved.size());
    hidden += by_rays[i].lx < .5 * by_rays[0].lx ? 1 : 0;
  }
  CHECK(chi2 < 1.5);
  CHECK(hidden > 3);  // points in the board's shadow
}

}  // namespace test_luminous_openings
