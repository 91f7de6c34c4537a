// Solution files: round trip, and rejection of bad files.
#include <doctest/doctest.h>

#include <cstring>
#include <iterator>
#include <limits>
#include <string>

#include "base/error.h"
#include "base/random.h"
#include "radiosity/rooms.h"

using namespace troffer;
using namespace troffer::test;

namespace {

RadiosityOptions few_elements() {
  RadiosityOptions o;
  o.meshing = sizes(0.6f, 1.8f);
  o.unshot_fraction = 0.1f;
  return o;
}

RadiositySolution load(const Ready& r, const std::vector<uint8_t>& bytes,
                       const RadiosityOptions& o) {
  return load_solution(bytes, "room.radiosity", r.scene, r.tracer, r.tables, &o, 2);
}

std::string refusal(const Ready& r, const std::vector<uint8_t>& bytes, const RadiosityOptions& o) {
  try {
    load(r, bytes, o);
  } catch (const InputError& e) {
    CHECK(e.file() == "room.radiosity");
    return e.reason();
  }
  return "";
}

}  // namespace

TEST_CASE("a saved solution comes back the same") {
  const Ready ready(lit_room(0.5f));
  const RadiositySolution s = ready.solve(few_elements());
  const RadiositySolution t = load(ready, save_solution(ready.scene, s), few_elements());
  REQUIRE(t.general.size() == s.general.size());
  CHECK(std::memcmp(t.general.data(), s.general.data(), s.general.size() * sizeof(Rgb)) == 0);
  REQUIRE(t.stored.size() == s.stored.size());
  CHECK(std::memcmp(t.stored.data(), s.stored.data(),
                    s.stored.size() * sizeof(StoredContribution)) == 0);
  CHECK(std::memcmp(t.general_direct.data(), s.general_direct.data(),
                    s.general.size() * sizeof(Rgb)) == 0);
  REQUIRE(t.shot_radiance.size() == s.mesh.patches.size());
  CHECK(std::memcmp(t.shot_radiance.data(), s.shot_radiance.data(),
                    s.shot_radiance.size() * sizeof(Rgb)) == 0);
  CHECK(t.mean_irradiance == s.mean_irradiance);
  CHECK(t.ambient == s.ambient);
  CHECK(t.balance.absorbed == s.balance.absorbed);
  CHECK(t.balance.escaped == s.balance.escaped);
  CHECK(t.shots == s.shots);
  CHECK(t.rays == s.rays);
  CHECK(t.is_complete == s.is_complete);
  CHECK(t.light_count == s.light_count);
}

TEST_CASE("another scene or other settings are refused") {
  const Ready ready(lit_room(0.5f));
  const std::vector<uint8_t> bytes = save_solution(ready.scene, ready.solve(few_elements()));
  const char* what = "another scene";
  const char* settings = "other settings";
  CHECK(refusal(Ready(lit_room(0.51f)), bytes, few_elements()).find(what) != std::string::npos);
  CHECK(refusal(Ready(lit_room(0.5f, 4.1f)), bytes, few_elements()).find(what) !=
        std::string::npos);
  RadiosityOptions o = few_elements();
  o.tolerance *= 2;
  CHECK(refusal(ready, bytes, o).find(settings) != std::string::npos);
  o = few_elements();
  o.light_rays /= 2;
  CHECK(refusal(ready, bytes, o).find(settings) != std::string::npos);
  o = few_elements();
  o.meshing.element_size = 0.7f;
  CHECK(refusal(ready, bytes, o).find("its element size is 0.6, not 0.7") != std::string::npos);
  CHECK(refusal(ready, bytes, few_elements()).empty());
}

TEST_CASE("a solution reports its settings") {
  const Ready ready(lit_room(0.5f));
  RadiosityOptions o = few_elements();
  o.seed = 0x123456789abcull;
  o.meshing.max_elements = 5000;
  const RadiositySolution s =
      load_solution(save_solution(ready.scene, ready.solve(o)), "room.radiosity", ready.scene,
                    ready.tracer, ready.tables, nullptr, 2);
  CHECK(s.options.seed == o.seed);
  CHECK(s.options.meshing.max_elements == 5000);
  CHECK(s.options.meshing.element_size == o.meshing.element_size);
  CHECK(s.options.unshot_fraction == o.unshot_fraction);
}

TEST_CASE("damaged files are refused") {
  const Ready ready(lit_room(0.5f));
  const std::vector<uint8_t> bytes = save_solution(ready.scene, ready.solve(few_elements()));
  for (size_t n : {size_t(0), size_t(5), size_t(8), size_t(60), size_t(199), size_t(200),
                   bytes.size() / 2, bytes.size() - 1}) {
    const std::vector<uint8_t> part(bytes.begin(), bytes.begin() + std::ptrdiff_t(n));
    CHECK_FALSE(refusal(ready, part, few_elements()).empty());
  }
  std::vector<uint8_t> longer = bytes;
  longer.push_back(0);
  CHECK_FALSE(refusal(ready, longer, few_elements()).empty());
  Random r(1);
  for (size_t i = 0; i < 400; ++i) {  // every byte of the header, and some others
    std::vector<uint8_t> bad = bytes;
    const size_t at = i < 200 ? i : r.next_u32() % bytes.size();
    bad[at] = uint8_t(bad[at] ^ (1u << (r.next_u32() % 8)));
    CHECK_FALSE(refusal(ready, bad, few_elements()).empty());
  }
}

TEST_CASE("light that is not finite is refused, wherever it is") {
  const Ready ready(lit_room(0.5f));
  const RadiositySolution good = ready.solve(few_elements());
  REQUIRE(refusal(ready, save_solution(ready.scene, good), few_elements()).empty());
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  using Spoil = void (*)(RadiositySolution&, float);
  const Spoil places[] = {
      [](RadiositySolution& s, float v) { s.general[s.general.size() / 2].g = v; },
      [](RadiositySolution& s, float v) { s.general_direct.back().b = v; },
      [](RadiositySolution& s, float v) { s.stored.front().received.r = v; },
      [](RadiositySolution& s, float v) { s.stored.back().unoccluded.g = v; },
      [](RadiositySolution& s, float v) { s.shot_radiance.back().r = v; },
      [](RadiositySolution& s, float v) { s.ambient.b = v; },
      [](RadiositySolution& s, float v) { s.mean_irradiance = v; },
      [](RadiositySolution& s, float v) { s.balance.absorbed = double(v); },
      [](RadiositySolution& s, float v) { s.balance.escaped = double(v); },
  };
  for (size_t i = 0; i < std::size(places); ++i)
    for (const float v : {nan, infinity, -infinity}) {
      CAPTURE(i);
      CAPTURE(v);
      RadiositySolution s = good;
      places[i](s, v);
      CHECK_FALSE(refusal(ready, save_solution(ready.scene, s), few_elements()).empty());
    }
}

TEST_CASE("options that are not finite are refused when the file's own settings are used") {
  const Ready ready(lit_room(0.5f));
  const RadiositySolution good = ready.solve(few_elements());
  using Spoil = void (*)(RadiosityOptions&, float);
  const Spoil places[] = {
      [](RadiosityOptions& o, float v) { o.unshot_fraction = v; },
      [](RadiosityOptions& o, float v) { o.tolerance = v; },
      [](RadiosityOptions& o, float v) { o.light_share = v; },
      [](RadiosityOptions& o, float v) { o.meshing.element_size = v; },
      [](RadiosityOptions& o, float v) { o.meshing.join_angle_deg = v; },
  };
  for (size_t i = 0; i < std::size(places); ++i)
    for (const float v :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1.0f}) {
      CAPTURE(i);
      CAPTURE(v);
      RadiositySolution s = good;
      places[i](s.options, v);
      CHECK_THROWS_AS(load_solution(save_solution(ready.scene, s), "room.radiosity", ready.scene,
                                    ready.tracer, ready.tables, nullptr, 2),
                      InputError);
    }
}

TEST_CASE("a different number of stored contributions is refused") {
  const Ready ready(lit_room(0.5f));
  RadiositySolution s = ready.solve(few_elements());
  const size_t points = s.general.size();
  for (const uint32_t other :
       {0u, few_elements().stored_per_point - 1, few_elements().stored_per_point + 1}) {
    CAPTURE(other);
    s.stored_per_point = other;
    s.stored.resize(points * other);
    CHECK_FALSE(refusal(ready, save_solution(ready.scene, s), few_elements()).empty());
  }
}
