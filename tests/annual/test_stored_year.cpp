// A year read back from its folder: every number as it was written, and an error for every folder
// that does not hold together.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <sstream>

#include "annual/stored_hours.h"
#include "base/error.h"
#include "stored_folder.h"

using namespace troffer;
using namespace troffer::test;

namespace {

std::string text_of_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

float expected_lx(size_t sensor, size_t hour, int state) {
  const size_t shown = state == by_schedule ? hour % 2 : size_t(state);
  return StoredFolder::beside(sensor, hour) + StoredFolder::south(sensor, hour, shown);
}

// Returns the message for a folder that `spoil` has changed; "" if it is read.
std::string message_after(const std::function<void(const StoredFolder&)>& spoil) {
  const StoredFolder folder;
  spoil(folder);
  try {
    (void)read_stored_year(folder.path());
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

void replace_in(const StoredFolder& folder, const std::string& name, const std::string& from,
                const std::string& to) {
  std::string text = text_of_file(folder.file(name));
  const size_t at = text.find(from);
  REQUIRE(at != text.npos);
  folder.write(name, text.replace(at, from.size(), to));
}

const std::string south_total = "honeybee/South/1_South/total/desk.npy";

}  // namespace

TEST_CASE("a stored year has the sensors, hours, groups and grids of its folder") {
  const StoredFolder folder;
  const StoredYear year = read_stored_year(folder.path());
  CHECK(year.scene == "rooms/two.gltf");
  CHECK(year.place == "Nowhere");
  CHECK(year.zone_hours == 1);
  CHECK(!year.has_leap_day);
  REQUIRE(year.hours.size() == StoredFolder::hours);
  CHECK(year.hours[0] == 8.5);
  CHECK(year.hours[15] == 39.5);
  REQUIRE(year.groups.size() == 1);
  CHECK(year.groups[0].states == std::vector<std::string>{"up", "down"});
  CHECK(year.groups[0].schedule[3] == 1);
  REQUIRE(year.grids.size() == 2);
  CHECK(year.grids[1].first == 3);
  CHECK(year.points[4].position.x == 4);
  CHECK(year.states.size() == 4);  // South does not light the hall
}

TEST_CASE("hours and sensors are sums over windows, in the states that are asked for") {
  const StoredFolder folder;
  StoredHours hours(read_stored_year(folder.path()));
  for (const int state : {by_schedule, 0, 1}) {
    for (size_t h = 0; h < StoredFolder::hours; ++h) {
      const std::vector<float> total = hours.all_sensors(h, StoredPart::total, {state});
      const std::vector<float> direct = hours.all_sensors(h, StoredPart::direct, {state});
      REQUIRE(total.size() == StoredFolder::sensors);
      for (size_t s = 0; s < total.size(); ++s) {
        CHECK(total[s] == expected_lx(s, h, state));
        CHECK(direct[s] == doctest::Approx(expected_lx(s, h, state) / 16));
      }
    }
    for (size_t s = 0; s < StoredFolder::sensors; ++s) {
      const std::vector<float> total = hours.all_hours(s, StoredPart::total, {state});
      REQUIRE(total.size() == StoredFolder::hours);
      for (size_t h = 0; h < total.size(); ++h) CHECK(total[h] == expected_lx(s, h, state));
    }
  }
  CHECK(hours.errors(4)[8] == StoredFolder::error(4, 8));
}

TEST_CASE("hours, sensors and states that do not exist are refused") {
  const StoredFolder folder;
  StoredHours hours(read_stored_year(folder.path()));
  const auto total = StoredPart::total;
  CHECK_THROWS_AS(hours.all_sensors(16, total, {0}), UsageError);
  CHECK_THROWS_AS(hours.all_sensors(0, total, {}), UsageError);
  CHECK_THROWS_AS(hours.all_sensors(0, total, {2}), UsageError);
  CHECK_THROWS_AS(hours.all_sensors(0, total, {-2}), UsageError);
  CHECK_THROWS_AS(hours.all_sensors(0, total, {0, 0}), UsageError);
  CHECK_THROWS_AS(hours.all_hours(5, total, {0}), UsageError);
  CHECK_THROWS_AS(hours.errors(5), UsageError);
}

TEST_CASE("broken folders have messages that name the file") {
  namespace fs = std::filesystem;
  const auto without = [](const std::string& name) {
    return message_after([&](const StoredFolder& f) { fs::remove(f.file(name)); });
  };
  for (const char* name :
       {"annual.json", "metrics.csv", "honeybee/sun-up-hours.txt", "honeybee/study_info.json",
        "honeybee/dynamic_schedule.json", "honeybee/grids_info.json"})
    CHECK(without(name).find(fs::path(name).filename()) != std::string::npos);
  CHECK(without(south_total).find(south_total) != std::string::npos);
  CHECK(without("honeybee/standard_error/desk.npy").empty());
  const auto with = [](const std::string& name, const std::string& from, const std::string& to) {
    return message_after([&](const StoredFolder& f) { replace_in(f, name, from, to); });
  };
  CHECK(with("metrics.csv", "\"hall\",3,0.5,1,0,0,1,50\n", "").find("4 sensors") !=
        std::string::npos);
  CHECK(with("metrics.csv", ",3,0.5", ",nan,0.5") != "");
  CHECK(with("honeybee/sun-up-hours.txt", "9.5\n", "7.5\n").find("later hour") !=
        std::string::npos);
  CHECK(with("honeybee/sun-up-hours.txt", "9.5\n", "9.25\n").find("9.25") != std::string::npos);
  CHECK(with("honeybee/dynamic_schedule.json", "\"schedule\":[0", "\"schedule\":[0,2") != "");
  CHECK(with("honeybee/dynamic_schedule.json", "South", "North") != "");
  CHECK(with("honeybee/study_info.json", "\"timestep\":1", "\"timestep\":0") != "");
  CHECK(with("honeybee/grids_info.json", "\"full_id\": \"desk\"", "\"full_id\": \"../desk\"")
            .find("full_id") != std::string::npos);
  CHECK(with("honeybee/grids_info.json", "\"full_id\": \"desk\"", "\"full_id\": \"..\"") != "");
  CHECK(with("honeybee/grids_info.json", "\"count\": 3", "\"count\": 99999999999") != "");
  CHECK(with("honeybee/grids_info.json", "\"count\": 3", "\"count\": 4").find("desk.npy") !=
        std::string::npos);
  CHECK(with("annual.json", "{\"name\": \"down\"}", "{}") != "");
  CHECK(message_after([](const StoredFolder& f) { f.write("annual.json", "[[[["); }) != "");
}

TEST_CASE("arrays that are cut off, too long or of another type are refused") {
  const auto with = [](const std::function<std::string(std::string)>& change) {
    return message_after([&](const StoredFolder& f) {
      f.write(south_total, change(text_of_file(f.file(south_total))));
    });
  };
  const auto cut = [](size_t length) {
    return [length](std::string s) { return s.substr(0, length); };
  };
  for (const size_t length : {0, 5, 11, 60, 127, 128, 200})
    CHECK(with(cut(length)).find("desk.npy") != std::string::npos);
  CHECK(with([](std::string s) { return s + "1234"; }).find("bytes") != std::string::npos);
  const auto swap = [](const std::string& from, const std::string& to) {
    return [from, to](std::string s) { return s.replace(s.find(from), from.size(), to); };
  };
  CHECK(with(swap("<f4", "<f8")).find("32-bit") != std::string::npos);
  CHECK(with(swap("False", "True ")).find("row by row") != std::string::npos);
  CHECK(with(swap("(3, 16)", "(16, 3)")).find("16 sensors") != std::string::npos);
  CHECK(with(swap("(3, 16)", "(3, 99)")) != "");
  CHECK(with(swap("(3, 16)", "(48,)  ")) != "");
  CHECK(with(swap("NUMPY", "NUMPI")) != "");
  CHECK(with(swap(std::string("\x01\x00", 2), std::string("\x02\x00", 2))) != "");
  CHECK(with(swap(std::string("\x01\x00", 2), std::string("\x09\x00", 2))) != "");
}

TEST_CASE("an array that shrinks while it is in use makes an error") {
  const StoredFolder folder;
  StoredHours hours(read_stored_year(folder.path()));
  CHECK_NOTHROW(hours.all_sensors(0, StoredPart::direct, {1}));
  std::filesystem::resize_file(folder.file(south_total), 140);
  CHECK_THROWS_AS(hours.all_sensors(0, StoredPart::total, {1}), InputError);
  CHECK_THROWS_AS(hours.all_hours(2, StoredPart::total, {1}), InputError);
  CHECK_NOTHROW(hours.all_sensors(0, StoredPart::total, {0}));
}

TEST_CASE("a folder with damaged files is read or refused") {
  const std::vector<std::string> names{"annual.json",
                                       "metrics.csv",
                                       "honeybee/sun-up-hours.txt",
                                       "honeybee/study_info.json",
                                       "honeybee/dynamic_schedule.json",
                                       "honeybee/grids_info.json",
                                       south_total,
                                       "honeybee/standard_error/hall.npy"};
  const StoredFolder folder;
  std::mt19937 random(1);
  const auto below = [&](size_t n) { return random() % n; };
  int refused = 0;
  for (int i = 0; i < 400; ++i) {
    const std::string& name = names[size_t(i) % names.size()];
    const std::string whole = text_of_file(folder.file(name));
    std::string damaged = whole;
    if (below(4) == 0) damaged.resize(below(damaged.size()));
    for (size_t k = below(4); !damaged.empty() && k-- > 0;)
      damaged[below(damaged.size())] = "0123456789,.[]{}:\"'<()\n\xff -e"[below(31)];
    folder.write(name, damaged);
    try {
      StoredHours hours(read_stored_year(folder.path()));
      const StoredStates states(hours.year().groups.size(), by_schedule);
      (void)hours.all_sensors(0, StoredPart::total, states);
      (void)hours.all_hours(0, StoredPart::total, states);
      (void)hours.errors(hours.year().points.size() - 1);
    } catch (const InputError& e) {
      CHECK(!std::string(e.what()).empty());
      ++refused;
    }
    folder.write(name, whole);
  }
  CHECK(refused > 100);
  CHECK(refused < 400);
}
