// The plan of a rendering: printed by --explain, kept by --stats.
#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "program.h"

using namespace troffer::test;

namespace test_explain {

namespace {

nlohmann::json plan_of(const Folder& folder, std::vector<std::string> options, std::string& err) {
  std::vector<std::string> words{"render",  folder.write("room.pbrt", lit_floor_pbrt),
                                 "-o",      folder.path("o.pfm"),
                                 "--size",  "16x12",
                                 "--spp",   "1",
                                 "--stats", folder.path("s.json"),
                                 "--quiet"};
  words.insert(words.end(), options.begin(), options.end());
  const Finished f = run_program(folder, words);
  CAPTURE(f.err);
  REQUIRE(f.status == 0);
  err = f.err;
  return nlohmann::json::parse(read_file(folder.path("s.json"))).at("plan");
}

}  // namespace

TEST_CASE("the plan says what was chosen for each part of the light") {
  const Folder folder;
  const struct {
    std::vector<std::string> options;
    std::string part, choice;
  } cases[] = {
      {{"--indirect", "cells"}, "reflected light", "gathered from cells"},
      {{"--indirect", "none"}, "reflected light", "none"},
      {{"--method", "path"}, "all light", "path tracing"},
      {{"--method", "fixed", "--shadow-rays", "7"},
       "direct light",
       "7 shadow rays to every source"},
      {{"--method", "kj92"}, "reflected light", "radiosity, interpolated"},
  };
  for (const auto& c : cases) {
    CAPTURE(c.choice);
    std::string silent, said;
    const nlohmann::json plan = plan_of(folder, c.options, silent);
    CHECK(silent.empty());
    bool is_found = false;
    for (const nlohmann::json& p : plan.at("parts"))
      is_found |= p.at("part") == c.part && p.at("choice") == c.choice;
    CHECK(is_found);
    std::vector<std::string> explained = c.options;
    explained.push_back("--explain");
    plan_of(folder, explained, said);
    CHECK(said.find(c.part + ": " + c.choice) != std::string::npos);
    CHECK(said.find("viewing rays: ") != std::string::npos);
  }
}

TEST_CASE("the plan of the default method has the forecast that decided about paths") {
  const Folder folder;
  std::string said;
  const nlohmann::json plan = plan_of(folder, {"--error", "0.2"}, said);
  REQUIRE(plan.contains("forecast"));
  CHECK(plan.at("forecast").at("paths_per_pixel").get<double>() > 0);
  CHECK(plan.at("forecast").at("rays_by_paths").get<double>() > 0);
}

TEST_CASE("--stats counts the rays of cells and gathers apart from those of the picture") {
  const Folder folder;
  const std::string scene = folder.write("room.pbrt", bright_room_pbrt());
  const auto prepared = [&](const std::string& indirect) {
    const Finished f = run_program(
        folder, {"render", scene, "-o", folder.path("o.exr"), "--size", "16x12", "--indirect",
                 indirect, "--error", "0.3", "--stats", folder.path("s.json")});
    CAPTURE(f.err);
    REQUIRE(f.status == 0);
    return nlohmann::json::parse(read_file(folder.path("s.json")));
  };
  const nlohmann::json cells = prepared("cells"), none = prepared("none");
  CHECK(cells["preparation"]["extension_rays"].get<uint64_t>() >=
        cells["cells"]["rays"].get<uint64_t>());
  CHECK(cells["preparation"]["shadow_rays"].get<uint64_t>() > 0);
  CHECK(cells["preparation"]["nan_samples"] == 0);
  CHECK(none["preparation"]["extension_rays"] == 0);
  CHECK(none["preparation"]["shadow_rays"] == 0);
}

}  // namespace test_explain
