// Lists of luminaires as spreadsheets write them, other information about luminaire files, and
// weather files with quotes and gaps.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/units.h"
#include "program.h"

using namespace troffer;
using namespace troffer::test;

namespace test_luminaire_list {

namespace {

// A uniform point of 100 cd downward, 200 π lm.
const char* const point_ies =
    "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 5\n0 90\n0\n100 100\n";

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

struct ListTest {
  Folder folder;
  std::string scene =
      folder.write("floor.obj", "v -9 -9 0\nv 9 -9 0\nv 9 9 0\nv -9 9 0\nf 1 2 3 4\n");
  std::string points = folder.write("p.csv", "x,y,z,nx,ny,nz\n1,2,0,0,0,1\n");
  std::string lamp = folder.write("lamp.ies", point_ies);

  Finished run(const std::string& list) {
    return run_program(folder, {"measure", scene, "--points", points, "--indirect", "none",
                                "--luminaires", folder.write("list.csv", list)});
  }
  double lx(const std::string& list) {
    const Finished f = run(list);
    CAPTURE(list);
    CAPTURE(f.err);
    REQUIRE(f.status == 0);
    return measured(f)[0].lx;
  }
};

}  // namespace

TEST_CASE("lists of luminaires: quotes, separators, decimal commas, columns in any order") {
  ListTest t;
  t.folder.write("lamp, big.ies", point_ies);
  const double expected = 100 / 6.25;
  for (const char* list :
       {"file,x,y,z\nlamp.ies,1,2,2.5\n", "file,x,y,z\n\"lamp.ies\",\"1\",\"2\",\"2.5\"\n",
        "file,x,y,z\n\"lamp, big.ies\",1,2,2.5\n", "file;x;y;z\nlamp.ies;1,0;2;2,5\n",
        "file\tx\ty\tz\nlamp.ies\t1\t2\t2,5\n", "File, X, Y, Z \r\n lamp.ies , 1 , 2 , +2.5 \r\n",
        "# of the office\nz,y,x,file\n\n2.5,2,1,lamp.ies\n", "file,x,y,z\rlamp.ies,1,2,2.5\r",
        "file,x,y,z,dx,dy,dz,rotation,dimming\nlamp.ies,1,2,2.5,,,,,\n",
        "file,x,y,z,dimming,\nlamp.ies,1,2,2.5\n", "file,x,y,z,dimming\nlamp.ies,1,2,2.5,1\n",
        "\xef\xbb\xbf\"file\",\"x\",\"y\",\"z\"\nlamp.ies,1,2,2.5"}) {
    CAPTURE(list);
    CHECK(t.lx(list) == doctest::Approx(expected).epsilon(1e-4));
  }
  CHECK(t.lx("file,x,y,z,lumens\nlamp.ies,1,2,2.5,400\n") ==
        doctest::Approx(expected * 400 / (200 * pi)).epsilon(1e-3));
  CHECK(t.lx("file,x,y,z,kelvin,dimming\nlamp.ies,1,2,2.5,2700,.5\n") ==
        doctest::Approx(expected / 2).epsilon(1e-3));
}

TEST_CASE("lists of luminaires: errors name the line, and no file is read from other folders") {
  ListTest t;
  t.folder.write("outside.ies", point_ies);
  for (const auto& [list, place] : std::initializer_list<std::pair<std::string, std::string>>{
           {"file,x,y,z\nlamp.ies,1,2\n", "2:13: column 'z' is missing"},
           {"file,x,y,z\nlamp.ies,1,2,3,4\n", "2:16: 4 columns"},
           {"file,x,y,z\nlamp.ies,1,2,three\n", "2:14: column 'z'"},
           {"file,x,y,z\nlamp.ies,1,2,1e10\n", "2:14: column 'z'"},
           {"file,x,y,z\nlamp.ies,1;2,2,3\n", "2:10: column 'x'"},
           {"file,x,y,z\n\ngone.ies,1,2,3\n", "3:1: file 'gone.ies'"},
           {"file,x,y,z\n../" + t.folder.path("").substr(1) + "outside.ies,1,2,3\n", "2:1: file"},
           {"file,x,y,z\n" + t.lamp + ",1,2,3\n", "2:1: file"},
           {"file,x,y,z,dx\nlamp.ies,1,2,3,0\n", "1:1: the header"},
           {"file,x,y,z,z\nlamp.ies,1,2,3,0\n", "1:1: the header"},
           {"file,x,y,z,dx,dy,dz\nlamp.ies,1,2,3,0,,1\n", "2:16: a direction"},
           {"file,x,y,z,kelvin\nlamp.ies,1,2,3,500\n", "2:16: kelvin"},
           {"", "1:1: the header"}}) {
    const Finished f = t.run(list);
    CAPTURE(list);
    CAPTURE(f.err);
    CHECK(f.status == 1);
    CHECK(contains(f.err, "list.csv:" + place));
    CHECK(f.error_lines().size() == 1);
  }
}

TEST_CASE(
    "lumens that contradict the intensities cause a warning, and non-cosine beams are measured") {
  const Folder folder;
  const auto info = [&](const std::string& text) {
    const Finished f = run_program(folder, {"info", folder.write("a.ies", text), "--json"});
    REQUIRE(f.status == 0);
    return nlohmann::json::parse(f.out);
  };
  const auto with = [&](const char* lamps, const char* heights, const char* values) {
    return fmt::format("TILT=NONE\n{} 1 5 1 1 2 0 0 0\n1 1 5\n{}\n0\n{}\n", lamps, heights, values);
  };
  const char *below = "0 30 60 90 180", *even = "100 100 100 100 0";
  CHECK(info(with("1 -1", below, even))["warnings"].empty());
  CHECK(info(with("2 600", below, even))["warnings"].empty());
  const auto wrong = info(with("1 600", below, even))["warnings"];  // it emits about 1200 lm
  REQUIRE(wrong.size() == 1);
  CHECK(contains(wrong[0].get<std::string>(), "600 lm"));
  // A batwing: half of its largest intensity at 15 and 75 degrees. Then the same upward.
  const auto wings = info(with("1 -1", below, "0 100 100 0 0"));
  CHECK(wings["beam_angle"][0].get<double>() == doctest::Approx(150).epsilon(2e-3));
  CHECK(wings["field_angle"][1].get<double>() == doctest::Approx(174).epsilon(2e-3));
  const auto up = info(with("1 -1", "0 90 120 150 180", "0 0 100 100 0"));
  CHECK(up["beam_angle"][0].get<double>() == doctest::Approx(150).epsilon(2e-3));
}

TEST_CASE("weather files: quoted names and hours without data") {
  const Folder folder;
  const std::string scene = folder.write("floor.obj", "v -9 -9 0\nv 9 -9 0\nv 9 9 0\nf 1 2 3\n");
  const std::string points = folder.write("p.csv", "x,y,z,nx,ny,nz\n1,0,0,0,0,1\n");
  std::string epw =
      "LOCATION,\"Sydney, NSW\",\"a \"\"b\"\"\",AUS,RMY,947670,-33.95,151.18,10.0,3.0\n"
      "DATA PERIODS,1,1,Data,Sunday,1/1,12/31\n";
  const char* const irradiances[] = {"500,150", "9999,150", "500,", "500,99999", "500,x"};
  for (int i = 0; i < 5; ++i)
    epw += fmt::format("2005,1,{},13,60,?9,20,10,50,99000,900,1300,350,500,{},0,0\r\n", i + 1,
                       irradiances[i]);
  const std::string file = folder.write("w.epw", epw);
  for (int day = 1; day <= 5; ++day) {
    const Finished f =
        run_program(folder, {"measure", scene, "--points", points, "--indirect", "none",
                             "--weather", file, "--date", fmt::format("01-0{}T12:30", day)});
    CAPTURE(day);
    CAPTURE(f.err);
    CHECK(f.status == (day == 1 ? 0 : 1));
    if (day == 1) CHECK(measured(f)[0].lx > 50'000);
    if (day == 2 || day == 3 || day == 4)
      CHECK(contains(f.err,
                     fmt::format("w.epw:{}:1: the irradiances of this hour are missing", day + 2)));
  }
  const Finished f = run_program(folder, {"measure", scene, "--points", points, "--weather", file,
                                          "--at", "-33.95,151.18,2024-02-29T12:30+10:00"});
  CHECK(contains(f.err, "has no row for 02-29T12:30"));
}

}  // namespace test_luminaire_list
