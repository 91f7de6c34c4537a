// Years of daylight by the public interface: grids and window groups of a Honeybee model, and what
// it refuses. tests/python/test_annual.py compares values.
#include <doctest/doctest.h>
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "support/hbjson_room.h"
#include "troffer/troffer.h"

using namespace troffer;

namespace {

namespace fs = std::filesystem;

// A model whose window has a tint in its second state, and a day of weather.
class YearFiles {
 public:
  YearFiles() : folder_(fs::temp_directory_path() / fmt::format("troffer-year-{}", getpid())) {
    fs::create_directories(folder_);
    test::HbjsonRoom room;
    room.modifiers =
        R"({"type":"Glass","identifier":"tint","r_transmissivity":0.1,"g_transmissivity":0.1,"b_transmissivity":0.1},)";
    room.window =
        R"("dynamic_group_identifier":"South","states":[{"type":"RadianceSubFaceStateAbridged"},{"modifier":"tint"}])";
    std::ofstream(scene()) << room.text();
    std::ofstream out(weather());
    out << "place Test\nlatitude 48\nlongitude 0\ntime_zone 0\nsite_elevation 0\n"
           "weather_data_file_units 1\n";
    for (int h = 0; h < 24; ++h)
      out << fmt::format("3 21 {}.500 {} {}\n", h, h == 12 ? 600 : 0, h > 6 && h < 18 ? 150 : 0);
  }
  ~YearFiles() { fs::remove_all(folder_); }
  std::string scene() const { return (folder_ / "room.hbjson").string(); }
  std::string weather() const { return (folder_ / "day.wea").string(); }

 private:
  fs::path folder_;
};

std::string year_refusal(api::Scene& scene, const YearFiles& files,
                         const api::AnnualOptions& options = {}) {
  try {
    (void)api::annual(scene, files.weather(), {}, options);
  } catch (const UsageError& e) {
    return e.what();
  }
  return "";
}

api::AnnualOptions few_rays() {
  api::AnnualOptions o;
  o.gather_rays = 64;
  o.subdivision = 1;
  return o;
}

}  // namespace

TEST_CASE("a Honeybee model brings grids and window groups to a year of daylight") {
  const YearFiles files;
  api::Scene scene = api::Scene::load(files.scene());
  const api::AnnualDaylight year = api::annual(scene, files.weather(), {}, few_rays());
  REQUIRE(year.is_complete);
  REQUIRE(year.grids.size() == 1);
  CHECK(year.grids[0].name == "desk");
  CHECK(year.sensors == year.grids[0].count);
  CHECK(year.total.size() == year.sensors * year.hours.size());
  CHECK(year.occupied.size() == year.hours.size());
  CHECK(year.of(year.total, 0).size() == year.hours.size());
  REQUIRE(year.groups.size() == 1);
  CHECK(year.groups[0].states == std::vector<std::string>{"state 0", "tint"});
  // Where the sun gets in, the group closes; then all light of the window passes the tint.
  for (std::size_t h = 0; h < year.hours.size(); ++h) {
    bool has_sun = false;
    for (std::size_t s = 0; s < year.sensors; ++s)
      has_sun = has_sun || year.of(year.direct, s)[h] >= 1000;
    CHECK((year.groups[0].shown[h] == 1) == has_sun);
  }
  api::AnnualOptions open = few_rays();
  open.blinds = "open";
  const api::AnnualDaylight bright = api::annual(scene, files.weather(), {}, open);
  for (std::size_t i = 0; i < year.total.size(); ++i) CHECK(bright.total[i] >= year.total[i]);
}

TEST_CASE("a year refuses what it cannot compute") {
  const YearFiles files;
  api::Scene scene = api::Scene::load(files.scene());
  api::AnnualOptions wrong = few_rays();
  wrong.gather_rays = 3;
  CHECK(year_refusal(scene, files, wrong).find("gather_rays") != std::string::npos);
  wrong = few_rays();
  wrong.occupancy = "8-8";
  CHECK(year_refusal(scene, files, wrong).find("such as 8-18") != std::string::npos);
  wrong = few_rays();
  wrong.groups = files.weather();
  CHECK(year_refusal(scene, files, wrong).find("window groups of its own") != std::string::npos);
  // The states of a model are read from its file, which lacks this change.
  scene.set_base_color(0, {0.1f, 0.1f, 0.1f});
  CHECK(year_refusal(scene, files, few_rays()).find("changes of this scene") != std::string::npos);
  api::Scene empty;
  CHECK(year_refusal(empty, files).find("no sensor grids") != std::string::npos);
}

TEST_CASE("progress can stop a year") {
  const YearFiles files;
  api::Scene scene = api::Scene::load(files.scene());
  api::AnnualOptions long_one;
  long_one.gather_rays = 1 << 20;
  const api::AnnualDaylight year =
      api::annual(scene, files.weather(), {}, long_one, [](double) { return false; });
  CHECK(!year.is_complete);
  CHECK(year.total.empty());
}
