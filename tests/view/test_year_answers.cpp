// The server's answers on a year of daylight, against the arrays in its folder.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <cstring>

#include "../annual/stored_folder.h"
#include "base/error.h"
#include "support/scenes.h"
#include "view/json_values.h"
#include "view/year_answers.h"

using namespace troffer;
using namespace troffer::test;

namespace {

constexpr Boxd around{{-1, -1, 0}, {5, 2, 3}};

YearAnswers answers_of(const StoredFolder& folder, const Boxd& box = around,
                       const std::string& file = "other/two.gltf") {
  return {std::make_shared<StoredHours>(read_stored_year(folder.path())), box, file};
}

template <class T>
std::vector<T> numbers_in(const HttpResponse& r) {
  REQUIRE(r.body.size() % sizeof(T) == 0);
  std::vector<T> numbers(r.body.size() / sizeof(T));
  std::memcpy(numbers.data(), r.body.data(), r.body.size());
  return numbers;
}

HttpRequest year_request(const std::string& path,
                         const std::map<std::string, std::string>& query = {}) {
  return {false, path, query, ""};
}

}  // namespace

TEST_CASE("the year's description has hours, grids and groups with their schedule") {
  const StoredFolder folder;
  YearAnswers answers = answers_of(folder);
  const auto j = nlohmann::json::parse(answers.answer(year_request("year")).body);
  CHECK(j["sensors"] == 5);
  CHECK(j["hours"].size() == 16);
  CHECK(j["hours"][1] == 9.5);
  CHECK(j["groups"][0]["states"][1] == "down");
  CHECK(j["groups"][0]["schedule"][1] == 1);
  CHECK(j["grids"][1]["name"] == "hall");
  CHECK(j["notes"].empty());
  const auto places = numbers_in<double>(answers.answer(year_request("year/points")));
  REQUIRE(places.size() == 30);
  CHECK(places[24] == 4);
  CHECK(places[29] == 1);
}

TEST_CASE("eyes come with their glare in all hours") {
  const StoredFolder folder;
  const auto described = [&] {
    return nlohmann::json::parse(answers_of(folder).answer(year_request("year")).body);
  };
  CHECK(described()["eyes"].empty());
  CHECK(answers_of(folder).answer(year_request("year/glare")).body.empty());
  folder.write("annual.json", R"({"scene": "rooms/two.gltf", "weather": {"place": "Nowhere"},
    "window_groups": [{"name": "South", "states": [{"name": "up"}, {"name": "down"}]}],
    "eyes": [{"x": 1, "y": 0.5, "z": 1.2, "direction": [0, -1, 0]}]})");
  std::string table = "hour_of_year,vertical_lx_1,dgp_1\n";
  for (int h = 0; h < 48; ++h)
    if (h % 24 >= 8 && h % 24 < 16) table += fmt::format("{},{},{}\n", h + 0.5, 10 * h, 0.01 * h);
  folder.write("glare.csv", table);
  const auto j = described();
  REQUIRE(j["eyes"].size() == 1);
  CHECK(j["eyes"][0]["position"][1] == 0.5);
  CHECK(j["eyes"][0]["direction"][1] == -1);
  YearAnswers answers = answers_of(folder);
  const auto glare = numbers_in<float>(answers.answer(year_request("year/glare")));
  REQUIRE(glare.size() == 2 * StoredFolder::hours);
  CHECK(glare[1] == doctest::Approx(0.09));
  CHECK(glare[StoredFolder::hours + 15] == 390);
}

TEST_CASE("answers on hours and sensors equal the arrays") {
  const StoredFolder folder;
  YearAnswers answers = answers_of(folder);
  const auto ask = [&](const std::string& path, const std::string& number, const std::string& part,
                       const std::string& states) {
    return numbers_in<float>(answers.answer(
        year_request(path, {{"number", number}, {"part", part}, {"states", states}})));
  };
  for (size_t h = 0; h < StoredFolder::hours; ++h) {
    const std::vector<float> lx = ask("year/hour", std::to_string(h), "total", "-1");
    REQUIRE(lx.size() == StoredFolder::sensors);
    for (size_t s = 0; s < lx.size(); ++s)
      CHECK(lx[s] == StoredFolder::beside(s, h) + StoredFolder::south(s, h, h % 2));
  }
  CHECK(ask("year/hour", "4", "direct", "1")[0] ==
        StoredFolder::beside(0, 4) / 16 + StoredFolder::south(0, 4, 1) / 16);
  // Errors follow the hours by schedule; they are unknown for other states.
  const std::vector<float> sensor = ask("year/sensor", "2", "total", "-1");
  REQUIRE(sensor.size() == 2 * StoredFolder::hours);
  CHECK(sensor[5] == StoredFolder::beside(2, 5) + StoredFolder::south(2, 5, 1));
  CHECK(sensor[16 + 5] == StoredFolder::error(2, 5));
  CHECK(ask("year/sensor", "2", "total", "0").size() == StoredFolder::hours);
  CHECK(ask("year/sensor", "2", "direct", "-1").size() == StoredFolder::hours);
  for (const char* number : {"", "x", "-1", "16", "1.5", "99999999999999999999999"})
    CHECK_THROWS_AS(ask("year/hour", number, "total", "-1"), UsageError);
  for (const char* states : {"", "-2", "2", "0,0", "0,", "a", "0;1"})
    CHECK_THROWS_AS(ask("year/hour", "0", "total", states), UsageError);
  CHECK_THROWS_AS(ask("year/hour", "0", "all", "-1"), UsageError);
  CHECK_THROWS_AS(ask("year/week", "0", "total", "-1"), UsageError);
}

TEST_CASE("a year of another scene is noted") {
  const StoredFolder folder;
  CHECK(answers_of(folder).notes().empty());
  const YearAnswers named = answers_of(folder, around, "three.gltf");
  REQUIRE(named.notes().size() == 1);
  CHECK(named.notes()[0].find("three.gltf") != std::string::npos);
  const YearAnswers smaller = answers_of(folder, {{-1, -1, 0}, {2.5, 2, 3}});
  REQUIRE(smaller.notes().size() == 1);
  CHECK(smaller.notes()[0].starts_with("2 of the 5 sensors"));
  const YearAnswers elsewhere = answers_of(folder, {{10, 10, 0}, {12, 12, 3}});
  CHECK(elsewhere.notes()[0].starts_with("all of the 5 sensors"));
}

TEST_CASE("surfaces hide points; points behind the camera are not seen") {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  add_quad(s, grey, {Vec3{-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}});
  add_quad(s, grey, {Vec3{-9, 4, -9}, {9, 4, -9}, {9, 4, 9}, {-9, 4, 9}});
  const PreparedScene scene(std::move(s));
  const std::vector<MeasuringPoint> points{{{0, 0.5, 0}, {0, -1, 0}}, {{0, 2, 0}, {0, -1, 0}},
                                           {{3, 2, 0}, {0, -1, 0}},   {{0, -1, 0}, {0, 1, 0}},
                                           {{5, 4, 0}, {0, -1, 0}},   {{6, 5, 0}, {0, 1, 0}}};
  const Camera camera = look_at({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 60);
  const std::vector<uint8_t> expected{1, 0, 1, 0, 1, 0};
  const std::vector<uint8_t> seen = points_in_sight(scene, camera, points);
  for (size_t i = 0; i < expected.size(); ++i) CHECK(int(seen[i]) == int(expected[i]));
  Camera cut = camera;  // shows what is behind the first wall
  cut.near_clip = 1.5f;
  CHECK(points_in_sight(scene, cut, points)[1] == 1);
  Camera parallel = camera;
  parallel.kind = CameraKind::orthographic;
  CHECK(points_in_sight(scene, parallel, {{{0.9, 2, 0}, {0, -1, 0}}, {{1.1, 2, 0}, {0, -1, 0}}}) ==
        std::vector<uint8_t>{0, 1});
}
