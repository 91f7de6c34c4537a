// Random mutations of files for the command line's own readers: each is read entirely, or refused
// with one line.
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "app/points_csv.h"
#include "app/report_files.h"
#include "base/error.h"
#include "import/mutations.h"
#include "lighting/luminaire_list.h"
#include "lighting/weather.h"
#include "program.h"
#include "support/beam_ies.h"

using namespace troffer;
using namespace troffer::test;

namespace test_mutated_readers {

TEST_CASE("four thousand mutated weather files are read completely or refused") {
  const Folder folder;
  std::string epw =
      "LOCATION,Wien,-,AUT,none,110350,48.2,16.4,1.0,203.0\nDATA "
      "PERIODS,1,1,Data,Sunday,6/21,6/21\n";
  for (int hour = 9; hour <= 14; ++hour)
    epw +=
        "2005,6,21," + std::to_string(hour) + ",60,?9,20,10,50,99000,900,1300,350,500,600,150,0\n";
  check_mutations(epw, 4000, [&](const std::string& text) {
    const Weather w = read_weather(folder.write("w.epw", text), "06-21T11:30");
    CHECK(std::abs(w.latitude_deg) <= 90);
    CHECK(std::abs(w.longitude_deg) <= 180);
    CHECK(std::isfinite(w.julian_day_ut));
    CHECK(w.direct_normal >= 0);
    CHECK(w.diffuse_horizontal >= 0);
  });
}

TEST_CASE("three thousand mutated lists of luminaires are read completely or refused") {
  const Folder folder;
  folder.write("a.ies", beam_ies(1, {0, 45, 90}, {0}));
  const std::string list =
      "file,x,y,z,dx,dy,dz,rotation,dimming\na.ies,0,0,3,0,0,-1,0,1\na.ies,1.5,2,3,0,1,-1,30,0.5\n";
  check_mutations(list, 3000, [&](const std::string& text) {
    Scene scene;
    add_luminaire_list(scene, folder.write("l.csv", text), {0, 0, -1});
    for (const Light& l : scene.lights) {
      CHECK(std::isfinite(l.position.x + l.position.y + l.position.z));
      CHECK(is_finite(l.radiance));
    }
  });
}

// Squares of such short vectors underflow or have one digit left, so they cannot be normalized.
TEST_CASE("directions that are too short are refused") {
  const Folder folder;
  const std::string points = folder.write("p.csv", "x,y,z,nx,ny,nz\n1,2,3,0,0,3e-23\n");
  CHECK_THROWS_AS(read_points(points), InputError);
  folder.write("a.ies", beam_ies(1, {0, 45, 90}, {0}));
  const std::string list = folder.write("l.csv", "file,x,y,z,dx,dy,dz\na.ies,0,0,3,0,0,-2e-162\n");
  Scene scene;
  CHECK_THROWS_AS(add_luminaire_list(scene, list, {0, 0, -1}), InputError);
  const std::string surface = folder.write(
      "s.json",
      R"({"surfaces": [{"corner": [0, 0, 0], "sides": [[1e-90, 0, 0], [0, 1e-90, 0]]}]})");
  AssessmentOptions options;
  CHECK_THROWS_AS(read_report_file(surface, options), InputError);
}

}  // namespace test_mutated_readers
