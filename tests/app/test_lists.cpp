// Tables of points, luminaires and surfaces: one reader accepts whatever a spreadsheet writes.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "program.h"

using namespace troffer;
using namespace troffer::test;

namespace test_lists {

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != text.npos;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

// Returns the illuminance of the first point; columns of the list may follow it.
double lx_of(const std::string& csv) {
  std::istringstream row(lines_of(csv).at(1));
  std::string field;
  for (int i = 0; i < 10; ++i) std::getline(row, field, ',');
  return std::stod(field);
}

struct ListsTest {
  Folder folder;
  std::string scene =
      folder.write("floor.obj", "v -9 -9 0\nv 9 -9 0\nv 9 9 0\nv -9 9 0\nf 1 2 3 4\n");
  std::string lamp = folder.write(
      "lamp.ies", "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 5\n0 90\n0\n100 100\n");

  Finished measure(const std::string& points, const std::string& list) {
    return run_program(folder,
                       {"measure", scene, "--points", folder.write("p.csv", points), "--luminaires",
                        folder.write("list.csv", list), "--indirect", "none", "--up", "0,0,1"});
  }
};

const char* const plain_list = "file,x,y,z\nlamp.ies,1,2,2.5\n";
constexpr double expected = 100 / 6.25;  // lx, 2.5 m below a point of 100 cd

}  // namespace

// RFC 4180, and spreadsheets in countries with a decimal comma.
TEST_CASE("lists of points and luminaires accept the same table formats") {
  ListsTest t;
  for (const std::string form :
       {"#HEAD#,x,y,z#MORE#\n#ITEM#,1,2,#Z##REST#\n",
        "#HEAD#;x;y;z#MORE#\n#ITEM#;1,0;2;#Z##REST#\n",
        "#HEAD#\tx\ty\tz#MORE#\n#ITEM#\t1\t2,0\t#Z##REST#\n",
        "sep=;\n#HEAD#;X;Y;Z#MORE#\n#ITEM#;1;2;#Z##REST#\n",
        "\xef\xbb\xbf#HEAD#,X,Y,Z#MORE#\r\n# a comment\r\n\r\n,,,\r\n#ITEM#,1,2,#Z##REST#\r\n",
        "#HEAD#, x , y , z #MORE#\r #ITEM# , +1 , \"2\" , #Z# #REST#\r",
        "# first\n  # and second\n#HEAD#,x,y,z#MORE#\n#ITEM#,1e0,2.,#Z##REST#"}) {
    CAPTURE(form);
    const char separator = contains(form, ";") ? ';' : contains(form, "\t") ? '\t' : ',';
    const auto filled = [&](std::string head, std::string item, std::string z, std::string more,
                            std::string rest) {
      std::string text = form;
      for (std::string* s : {&more, &rest})
        for (char& c : *s)
          if (c == ',') c = separator;
      for (const auto& [key, value] : {std::pair<std::string, std::string>{"#HEAD#", head},
                                       {"#ITEM#", item},
                                       {"#Z#", z},
                                       {"#MORE#", more},
                                       {"#REST#", rest}})
        text.replace(text.find(key), key.size(), value);
      return text;
    };
    const Finished points =
        t.measure(filled("name", "desk", "0", ",nx,ny,nz", ",0,0,1"), plain_list);
    CAPTURE(points.err);
    REQUIRE(points.status == 0);
    CHECK(lx_of(points.out) == doctest::Approx(expected).epsilon(1e-4));
    const Finished lamps =
        t.measure("x,y,z,nx,ny,nz\n1,2,0,0,0,1\n", filled("file", "lamp.ies", "2.5", "", ""));
    CAPTURE(lamps.err);
    REQUIRE(lamps.status == 0);
    CHECK(measured(lamps)[0].lx == doctest::Approx(expected).epsilon(1e-4));
  }
}

TEST_CASE("unknown columns in a list of points are reported and ignored") {
  ListsTest t;
  // Results of another run are accepted, too.
  const Finished f = t.measure(
      "Room,x,y,z,nx,ny,nz,illuminance_lx\nA,1,2,0,0,0,1,7\n\"B, left\",1,2,0,0,0,1\n", plain_list);
  REQUIRE(f.status == 0);
  CHECK(contains(f.err, "note: columns 'room', 'illuminance_lx' of "));
  const std::vector<std::string> lines = lines_of(f.out);
  REQUIRE(lines.size() == 3);
  CHECK(lines[0].ends_with("illuminance_lx,standard_error"));
  CHECK(lx_of(f.out) == doctest::Approx(expected).epsilon(1e-4));
}

TEST_CASE("unknown columns in a list of luminaires are reported and ignored") {
  ListsTest t;
  const Finished f = t.measure("x,y,z,nx,ny,nz\n1,2,0,0,0,1\n",
                               "file,x,y,z,dimmming,colour\nlamp.ies,1,2,2.5,.5,red\n");
  REQUIRE(f.status == 0);
  CHECK(measured(f)[0].lx == doctest::Approx(expected).epsilon(1e-4));
  CHECK(contains(f.err, "columns 'dimmming', 'colour' of "));
  CHECK(contains(f.err, "list.csv are not used"));
}

TEST_CASE("errors in a list of points name line and column") {
  ListsTest t;
  for (const auto& [points, place] : std::initializer_list<std::pair<std::string, std::string>>{
           {"x,y,z,nx,ny,nz\n", "p.csv"},  // no point
           {"x,y,z,nx,ny,nz,x\n1,2,0,0,0,1,1\n",
            "1:1: the header x,y,z,nx,ny,nz has column 'x' twice"},
           {"x,y,z,nx,ny,nz\n1,5,2,0,0,0\n", "2:7: the normal"},
           {"x,y,z,nx,ny,nz\n\"1,5\",2,0,0,0,1\n", "2:1: column 'x': '1,5' is not a number (with"},
           {"x,y,z,nx,ny,nz\n1e300,2,0,0,0,1\n", "2:1: column 'x': '1e300' is out of range"},
           {"x,y,z,nx,ny,nz\n1,nan,0,0,0,1\n", "2:3: column 'y': 'nan' is not a number"},
           {"x;y;z;nx;ny;nz\n1;2;0;0;0;eins\n", "2:11: column 'nz': 'eins'"},
           {"x,y,z,nx,ny,nz\n1,2,0,0,0,1\n\"1,2,0,0,0,1\n", "3:1: a quote is not closed"},
           {"x,y,z,nx,ny,nz\n\"1\n\",2,0,0,0,1\nq,2,0,0,0,1\n", "2:1: column 'x'"},
           {"x y z nx ny nz\n1 2 0 0 0 1\n", "1:1: the header x,y,z,nx,ny,nz lacks column 'x'"}}) {
    const Finished f = t.measure(points, plain_list);
    CAPTURE(points);
    CAPTURE(f.err);
    CHECK(f.status == 1);
    CHECK(contains(f.err, place));
    CHECK(f.error_lines().size() == 1);
  }
}

TEST_CASE("report reads surfaces from a table as well as from JSON") {
  const Folder folder;
  const std::string scene = folder.write("lit.pbrt", lit_floor_pbrt);
  const auto report = [&](const std::string& name, const std::string& text) {
    const Finished f = run_program(
        folder, {"report", scene, "-o", folder.path("r"), "--pictures", "off", "--cylindrical",
                 "off", "--contributions", "off", "--spp", "32", "--up", "0,0,1", "--surfaces",
                 folder.write(name, text), "--observer", "0,0,1,1,0,0"});
    CAPTURE(f.err);
    REQUIRE(f.status == 0);
    auto j = nlohmann::json::parse(read_file(folder.path("r/report.json")));
    return std::pair{j["surfaces"], f.err};
  };
  const auto json = report("s.json", R"({"surfaces":[{"name":"desk","corner":[0,0,0.7],)"
                                     R"("sides":[[1,0,0],[0,0.5,0]],"border":0.1}]})");
  const auto table = report(
      "s.csv", "name;x;y;z;ax;ay;az;bx;by;bz;border;colour\ndesk;0;0;0,7;1;0;0;0;0,5;0;0,1;red\n");
  CHECK(json.first == table.first);
  CHECK(contains(table.second, "column 'colour'"));
  for (const char* bad : {"name,x,y,z\ndesk,0,0,1\n", "colour\nred\n", "node\n",
                          "node,x\nfloor,1\n", "x,y,z,ax,ay,az,bx,by,bz\n0,0,0,1,0,0,1,0,0\n"}) {
    CAPTURE(bad);
    CHECK(run_program(folder, {"report", scene, "-o", folder.path("q"), "--surfaces",
                               folder.write("bad.csv", bad)})
              .status == 1);
  }
}

}  // namespace test_lists
