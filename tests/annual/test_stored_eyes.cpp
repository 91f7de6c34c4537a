// Eyes of a stored year with their glare: read as written, and damages named.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include "annual/stored_eyes.h"
#include "annual/stored_year.h"
#include "base/error.h"
#include "stored_folder.h"

using namespace troffer;
using namespace troffer::test;

namespace stored_eyes {

const std::string two_eyes = R"({"scene": "s", "weather": {}, "window_groups": [], "eyes": [
  {"x": 1, "y": 2, "z": 1.2, "direction": [0, -1, 0]},
  {"x": 3, "y": 2, "z": 1.6, "direction": [0.6, 0.8, 0]}]})";

double hour_at(size_t h) {
  return double(h / 8 * 24 + 8 + h % 8) + 0.5;
}

std::string glare_table(size_t hours = StoredFolder::hours) {
  std::string text = "hour_of_year,vertical_lx_1,dgp_1,vertical_lx_2,dgp_2\n";
  for (size_t h = 0; h < hours; ++h)
    text += fmt::format("{},{},{},{},{}\n", hour_at(h), 100 * h, 0.25 + 0.01 * double(h), 7, 0.5);
  return text;
}

std::vector<StoredEye> eyes_of(const std::string& json, const std::string& table) {
  const StoredFolder folder;
  std::vector<double> hours;
  for (size_t h = 0; h < StoredFolder::hours; ++h) hours.push_back(hour_at(h));
  folder.write("annual.json", json);
  if (!table.empty()) folder.write("glare.csv", table);
  return read_stored_eyes(folder.path(), hours);
}

std::string failure_of(const std::string& json, const std::string& table) {
  try {
    (void)eyes_of(json, table);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST_CASE("eyes have their places and the glare of every hour") {
  CHECK(eyes_of(R"({"scene": "s"})", "").empty());
  CHECK(eyes_of(R"({"scene": "s", "eyes": []})", "").empty());
  const std::vector<StoredEye> eyes = eyes_of(two_eyes, glare_table());
  REQUIRE(eyes.size() == 2);
  CHECK(eyes[0].eye.position.y == 2);
  CHECK(eyes[1].eye.normal.x == doctest::Approx(0.6));
  REQUIRE(eyes[0].dgp.size() == StoredFolder::hours);
  CHECK(eyes[0].dgp[3] == doctest::Approx(0.28));
  CHECK(eyes[0].vertical_lx[15] == 1500);
  CHECK(eyes[1].vertical_lx[15] == 7);
}

TEST_CASE("eyes and table that do not fit are errors with a place") {
  const auto with = [](const std::string& from, const std::string& to) {
    std::string json = two_eyes;
    return json.replace(json.find(from), from.size(), to);
  };
  CHECK(!failure_of(two_eyes, "").empty());  // no table
  CHECK(failure_of(two_eyes, glare_table(15)).find("has 15 hours") != std::string::npos);
  CHECK(failure_of(two_eyes, glare_table(17)).find("next hour") != std::string::npos);
  CHECK(failure_of(two_eyes, "hour_of_year,vertical_lx_1,dgp_1\n").find("header") !=
        std::string::npos);
  CHECK(failure_of(two_eyes, glare_table() + "1,nan,0,0,0\n") != "");
  CHECK(failure_of(with("[0, -1, 0]", "[0, 0, 0]"), glare_table()).find("unit vector") !=
        std::string::npos);
  CHECK(failure_of(with("[0, -1, 0]", "[0, 1]"), glare_table()) != "");
  CHECK(failure_of(with("\"x\": 1", "\"x\": 1e300"), glare_table()).find("too far") !=
        std::string::npos);
  CHECK(failure_of(R"({"eyes": 3})", glare_table()) != "");
}

}  // namespace stored_eyes
