// `troffer annual` as users run it: files, window groups of a Honeybee model, eyes, sunlight,
// electric light, interruption, and messages for mistakes.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <nlohmann/json.hpp>

#include "program.h"
#include "support/hbjson_room.h"

using namespace troffer;
using namespace troffer::test;

namespace {

using AnnualJson = nlohmann::json;

// Two days with sun.
std::string wea() {
  std::string text =
      "place Test\nlatitude 48\nlongitude 0\ntime_zone 0\nsite_elevation 0\n"
      "weather_data_file_units 1\n";
  for (const int month : {3, 6})
    for (int h = 0; h < 24; ++h)
      text += fmt::format("{} 21 {}.500 {} {}\n", month, h, h > 6 && h < 18 ? 500 : 0,
                          h > 5 && h < 19 ? 150 : 0);
  return text;
}

// A Honeybee room whose south window has a tint and a shade in its second state.
HbjsonRoom room_with_blinds() {
  HbjsonRoom room;
  room.modifiers =
      R"({"type":"Glass","identifier":"tint","r_transmissivity":0.1,"g_transmissivity":0.1,"b_transmissivity":0.1},)";
  room.window =
      R"("dynamic_group_identifier":"South","states":[{"type":"RadianceSubFaceStateAbridged"},{"modifier":"tint"}])";
  return room;
}

struct AnnualRun {
  Folder folder;
  std::string scene, weather = folder.write("two.wea", wea());

  explicit AnnualRun(const HbjsonRoom& room) : scene(folder.write("room.hbjson", room.text())) {}

  std::vector<std::string> words(const std::vector<std::string>& more,
                                 const std::string& rays = "128") const {
    std::vector<std::string> w{
        "annual",        scene, "--weather",     weather, "-o", folder.path("year"),
        "--gather-rays", rays,  "--subdivision", "1"};
    w.insert(w.end(), more.begin(), more.end());
    return w;
  }
  Finished run(const std::vector<std::string>& more) const {
    return run_program(folder, words(more));
  }
  bool has(const std::string& file) const {
    return std::filesystem::exists(folder.path("year/" + file));
  }
};

bool says(const Finished& f, const std::string& text) {
  CAPTURE(f.err);
  return f.err.find(text) != std::string::npos;
}

}  // namespace

TEST_CASE("annual writes page, tables and arrays per window group and state") {
  const AnnualRun test(room_with_blinds());
  const Finished f = test.run({});
  CAPTURE(f.err);
  REQUIRE(f.status == 0);
  for (const char* file :
       {"annual.html", "annual.json", "metrics.csv", "honeybee/grids_info.json",
        "honeybee/dynamic_schedule.json", "honeybee/South/0_South/total/desk.npy",
        "honeybee/South/1_South/direct/desk.npy"})
    CHECK_MESSAGE(test.has(file), file);
  CHECK(!test.has("honeybee/__static_apertures__"));  // the only window is in the group
  CHECK(!test.has("glare.csv"));
  const AnnualJson json = AnnualJson::parse(read_file(test.folder.path("year/annual.json")));
  REQUIRE(json["window_groups"].size() == 1);
  CHECK(json["window_groups"][0]["states"][1]["name"] == "tint");
  CHECK(json["settings"]["blinds"] == "lm-83");
  CHECK(json["grids"][0]["figures"].contains("sda_open"));
  CHECK(read_file(test.folder.path("year/annual.html")).find("<script") == std::string::npos);
}

TEST_CASE("--state fixes a group, and --blinds open leaves all in state 0") {
  const AnnualRun test(room_with_blinds());
  REQUIRE(test.run({"--state", "South=1"}).status == 0);
  CHECK(test.has("honeybee/South/0_South/total/desk.npy"));
  CHECK(!test.has("honeybee/South/1_South/total/desk.npy"));
  REQUIRE(test.run({"--blinds", "open"}).status == 0);
  const AnnualJson json = AnnualJson::parse(read_file(test.folder.path("year/annual.json")));
  const AnnualJson& states = json["window_groups"][0]["states"];
  CHECK(states[1]["occupied_hours_with_daylight"] == 0);
  CHECK(states[0]["occupied_hours_with_daylight"] > 10);
}

TEST_CASE("eyes, sunlight and electric light are assessed on request") {
  HbjsonRoom room;
  room.modifiers =
      R"({"type":"Light","identifier":"lamp","r_emittance":50,"g_emittance":50,"b_emittance":50},)";
  room.model =
      R"("shade_meshes":[{"type":"ShadeMesh","identifier":"panel","is_detached":false,"geometry":{
         "vertices":[[1,1,2.4],[1,2,2.4],[2,2,2.4],[2,1,2.4]],"faces":[[0,1,2,3]]},
         "properties":{"radiance":{"modifier":"lamp"}}}],)";
  const AnnualRun test(room);
  const std::string eyes = test.folder.write("eyes.csv", "x,y,z,nx,ny,nz\n2,2,1.2,0,-1,0\n");
  // The window has its middle at (2, 0, 1.5); the point lies within the room.
  const std::string sun = test.folder.write("sun.csv", "x,y,z,nx,ny,nz\n2,0.01,1.5,0,1,0\n");
  const Finished f =
      test.run({"--eyes", eyes, "--sunlight", sun, "--electric", "*", "--electric-target", "300"});
  CAPTURE(f.err);
  REQUIRE(f.status == 0);
  const AnnualJson json = AnnualJson::parse(read_file(test.folder.path("year/annual.json")));
  REQUIRE(json["eyes"].size() == 1);
  const std::string glare = read_file(test.folder.path("year/glare.csv"));
  CHECK(glare.find("hour_of_year,vertical_lx_1,dgp_1") == 0);
  // On 21 March the sun moves from east to west in twelve hours, and reaches a point in a thin
  // window to the south in nearly all of them.
  CHECK(double(json["sunlight"][0]["hours"]) > 11);
  CHECK(double(json["sunlight"][0]["hours"]) < 12.3);
  CHECK(json["sunlight"][0]["level"] == "high");
  REQUIRE(json["electric"].size() == 1);
  const double full = json["electric"][0]["full_load_hours"];
  CHECK(full >= 0);
  CHECK(full < double(json["electric"][0]["occupied_hours"]));
  const double mean_lx = json["electric"][0]["mean_lx"];
  CHECK(mean_lx > 100);
  const std::string short_of = "the target is not reached, even at full output, by " +
                               json["electric"][0]["group"].get<std::string>();
  const auto says_short = [&] {
    return read_file(test.folder.path("year/annual.html")).find(short_of) != std::string::npos;
  };
  CHECK(says_short() == (mean_lx < 300));
  CHECK(test.has("electric.csv"));
  REQUIRE(test.run({"--electric", "*", "--electric-target", "100000"}).status == 0);
  CHECK(says_short());
}

TEST_CASE("--ill writes text beside the arrays") {
  const AnnualRun test(room_with_blinds());
  REQUIRE(test.run({"--ill"}).status == 0);
  for (const char* file : {"0_South/total/desk.ill", "1_South/direct/desk.ill"})
    CHECK_MESSAGE(test.has(std::string("honeybee/South/") + file), file);
  const std::string text =
      read_file(test.folder.path("year/honeybee/South/0_South/total/desk.ill"));
  const std::string hours = read_file(test.folder.path("year/honeybee/sun-up-hours.txt"));
  const auto sensors = std::count(text.begin(), text.end(), '\n');
  CHECK(sensors == 2);
  CHECK(std::count(text.begin(), text.end(), '\t') ==
        sensors * (std::count(hours.begin(), hours.end(), '\n') - 1));
}

// Everything but the command line, which annual.json and the page repeat.
bool same_results(const AnnualRun& a, const AnnualRun& b) {
  for (const char* file : {"metrics.csv", "honeybee/South/0_South/total/desk.npy",
                           "honeybee/South/1_South/direct/desk.npy",
                           "honeybee/standard_error/desk.npy", "honeybee/dynamic_schedule.json"})
    if (read_file(a.folder.path(std::string("year/") + file)) !=
        read_file(b.folder.path(std::string("year/") + file)))
      return false;
  return true;
}

TEST_CASE("an interrupted year goes on from its checkpoint with the same bytes") {
  const AnnualRun whole(room_with_blinds()), test(room_with_blinds());
  REQUIRE(whole.run({}).status == 0);
  const std::string file = test.folder.path("year.ck");
  // An early stop may come before anything is finished; a later run then starts from the beginning.
  for (int i = 0; i < 3; ++i) {
    Running running(test.folder, test.words({"--checkpoint", file, "--resume",
                                             "--checkpoint-interval", "0.001"}));
    running.let_work(0.2 + 0.3 * i);
    running.send(SIGINT);
    const Finished f = running.wait();
    CAPTURE(f.err);
    CHECK((f.status == 130 || f.status == 0));
    if (f.status != 130) break;
    CHECK(says(f, "--resume continues"));
    CHECK(!std::filesystem::exists(test.folder.path("year")));
    CHECK(std::filesystem::exists(file));
  }
  REQUIRE(test.run({"--checkpoint", file, "--resume"}).status == 0);
  CHECK(!std::filesystem::exists(file));
  CHECK(same_results(whole, test));
}

TEST_CASE("parts of a year join to the same bytes") {
  const AnnualRun whole(room_with_blinds()), test(room_with_blinds());
  REQUIRE(whole.run({}).status == 0);
  std::vector<std::string> join;
  uintmax_t bytes = 0;
  for (const char* k : {"1", "2", "3"}) {
    const std::string file = test.folder.path(std::string("part") + k);
    const Finished f = test.run({"--part", std::string(k) + "/3", "--checkpoint", file});
    CAPTURE(f.err);
    REQUIRE(f.status == 0);
    CHECK(!std::filesystem::exists(test.folder.path("year")));
    bytes += std::filesystem::file_size(file);
    join.insert(join.end(), {"--join", file});
  }
  // With all parts there is nothing left to keep; a checkpoint of the whole holds what they hold.
  REQUIRE(test.run(join).status == 0);
  CHECK(same_results(whole, test));
  const AnnualRun other(room_with_blinds());
  const std::string all = other.folder.path("all");
  REQUIRE(other.run({"--part", "1/1", "--checkpoint", all}).status == 0);
  constexpr uintmax_t around = 72 + 16;  // header and end of each further file
  CHECK(bytes == std::filesystem::file_size(all) + 2 * around);
  CHECK(says(test.run({"--seed", "9", "--join", test.folder.path("part1")}), "other options"));
  CHECK(says(test.run({"--join", test.weather}), "not a checkpoint"));
  CHECK(test.run({"--part", "4/3", "--checkpoint", all}).status == 2);
  CHECK(test.run({"--part", "1/3"}).status == 2);
  CHECK(test.run({"--resume"}).status == 2);
}

TEST_CASE("an interrupted year leaves no folder") {
  const AnnualRun test(room_with_blinds());
  Running running(test.folder, test.words({}, "200000"));
  running.let_work(1);
  running.send(SIGINT);
  const Finished f = running.wait();
  CHECK(f.status == 130);
  CHECK(!std::filesystem::exists(test.folder.path("year")));
}

TEST_CASE("annual says what to write instead of a mistake") {
  const AnnualRun test(room_with_blinds());
  const auto fails = [&](const std::vector<std::string>& more, int status,
                         const std::string& text) {
    const Finished f = test.run(more);
    CHECK(f.status == status);
    CHECK(says(f, text));
    CHECK(!std::filesystem::exists(test.folder.path("year")));
  };
  fails({"--blinds", test.folder.write("s.csv", "North\n0\n")}, 1, "no window group 'north'");
  fails({"--blinds", test.folder.write("t.csv", "South\n0\n1\n")}, 1, "48 time steps");
  fails({"--blinds", test.folder.write("u.csv", "South\n2\n")}, 1, "a state from 0 to 1");
  fails({"--sunlight-day", "21.3."}, 2, "such as 03-21");
  fails({"--electric", "lamp"}, 2, "no light is named 'lamp'");
  fails({"--occupancy", "8-8"}, 2, "such as 8-18");
  const std::string groups =
      test.folder.write("g.json", R"({"groups":[{"name":"g","windows":["Ofice"]}]})");
  fails({"--groups", groups}, 2, "window groups of its own");
  const AnnualRun plain{HbjsonRoom()};
  const Finished f = plain.run({"--groups", groups});
  CHECK(f.status == 2);
  CHECK(says(f, "did you mean 'Office'"));
}
