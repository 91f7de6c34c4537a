// Files in Honeybee's layout: headers of arrays, their contents, and no files without finish().
#include "annual/honeybee_folder.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

using namespace troffer;

namespace {

namespace fs = std::filesystem;

std::string contents(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

// A folder that lives as long as the object.
class TestFolder {
 public:
  TestFolder() : path_(fs::temp_directory_path() / fmt::format("troffer-honeybee-{}", getpid())) {
    fs::remove_all(path_);
  }
  ~TestFolder() { fs::remove_all(path_); }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

HoursOfSensor hours_of(float first) {
  HoursOfSensor h;
  h.states = {{{first, first + 1, first + 2}, {0, 1, first}}};
  return h;
}

}  // namespace

// NumPy's format 1.0: magic, version, length of the header, then text that ends in a line feed; the
// whole takes a multiple of 64 bytes.
TEST_CASE("an array's header is as NumPy defines it") {
  const std::string h = npy_header(12, 3456);
  CHECK(h.substr(0, 8) == std::string("\x93NUMPY\x01\x00", 8));
  CHECK(h.size() % 64 == 0);
  CHECK(size_t(uint8_t(h[8])) + 256 * size_t(uint8_t(h[9])) == h.size() - 10);
  CHECK(h.back() == '\n');
  CHECK(h.find("{'descr': '<f4', 'fortran_order': False, 'shape': (12, 3456), }") == 10);
}

TEST_CASE("arrays hold one row per sensor, and grids that need other names get them") {
  const TestFolder folder;
  WeatherYear year;
  for (int h = 0; h < 4; ++h) {
    WeatherStep& s = year.steps.emplace_back();
    s.hour_of_year = h + 0.5;
  }
  YearSkies skies{{1, 2, 3}, {ReinhartSky(1), {}}, {ReinhartSky(1), {}}, {}, {}, {}};
  {
    HoneybeeFolder files(folder.path().string(), {{"a/b", 2}, {"a b", 1}}, {{static_path, 1}}, 3);
    for (const float first : {10.0f, 20.0f, 30.0f}) files.add(hours_of(first));
    files.finish(year, skies, StateSchedule(1, 3));
  }
  const fs::path arrays = folder.path() / "__static_apertures__" / "default";
  const std::string total = contents(arrays / "total" / "a_b.npy");
  REQUIRE(total.size() == npy_header(2, 3).size() + 6 * sizeof(float));
  float last = 0;
  std::memcpy(&last, total.data() + total.size() - sizeof last, sizeof last);
  CHECK(last == 22);
  const std::string direct = contents(arrays / "direct" / "a_b_2.npy");
  std::memcpy(&last, direct.data() + direct.size() - sizeof last, sizeof last);
  CHECK(last == 30);
  CHECK(contents(folder.path() / "sun-up-hours.txt") == "1.5\n2.5\n3.5\n");
  CHECK(contents(folder.path() / "grids_info.json").find("\"full_id\": \"a_b_2\"") !=
        std::string::npos);
}

// Names as honeybee-radiance-postprocess reads them: GROUP/N_GROUP/total/GRID.npy, and only the
// light paths that light a grid.
TEST_CASE("groups have folders for each state, and a schedule") {
  const TestFolder folder;
  WeatherYear year;
  year.steps.resize(3);
  YearSkies skies{{1, 2}, {ReinhartSky(1), {}}, {ReinhartSky(1), {}}, {}, {}, {}};
  StateSchedule schedule(3, 2);
  schedule.of(1)[1] = 1;
  {
    HoneybeeFolder files(folder.path().string(), {{"a", 1}, {"b", 1}},
                         {{static_path, 1}, {"South", 2}, {"North", 1}}, 2);
    HoursOfSensor h;
    h.states = {{{0, 0}, {0, 0}}, {{7, 8}, {0, 1}}, {{3, 4}, {0, 0}}, {{0, 0}, {0, 0}}};
    files.add(h);
    h.states = {{{1, 1}, {0, 0}}, {{0, 0}, {0, 0}}, {{0, 0}, {0, 0}}, {{0, 9}, {0, 0}}};
    files.add(h);
    files.finish(year, skies, schedule);
  }
  const std::string closed = contents(folder.path() / "South" / "1_South" / "total" / "a.npy");
  float last = 0;
  REQUIRE(closed.size() == npy_header(1, 2).size() + 2 * sizeof last);
  std::memcpy(&last, closed.data() + closed.size() - sizeof last, sizeof last);
  CHECK(last == 4);
  CHECK(!fs::exists(folder.path() / "South" / "1_South" / "total" / "b.npy"));
  CHECK(!fs::exists(folder.path() / "North" / "0_North" / "total" / "a.npy"));
  CHECK(fs::exists(folder.path() / "North" / "0_North" / "direct" / "b.npy"));
  CHECK(!fs::exists(folder.path() / "__static_apertures__" / "default" / "total" / "a.npy"));
  CHECK(contents(folder.path() / "dynamic_schedule.json") ==
        R"({"South":{"identifier":"South","schedule":[0,0,1],"is_static":false},)"
        R"("North":{"identifier":"North","schedule":[0,0,0],"is_static":true}})"
        "\n");
  const std::string states = contents(folder.path() / "grid_states.json");
  CHECK(states.find("\"1_South\"") != std::string::npos);
}

TEST_CASE("an unfinished folder leaves nothing") {
  const TestFolder folder;
  {
    HoneybeeFolder files(folder.path().string(), {{"room", 2}}, {{static_path, 1}}, 3);
    files.add(hours_of(1));
  }
  CHECK(!fs::exists(folder.path()));
}

// The format is that of numpy.savetxt(file, array, fmt='%.7e', delimiter='\t') in
// honeybee-radiance-postprocess. numpy.loadtxt reads every float back from it.
TEST_CASE("text arrays hold the same numbers as binary ones") {
  CHECK(ill_row(std::vector<float>{0, 1234.5f, 0.03125f}) ==
        "0.0000000e+00\t1.2345000e+03\t3.1250000e-02\n");
  const TestFolder folder;
  WeatherYear year;
  year.steps.resize(3);
  YearSkies skies{{0, 1, 2}, {ReinhartSky(1), {}}, {ReinhartSky(1), {}}, {}, {}, {}};
  const std::vector<float> numbers{1.0f / 3, 98765.43f, 1e-3f};
  {
    HoneybeeFolder files(folder.path().string(), {{"a", 2}}, {{static_path, 1}}, 3,
                         ArrayFormat::npy_and_ill);
    HoursOfSensor h;
    h.states = {{numbers, {0, 0, 0}}};
    for (int i = 0; i < 2; ++i) files.add(h);
    files.finish(year, skies, StateSchedule(1, 3));
  }
  const fs::path total = folder.path() / "__static_apertures__" / "default" / "total";
  std::istringstream text(contents(total / "a.ill"));
  for (int row = 0; row < 2; ++row) {
    std::string line;
    REQUIRE(std::getline(text, line));
    std::istringstream values(line);
    for (const float expected : numbers) {
      std::string word;
      REQUIRE(std::getline(values, word, '\t'));
      CHECK(std::stof(word) == expected);
    }
    CHECK(values.peek() == EOF);
  }
  CHECK(text.peek() == EOF);
  CHECK(fs::exists(total / "a.npy"));
  CHECK(!fs::exists(folder.path() / "standard_error" / "a.ill"));
}
