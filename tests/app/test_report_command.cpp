// `troffer report` as users run it: files, reproducibility, hostile names and files, signals.
#include <doctest/doctest.h>
#include <signal.h>

#include <cmath>
#include <sstream>

#include "base/random.h"
#include "program.h"

using namespace troffer;
using namespace troffer::test;

namespace test_report_command {

namespace {

// A closed room of 4 × 3 × 2.5 m with a table top of 1.4 × .8 m and a panel of 1 m².
const char* const room_pbrt = R"(LookAt 0.3 0.3 1.5  2 2 0.8  0 0 1
Camera "perspective" "float fov" 70
WorldBegin
Material "diffuse" "rgb reflectance" [0.5 0.5 0.5]
Shape "trianglemesh" "point3 P" [0 0 0 4 0 0 4 3 0 0 3 0 0 0 2.5 4 0 2.5 4 3 2.5 0 3 2.5]
  "integer indices" [0 1 2 0 2 3 4 6 5 4 7 6 0 4 5 0 5 1 1 5 6 1 6 2 2 6 7 2 7 3 3 7 4 3 4 0]
Shape "trianglemesh" "point3 P" [1 1 0.75 2.4 1 0.75 2.4 1.8 0.75 1 1.8 0.75]
  "integer indices" [0 1 2 0 2 3]
AttributeBegin
AreaLightSource "diffuse" "rgb L" [20 20 20]
Shape "trianglemesh" "point3 P" [1.5 1 2.45 1.5 2 2.45 2.5 2 2.45 2.5 1 2.45]
  "integer indices" [0 1 2 0 2 3]
AttributeEnd
)";

std::vector<std::string> command(const Folder& folder, const std::string& scene,
                                 const std::string& out, const std::vector<std::string>& more,
                                 int spp = 64) {
  std::vector<std::string> c{"report",
                             scene,
                             "-o",
                             folder.path(out),
                             "--spp",
                             std::to_string(spp),
                             "--width",
                             "48",
                             "--picture-error",
                             "0.2",
                             "--quiet"};
  c.insert(c.end(), more.begin(), more.end());
  return c;
}

size_t count(const std::string& text, const std::string& what) {
  size_t n = 0;
  for (size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

}  // namespace

TEST_CASE("a report is one self-contained page, JSON and a table, identical in repeated runs") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", room_pbrt);
  const std::vector<std::string> more{"--power", "emitter0=36", "--title", "<b>Büro</b> & \"co\""};
  auto one = command(folder, scene, "r", more), two = one;
  one.insert(one.end(), {"--threads", "1"});
  two.insert(two.end(), {"--threads", "2"});
  REQUIRE(run_program(folder, one).status == 0);
  const std::string page = read_file(folder.path("r/report.html"));
  const std::string json = read_file(folder.path("r/report.json"));
  const std::string points = read_file(folder.path("r/points.csv"));
  CHECK(page.find("<h1>&lt;b&gt;Büro&lt;/b&gt; &amp; &quot;co&quot;</h1>") != std::string::npos);
  CHECK(page.find("<b>B") == std::string::npos);
  for (const char* far : {"src=\"http", "href=", "url(", "@import", "<script", "<link", "<iframe"})
    CHECK(page.find(far) == std::string::npos);
  CHECK(page.find("class=\"pass\"") != std::string::npos);
  // A plan, a scale, two grids, a polar curve and the legend of the luminances.
  CHECK(count(page, "<svg ") == 6);
  CHECK(count(page, "polar curve, diffuse surface") == 1);
  CHECK(read_file(folder.path("r/plan.svg")).starts_with("<svg "));
  // The summary has a row for each surface, and one for cylindrical illuminance.
  const size_t matrix = page.find("<table class=\"wide dense matrix\">");
  REQUIRE(matrix != std::string::npos);
  const std::string rows = page.substr(matrix, page.find("</table>", matrix) - matrix);
  CHECK(count(rows, "<tr>") == 4);
  // Terms of statistics appear only in the appendix.
  const std::string body = page.substr(0, page.find("<h2>Appendix</h2>"));
  CHECK(body.find("standard error") == std::string::npos);
  CHECK(body.find("ias of the") == std::string::npos);
  CHECK(page.find("Bias of the minimum") != std::string::npos);
  CHECK(count(page, "<section") == count(page, "</section>"));
  CHECK(count(page, "<tr") == count(page, "</tr>"));
  CHECK(json.find("\"format\": \"troffer report 1\"") != std::string::npos);
  CHECK(json.find("\"watts\": 36.0") != std::string::npos);
  CHECK(json.find("\"samples_per_point\": 64") != std::string::npos);
  CHECK(json.find("\"product\": \"diffuse surface\"") != std::string::npos);
  CHECK(json.find("\"floor_area_m2\": 12") != std::string::npos);
  CHECK(json.find("\"name\": \"desk\"") != std::string::npos);
  CHECK(points.starts_with("surface,column,row,x,y,z,"));
  CHECK(count(points, "\"desk\",") > 20);
  REQUIRE(run_program(folder, two).status == 0);
  CHECK(read_file(folder.path("r/report.html")) == page);
  CHECK(read_file(folder.path("r/report.json")) == json);
  CHECK(read_file(folder.path("r/points.csv")) == points);
}

TEST_CASE("a report lists all input files, the scene first") {
  const Folder folder;
  folder.write("a part.pbrt", room_pbrt);
  folder.write("unread.pbrt", room_pbrt);
  const std::string scene = folder.write("room.pbrt", "Include \"a part.pbrt\"\n");
  const std::string list = folder.write("list.csv", "file,x,y,z\n");
  REQUIRE(run_program(folder, command(folder, scene, "r",
                                      {"--luminaires", list, "--pictures", "off", "--contributions",
                                       "off"}))
              .status == 0);
  const std::string json = read_file(folder.path("r/report.json"));
  const auto at = [&](const std::string& name) { return json.find("/" + name + "\""); };
  const size_t inputs = json.find("\"inputs\""), first = json.find("/room.pbrt\"", inputs);
  CHECK(first != std::string::npos);
  CHECK(json.find("/a part.pbrt\"", first) != std::string::npos);
  CHECK(json.find("/list.csv\"", first) != std::string::npos);
  CHECK(at("unread.pbrt") == std::string::npos);
  CHECK(count(json, "\"sha256\"") == 3);
}

TEST_CASE("points of the report's table agree with measure") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", room_pbrt);
  REQUIRE(run_program(
              folder,
              command(folder, scene, "r",
                      {"--maintenance", "1", "--pictures", "off", "--contributions", "off"}, 1024))
              .status == 0);
  std::istringstream table(read_file(folder.path("r/points.csv")));
  std::string csv = "x,y,z,nx,ny,nz\n", line;
  std::vector<Measured> told;
  std::getline(table, line);
  while (std::getline(table, line)) {
    std::vector<std::string> f;
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) f.push_back(field);
    if (f.at(0) != "\"desk\"") continue;
    csv += f.at(3) + "," + f.at(4) + "," + f.at(5) + "," + f.at(6) + "," + f.at(7) + "," + f.at(8) +
           "\n";
    told.push_back({std::stod(f.at(9)), std::stod(f.at(10))});
  }
  const std::string list = folder.write("p.csv", csv);
  const auto by_paths = measured(
      run_program(folder, {"measure", scene, "--points", list, "--method", "path", "--quiet"}));
  REQUIRE(by_paths.size() == told.size());
  REQUIRE(told.size() > 20);
  for (size_t i = 0; i < told.size(); ++i)
    CHECK(std::abs(told[i].lx - by_paths[i].lx) <
          5 * std::hypot(told[i].error, by_paths[i].error) + 0.005 * told[i].lx);
}

TEST_CASE(
    "daylight factors are computed automatically where there is an opening, and not in a closed "
    "room") {
  const Folder folder;
  const std::string scene =
      std::string(TROFFER_SOURCE_DIR) + "/scenes/daylight-room/daylight-room.gltf";
  const std::vector<std::string> quick{"--pictures", "off", "--sky", "overcast,5000"};
  REQUIRE(run_program(folder, command(folder, scene, "r", quick)).status == 0);
  const std::string json = read_file(folder.path("r/report.json"));
  CHECK(json.find("\"daylight_factor_percent\": {") != std::string::npos);
  CHECK(json.find("\"electric_lx\": null") != std::string::npos);
  // Half the sky's light: 50 lx per percent.
  const auto mean_after = [&](const std::string& key) {
    const size_t at = json.find("\"value\"", json.find("\"" + key + "\""));
    return std::stod(json.substr(at + 9));
  };
  CHECK(mean_after("daylight_lx") ==
        doctest::Approx(50 * mean_after("daylight_factor_percent")).epsilon(0.05));
  const std::string closed = folder.write("room.pbrt", room_pbrt);
  REQUIRE(run_program(folder, command(folder, closed, "c", {"--pictures", "off"})).status == 0);
  CHECK(read_file(folder.path("c/report.json")).find("\"daylight_factor_percent\": null") !=
        std::string::npos);
}

TEST_CASE(
    "surfaces, observers and profiles from a file; names cannot inject markup into the page") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", room_pbrt);
  const std::string file = folder.write("what.json", R"({
    "profiles": [{"id": "mine", "name": "</td><script>alert(1)</script>", "illuminance_lx": 1}],
    "surfaces": [{"name": "=cmd|' /C calc'!A0\"><img src=x onerror=alert(1)>", "profile": "mine",
                  "corner": [0.5, 0.5, 0.8], "sides": [[1, 0, 0], [0, 1, 0]]}],
    "observers": [{"eye": [0.5, 1.5, 1.2], "direction": [1, 0, 0]}]})");
  REQUIRE(
      run_program(folder, command(folder, scene, "r", {"--surfaces", file, "--pictures", "off"}))
          .status == 0);
  const std::string page = read_file(folder.path("r/report.html"));
  CHECK(page.find("<script") == std::string::npos);
  CHECK(page.find("<img") == std::string::npos);
  CHECK(page.find("&lt;script&gt;") != std::string::npos);
  const std::string points = read_file(folder.path("r/points.csv"));
  CHECK(points.find("\n\"'=cmd") != std::string::npos);
  CHECK(points.find("\n\"=cmd") == std::string::npos);
}

TEST_CASE("impossible requests are reported in one line and leave no folder") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", room_pbrt);
  struct Row {
    std::vector<std::string> options;
    int status;
  };
  const std::string bad = folder.write("bad.json", "{\"surfaces\": [{\"corner\": [0, 0]}]}");
  for (const Row& r : {Row{{"--surface", "nobody"}, 2}, Row{{"--profile", "nobody"}, 2},
                       Row{{"--power", "emitter0=x"}, 2}, Row{{"--power", "nobody=5"}, 2},
                       Row{{"--observer", "1,2,3"}, 2}, Row{{"--maintenance", "nan"}, 2},
                       Row{{"--camera", "nobody"}, 2}, Row{{"--surfaces", bad}, 1},
                       Row{{"--surfaces", folder.path("none.json")}, 1}}) {
    const Finished f = run_program(folder, command(folder, scene, "r", r.options));
    CAPTURE(r.options.at(1));
    CHECK(f.status == r.status);
    CHECK(f.error_lines().size() == 1);
    CHECK(f.err.starts_with("error: "));
    CHECK(folder.names() == std::vector<std::string>{"bad.json", "room.pbrt"});
  }
}

TEST_CASE("a comparison shows another report beside this one, and refuses other files") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", room_pbrt);
  const std::vector<std::string> quick{"--pictures", "off", "--power", "emitter0=36"};
  auto first = command(folder, scene, "a", quick), second = command(folder, scene, "b", quick);
  first.insert(first.end(), {"--title", "<i>dim</i>", "--maintenance", "0.4"});
  second.insert(second.end(), {"--compare", folder.path("a/report.json")});
  REQUIRE(run_program(folder, first).status == 0);
  REQUIRE(run_program(folder, second).status == 0);
  const std::string page = read_file(folder.path("b/report.html"));
  const size_t at = page.find("<h2>Comparison</h2>");
  REQUIRE(at != std::string::npos);
  const std::string part = page.substr(at, page.find("<h2>", at + 4) - at);
  CHECK(part.find("&lt;i&gt;dim&lt;/i&gt;") != std::string::npos);
  CHECK(page.find("<i>") == std::string::npos);
  CHECK(count(part, "<img ") == 2);  // both plans
  CHECK(count(part, "<b>") >= 2);    // twice the light is a clear difference
  CHECK(part.find("<td>Power, W</td>") != std::string::npos);
  CHECK(read_file(folder.path("a/report.html")).find("<h2>Comparison") == std::string::npos);
  // A report compared with itself shows no differences.
  auto same = command(folder, scene, "c", quick);
  same.insert(same.end(), {"--compare", folder.path("b/report.json")});
  REQUIRE(run_program(folder, same).status == 0);
  const std::string equal = read_file(folder.path("c/report.html"));
  const size_t from = equal.find("<h2>Comparison</h2>");
  CHECK(equal.substr(from, equal.find("<h2>", from + 4) - from).find("<b>") == std::string::npos);
  for (const char* text :
       {"{}", "[]", "{\"format\": \"troffer report 1\"}", "{\"format\": 1}", "x"}) {
    auto bad = command(folder, scene, "d", quick);
    bad.insert(bad.end(), {"--compare", folder.write("bad.json", text)});
    const Finished f = run_program(folder, bad);
    CAPTURE(text);
    CHECK(f.status == 1);
    CHECK(f.error_lines().size() == 1);
    CHECK(f.err.starts_with("error: "));
  }
}

TEST_CASE("damaged files of surfaces are read or refused with the place of the error") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", room_pbrt);
  const std::string whole =
      R"({"profiles":[{"id":"a","ugr":19}],"surfaces":[{"name":"s","profile":)"
      R"("a","corner":[1,1,0.8],"sides":[[1,0,0],[0,1,0]]}],"observers":[)"
      R"({"eye":[1,1,1.2],"direction":[1,0,0]}]})";
  Random random(5);
  int read = 0, refused = 0;
  for (int i = 0; i < 18; ++i) {
    std::string text = whole;
    for (int k = 0; k < i % 3; ++k)
      text[random.next_u32() % text.size()] = "{}[],:\"019e-\\x"[random.next_u32() % 14];
    const std::string file = folder.write("m.json", text);
    const Finished f =
        run_program(folder, command(folder, scene, "r",
                                    {"--surfaces", file, "--pictures", "off", "--contributions",
                                     "off", "--cylindrical", "off", "--method", "path"},
                                    2));
    CAPTURE(text);
    CHECK((f.status == 0 || f.status == 1 || f.status == 2));
    if (f.status != 0) CHECK(f.err.starts_with("error: "));
    (f.status == 0 ? read : refused) += 1;
  }
  CHECK(refused > 5);
  CHECK(read >= 6);  // the unmodified files
}

TEST_CASE("a signal ends report with nothing written") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", room_pbrt);
  Running program(folder,
                  {"report", scene, "-o", folder.path("r"), "--spp", "50000000", "--quiet"});
  program.let_work(0.5);
  program.send(SIGINT);
  const Finished f = program.wait();
  CHECK(f.status == 130);
  CHECK(f.seconds_after_signal < 5);
  CHECK(f.err.find("nothing was written") != std::string::npos);
  for (const std::string& name : folder.names()) CHECK(name != "r");
}

}  // namespace test_report_command
