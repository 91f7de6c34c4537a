// Measured luminaires on the command line.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/units.h"
#include "program.h"

using namespace troffer;
using namespace troffer::test;

namespace test_luminaire_command {

namespace {

// Intensities of 1000 cos^n cd, every degree from the nadir.
std::string ies(int power) {
  std::string text = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 91 1 1 2 1 1 0\n1 1 25\n";
  for (int i = 0; i <= 90; ++i) text += fmt::format("{}\n", i);
  text += "0\n";
  for (int i = 0; i <= 90; ++i)
    text += fmt::format("{:.9g}\n", 1000 * std::pow(std::cos(rad_from_deg(double(i))), power));
  return text;
}

// The material of a panel of 1 m² at a height of 2 m, facing down (`geometry`).
std::string panel_obj(double radiance) {
  return fmt::format("newmtl lit\nKd .5 .5 .5\nKe {0:.9g} {0:.9g} {0:.9g}\n", radiance);
}
const char* const geometry =
    "mtllib m.mtl\nv -.5 -.5 2\nv -.5 .5 2\nv .5 .5 2\nv .5 -.5 2\nusemtl lit\nf 1 2 3 4\n";
const char* const points =
    "x,y,z,nx,ny,nz\n0,0,0,0,0,1\n1.5,0,0.5,0,0,1\n0.2,0.1,1.7,0,0,1\n0,0,-28,0,0,1\n";

std::vector<Measured> measure(const Folder& folder, const std::vector<std::string>& options) {
  return measure_direct(folder, folder.path("panel.obj"), folder.write("p.csv", points), options);
}

}  // namespace

// Figure of the C planes in CIE 121 and LM-63 (type C): a street luminaire emits toward C90. Its C0
// is to the right of that, seen from above, like x and y on a map.
TEST_CASE("C angles run counterclockwise seen from above: C90 lies to the left of C0") {
  const Folder folder;
  std::string ies = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 9 1 2 0 0 0\n1 1 25\n0 90\n";
  std::string ldt =
      "maker\n1\n0\n8\n45\n2\n90\nreport\nname\nnumber\nfile\ndate\n0\n0\n0\n0\n0\n0\n0\n0\n"
      "0\n100\n100\n1\n0\n1\n1\nLED\n1000\n4000\n80\n20\n";
  for (int i = 0; i < 10; ++i) ldt += "0.5\n";
  std::string intensities;
  for (int c = 0; c < 360; c += 45) {
    ies += fmt::format("{} ", c);
    ldt += fmt::format("{}\n", c);
    intensities += c == 90 ? "100\n100\n" : c == 45 ? "30\n30\n" : "0\n0\n";
  }
  folder.write("a.ies", ies.substr(0, ies.rfind(' ')) + " 360\n" + intensities + "0\n0\n");
  folder.write("b.ldt", ldt + "0\n90\n" + intensities);
  folder.write("panel.obj", "v -9 -9 0\nv 9 -9 0\nv 9 9 0\nv -9 9 0\nf 1 2 3 4\n");
  const std::string at =
      folder.write("at.csv",
                   "x,y,z,nx,ny,nz\n0,2,0,0,0,1\n1.414,1.414,0,0,0,1\n0,-2,0,0,0,1\n"
                   "-1.414,1.414,0,0,0,1\n2,0,0,0,0,1\n");
  for (const char* file : {"a.ies", "b.ldt"}) {
    const std::string list = folder.write("list.csv", fmt::format("file,x,y,z\n{},0,0,2\n", file));
    const Finished f =
        run_program(folder, {"measure", folder.path("panel.obj"), "--points", at, "--up", "0,0,1",
                             "--luminaires", list, "--indirect", "none"});
    CAPTURE(file);
    CAPTURE(f.err);
    REQUIRE(f.status == 0);
    const auto lx = measured(f);
    CHECK(lx[0].lx > 0);
    CHECK(lx[1].lx == doctest::Approx(0.3 * lx[0].lx).epsilon(1e-2));
    for (size_t i = 2; i < 5; ++i) CHECK(lx[i].lx == doctest::Approx(0));
  }
}

TEST_CASE(
    "a panel with a cosine distribution equals a diffuse one; a narrow one agrees with subdivided "
    "sums") {
  const Folder folder;
  folder.write("panel.obj", geometry);
  const std::string even = folder.write("even.ies", ies(1)),
                    narrow = folder.write("narrow.ies", ies(5));
  folder.write("m.mtl", panel_obj(1000 / luminous_efficacy));
  const auto diffuse = measure(folder, {});
  for (const char* method : {"certified", "path", "fixed", "kj92"}) {
    const auto measured =
        measure(folder, {"--luminaire", "emitter0=" + even, "--method", method, "--spp", "4096"});
    const auto sharp = measure(folder, {"--luminaire", "emitter0=" + narrow + ",3000", "--method",
                                        method, "--spp", "4096"});
    std::istringstream rows(points);
    std::string row;
    std::getline(rows, row);
    for (size_t i = 0; i < diffuse.size(); ++i) {
      CAPTURE(method);
      CAPTURE(i);
      CHECK(std::abs(measured[i].lx - diffuse[i].lx) <
            1e-3 * diffuse[i].lx + 5 * measured[i].error);
      // Sum over points with 1 / n² of the intensity each.
      std::getline(rows, row);
      double x = 0, y = 0, z = 0;
      REQUIRE(std::sscanf(row.c_str(), "%lf,%lf,%lf", &x, &y, &z) == 3);
      double sum = 0;
      constexpr int n = 200;
      for (int k = 0; k < n * n; ++k) {
        const double dx = (k % n + 0.5) / n - 0.5 - x, dy = (k / n + 0.5) / n - 0.5 - y, dz = 2 - z;
        const double d2 = dx * dx + dy * dy + dz * dz, cosine = dz / std::sqrt(d2);
        // 3000 lm of I cos^5, whose flux is 2 π I / 6.
        sum += 3000 * 3 / pi * std::pow(cosine, 5) * cosine / d2 / (n * n);
      }
      CHECK(std::abs(sharp[i].lx - sum) < 3e-3 * sum + 5 * sharp[i].error);
    }
  }
}

TEST_CASE("info shows the contents of a photometric file; errors take one line") {
  const Folder folder;
  const std::string file = folder.write("even.ies", ies(1));
  const Finished f = run_program(folder, {"info", file, "--json"});
  REQUIRE(f.status == 0);
  const auto j = nlohmann::json::parse(f.out);
  CHECK(j["lumens"].get<double>() == doctest::Approx(1000 * pi).epsilon(1e-3));
  CHECK(j["efficacy"].get<double>() == doctest::Approx(40 * pi).epsilon(1e-3));
  CHECK(j["beam_angle"][0].get<double>() == doctest::Approx(120).epsilon(2e-3));
  CHECK(run_program(folder, {"info", file}).out.find("lm") != std::string::npos);

  folder.write("panel.obj", geometry);
  folder.write("m.mtl", panel_obj(1));
  folder.write("p.csv", points);
  const std::string bad = folder.write("bad.ies", "TILT=NONE\n1 2\n");
  const std::string faint =
      folder.write("faint.ies", "TILT=NONE\n1 1 1 2 1 1 2 1 1 0\n1 1 9\n0 90\n0\n1e-300 0\n");
  for (const auto& [luminaire, status] : {std::pair<std::string, int>{"emitter0=" + bad, 1},
                                          {"emitter0=missing.ies", 1},
                                          {"emitter0=" + faint, 1},
                                          {"nobody=" + file, 2},
                                          {"emitter0", 2},
                                          {"=" + file, 2},
                                          {"emitter0=" + file + ",-3", 2}}) {
    const Finished g = run_program(folder, {"measure", folder.path("panel.obj"), "--points",
                                            folder.path("p.csv"), "--luminaire", luminaire});
    CAPTURE(luminaire);
    CHECK(g.status == status);
    CHECK(g.error_lines().size() == 1);
  }
}

TEST_CASE("a colour temperature colours a luminaire and keeps its lumens") {
  const Folder folder;
  folder.write("panel.obj", geometry);
  folder.write("m.mtl", panel_obj(1));
  const std::string file = folder.write("even.ies", ies(1));
  const auto white = measure(folder, {"--luminaire", "emitter0=" + file + ",3000"});
  for (const auto& [kelvin, is_warm] :
       {std::pair<std::string, bool>{"2700", true}, {"15000", false}}) {
    const std::string option = "emitter0=" + file + ",3000," + kelvin;
    const auto lit = measure(folder, {"--luminaire", option});
    for (size_t i = 0; i < white.size(); ++i)
      CHECK(std::abs(lit[i].lx - white[i].lx) < 2e-3 * white[i].lx + 5 * lit[i].error);
    const Finished f = run_program(folder, {"measure", folder.path("panel.obj"), "--points",
                                            folder.path("p.csv"), "--luminaire", option});
    std::istringstream rows(f.out);
    std::string row;
    std::getline(rows, row);
    std::getline(rows, row);
    double r = 0, g = 0, b = 0;
    REQUIRE(std::sscanf(row.c_str(), "%*f,%*f,%*f,%*f,%*f,%*f,%lf,%lf,%lf", &r, &g, &b) == 3);
    CHECK((r > 1.5 * b) == is_warm);
    CHECK((b > 1.2 * r) == !is_warm);
  }
  for (const char* bad : {",3000,500", ",-1,3000", ",1e10,3000"})
    CHECK(run_program(folder, {"measure", folder.path("panel.obj"), "--points",
                               folder.path("p.csv"), "--luminaire", "emitter0=" + file + bad})
              .status == 2);
}

TEST_CASE("a node with two photometric files uses the last one, with a warning") {
  const Folder folder;
  folder.write("panel.obj", geometry);
  folder.write("m.mtl", panel_obj(1));
  const std::string even = folder.write("even.ies", ies(1)),
                    narrow = folder.write("narrow.ies", ies(5));
  const auto last = measure(folder, {"--luminaire", "emitter0=" + narrow});
  const auto both =
      measure(folder, {"--luminaire", "emitter0=" + even, "--luminaire", "emitter0=" + narrow});
  CHECK(both[0].lx == last[0].lx);
  const Finished f =
      run_program(folder, {"measure", folder.path("panel.obj"), "--points",
                           folder.write("p.csv", points), "--luminaire", "emitter0=" + even,
                           "--luminaire", "emitter0=" + narrow, "--spp", "16"});
  CHECK(f.err.find("'emitter0' is given twice") != std::string::npos);
}

TEST_CASE("control characters in a file's names do not reach the terminal") {
  const Folder folder;
  std::string text = ies(1);
  text.insert(text.find("TILT"),
              "[LUMINAIRE] red \x1b[31mlamp \xc2\x9b"
              "1m\n");
  const Finished f = run_program(folder, {"info", folder.write("red.ies", text)});
  REQUIRE(f.status == 0);
  CHECK(f.out.find("red ?[31mlamp ?1m") != std::string::npos);
  CHECK(f.out.find('\x1b') == std::string::npos);
}

TEST_CASE("a list places luminaires: points and openings, rotated and dimmed") {
  // cos γ with a plane C90 half as strong as C0.
  const auto oval = [](double width, double length) {
    std::string text = fmt::format("IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 91 2 1 2 {} {} 0\n1 1 25\n",
                                   width, length);
    for (int i = 0; i <= 90; ++i) text += fmt::format("{}\n", i);
    text += "0\n90\n";
    for (const double strength : {1000.0, 500.0})
      for (int i = 0; i <= 90; ++i)
        text += fmt::format("{:.9g}\n", strength * std::cos(rad_from_deg(double(i))));
    return text;
  };
  const Folder folder;
  folder.write("point.ies", oval(0, 0));
  folder.write("slot.ies", oval(.01, .02));
  const std::string scene = folder.write("floor.obj", "v -5 -5 0\nv 5 -5 0\nv 5 5 0\nf 1 2 3\n");
  const std::string at = folder.write("p.csv", "x,y,z,nx,ny,nz\n1,0,0,0,0,1\n0,1,0,0,0,1\n");
  const auto lit = [&](const std::string& rows) {
    const Finished f = run_program(
        folder, {"measure", scene, "--points", at, "--indirect", "none", "--luminaires",
                 folder.write("list.csv", "file,x,y,z,dx,dy,dz,rotation,dimming\n" + rows)});
    CAPTURE(f.err);
    REQUIRE(f.status == 0);
    return measured(f);
  };
  const double c = 3 / std::sqrt(10.0), strong = 1000 * c * c / 10, weak = strong / 2;
  for (const char* file : {"point.ies", "slot.ies"}) {
    CAPTURE(file);
    const auto plain = lit(fmt::format("{},0,0,3,0,0,-1,0,1\n", file));
    CHECK(plain[0].lx == doctest::Approx(strong).epsilon(5e-3));
    CHECK(plain[1].lx == doctest::Approx(weak).epsilon(5e-3));
    const auto turned = lit(fmt::format("{},0,0,3,0,0,-1,90,.5\n", file));
    CHECK(turned[0].lx == doctest::Approx(weak / 2).epsilon(5e-3));
    CHECK(turned[1].lx == doctest::Approx(strong / 2).epsilon(5e-3));
    const auto both = lit(fmt::format("{0},0,0,3,0,0,-1,0,1\n{0},0,0,3,0,0,-1,90,1\n", file));
    if (file[0] == 'p') CHECK(both[0].lx == doctest::Approx(strong + weak).epsilon(5e-3));
  }
  for (const char* bad :
       {"file,x,y\n", "file,x,y,z\npoint.ies,0,0\n", "file,x,y,z\npoint.ies,0,0,a\n",
        "file,x,y,z\nnone.ies,0,0,1\n", "file,x,y,z,dx,dy,dz\npoint.ies,0,0,1,0,0,0\n"})
    CHECK(run_program(folder, {"measure", scene, "--points", at, "--luminaires",
                               folder.write("bad.csv", bad)})
              .status == 1);
}

TEST_CASE("polar curves are drawn; other files and endings are refused") {
  const Folder folder;
  const std::string file = folder.write("even.ies", ies(1));
  CHECK(run_program(folder, {"info", file, "--polar", folder.path("c.svg")}).status == 0);
  CHECK(run_program(folder, {"info", file, "--polar", folder.path("c.png")}).status == 0);
  const std::string svg = read_file(folder.path("c.svg"));
  CHECK(svg.starts_with("<svg"));
  CHECK(svg.find("C90") != std::string::npos);
  // 1000 cd at the nadir reach the outermost ring, 200 px below the middle.
  CHECK(svg.find("240.00,440.00") != std::string::npos);
  CHECK(read_file(folder.path("c.png")).starts_with("\x89PNG"));
  CHECK(run_program(folder, {"info", file, "--polar", folder.path("c.gif")}).status == 2);
  const std::string scene = folder.write("floor.obj", "v -5 -5 0\nv 5 -5 0\nv 5 5 0\nf 1 2 3\n");
  CHECK(run_program(folder, {"info", scene, "--polar", folder.path("c.svg")}).status == 2);
}

TEST_CASE("points with a radius light the same surfaces, with soft shadows") {
  const Folder folder;
  folder.write("p.pbrt",
               "WorldBegin\nLightSource \"point\" \"rgb I\" [10 10 10] \"point3 from\" [0 0 2]\n"
               "Shape \"trianglemesh\" \"point3 P\" [-1 -1 1  1 -1 1  1 0 1  -1 0 1]\n"
               "  \"integer indices\" [0 1 2 0 2 3]\n");
  const std::string at = folder.write("p.csv", "x,y,z,nx,ny,nz\n1,1,0,0,0,1\n0,0.01,0,0,0,1\n");
  const auto lit = [&](std::vector<std::string> options) {
    std::vector<std::string> words{"measure", folder.path("p.pbrt"), "--points",
                                   at,        "--indirect",          "none"};
    words.insert(words.end(), options.begin(), options.end());
    const Finished f = run_program(folder, words);
    CAPTURE(f.err);
    REQUIRE(f.status == 0);
    return measured(f);
  };
  const auto hard = lit({}), soft = lit({"--light-radius", "0.2"});
  CHECK(hard[1].lx == doctest::Approx(10 * luminous_efficacy / 4).epsilon(1e-3));
  CHECK(soft[0].lx == doctest::Approx(hard[0].lx).epsilon(2e-3));
  // half of the sphere is visible
  CHECK(soft[1].lx == doctest::Approx(hard[1].lx * .53).epsilon(.03));
}

}  // namespace test_luminaire_command
