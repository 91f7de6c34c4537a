// The driver of waves: which hits it gives to the two parts of a method, when, and what it adds.
#include "transport/wave_integrator.h"

#include <doctest/doctest.h>

#include <map>

#include "methods/methods.h"
#include "probe.h"

using namespace troffer;
using namespace troffer::test;

namespace {

// Log of what the driver did with one part of a method.
struct Log {
  std::map<uint32_t, int> hits;  // by index of the viewing ray
  std::vector<std::string> calls;
  size_t most_at_a_time = 0;
  size_t weighed = 0;
  bool is_weighed_without_density = false;

  void note(const std::string& call) {
    if (calls.empty() || calls.back() != call) calls.push_back(call);
  }
  void note_hits(const WaveHits& wave) {
    note("queue");
    for (const Walk& w : wave.walks) ++hits[w.index];
    most_at_a_time = std::max(most_at_a_time, wave.size());
  }
};

struct LoggedDirect final : DirectLight {
  LoggedDirect(Log& l, WalkedPart p) : log(l), part(p) {}
  std::unique_ptr<DirectLightScratch> make_scratch() const override {
    return std::make_unique<DirectLightScratch>();
  }
  WalkedPart walked_part() const override { return part; }
  void begin(const SampleRequest&, DirectLightScratch&) const override { log.note("begin"); }
  void queue(WaveHits& wave, DirectLightScratch&, RadianceBatch&, Counters&) const override {
    CHECK(wave.size() > 0);
    CHECK(wave.vertices.size() == wave.size());
    CHECK((part == WalkedPart::whole ? wave.bsdfs.size() : wave.scatterings.size()) == wave.size());
    log.note_hits(wave);
  }
  void flush(DirectLightScratch&, RadianceBatch& out, Counters&) const override {
    log.note("flush");
    for (const auto& [index, count] : log.hits) out.direct[index] = Rgb{float(count)};
  }
  void weigh(SeenEmission& seen) const override {
    for (size_t i = 0; i < seen.size(); ++i) {
      log.is_weighed_without_density |= !(seen.walks[i]->pdf > 0);
      seen.weights[i] = 0.25f;
    }
    log.weighed += seen.size();
  }
  Log& log;
  WalkedPart part;
};

struct LoggedIndirect final : IndirectLight {
  explicit LoggedIndirect(Log& l) : log(l) {}
  std::unique_ptr<IndirectLightScratch> make_scratch() const override {
    return std::make_unique<IndirectLightScratch>();
  }
  void begin(const SampleRequest&, IndirectLightScratch&) const override { log.note("begin"); }
  void queue(WaveHits& wave, IndirectLightScratch&, RadianceBatch&, Counters&) const override {
    log.note_hits(wave);
  }
  void flush(IndirectLightScratch&, RadianceBatch&, Counters&) const override { log.note("flush"); }
  void gather(const SensorBatch& sensors, IndirectLightScratch&, RadianceBatch& out,
              Counters&) const override {
    log.note("gather");
    for (size_t i = 0; i < sensors.size(); ++i) out.indirect[i] = Rgb{1};
  }
  Log& log;
};

// A matte floor, and to its right a mirror that shows a matte wall.
Scene floor_and_mirror() {
  Scene s;
  const uint32_t grey = add_diffuse(s, Rgb{0.5f});
  add_quad(s, grey, {Vec3{-5, -5, 0}, {0, -5, 0}, {0, 5, 0}, {-5, 5, 0}});
  add_quad(s, add_mirror(s), {Vec3{0, -5, 0}, {5, -5, 0}, {5, 5, 0}, {0, 5, 0}});
  add_quad(s, grey, {Vec3{-20, -20, 9}, {-20, 20, 9}, {20, 20, 9}, {20, -20, 9}});
  return s;
}

// Returns rays from above: every third meets the mirror, every sixth nothing.
ViewingRays rays_down(uint32_t n) {
  ViewingRays rays;
  for (uint32_t i = 0; i < n; ++i) {
    const float x = i % 6 == 5 ? 40.0f : i % 3 == 0 ? 2.0f : -2.0f;
    rays.rays.push_back(ray_towards({x, 0, 5}, {x, 0.01f * float(i % 7), 0}));
    rays.streams.push_back(i);
    rays.samples.push_back(0);
  }
  return rays;
}

}  // namespace

TEST_CASE("every hit is queued once, waves end with a flush, and both parts see the same hits") {
  const PreparedScene scene(floor_and_mirror());
  Log direct, indirect;
  const WaveIntegrator integrator(scene,
                                  std::make_unique<LoggedDirect>(direct, WalkedPart::specular),
                                  std::make_unique<LoggedIndirect>(indirect));
  const auto scratch = integrator.make_scratch();
  const ViewingRays rays = rays_down(300);
  RadianceBatch out;
  out.reset(rays.size());
  Counters counters;
  integrator.radiance(rays, *scratch, out, counters);
  const std::vector<std::string> two_waves{"begin", "queue", "flush", "queue", "flush"};
  CHECK(direct.calls == two_waves);
  CHECK(indirect.calls == two_waves);
  CHECK(direct.hits == indirect.hits);
  CHECK(direct.most_at_a_time < 300);
  for (uint32_t i = 0; i < 300; ++i) {
    const int expected = i % 6 == 5 ? 0 : i % 3 == 0 ? 2 : 1;
    CAPTURE(i);
    CHECK((direct.hits.count(i) != 0 ? direct.hits[i] : 0) == expected);
    CHECK(out.direct[i].g == float(expected));  // by the index that hits carry
  }
}

TEST_CASE("sensors are hits without a walk; indirect light is gathered for them") {
  const PreparedScene scene(floor_and_mirror());
  Log direct, indirect;
  const WaveIntegrator integrator(scene,
                                  std::make_unique<LoggedDirect>(direct, WalkedPart::specular),
                                  std::make_unique<LoggedIndirect>(indirect));
  SensorBatch sensors;
  for (uint32_t i = 0; i < 100; ++i) {
    sensors.positions.push_back({0, 0, 1});
    sensors.normals.push_back({0, 0, 1});
    sensors.streams.push_back(i);
    sensors.samples.push_back(0);
  }
  const auto scratch = integrator.make_scratch();
  RadianceBatch out;
  out.reset(sensors.size());
  Counters counters;
  integrator.irradiance(sensors, *scratch, out, counters);
  CHECK(direct.calls == std::vector<std::string>{"begin", "queue", "flush"});
  CHECK(indirect.calls == std::vector<std::string>{"begin", "gather"});
  for (size_t i = 0; i < sensors.size(); ++i) {
    CHECK(out.direct[i].g == 1);
    CHECK(out.indirect[i].g == 1);
  }
}

TEST_CASE("only emission that competes with light sampling is weighted") {
  Scene s;
  add_quad(s, add_metal(s, 0.2f), {Vec3{-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0}});
  add_ceiling_light(s, 100, 10, Rgb{1});
  const PreparedScene scene(std::move(s));
  Log log;
  const WaveIntegrator integrator(scene, std::make_unique<LoggedDirect>(log, WalkedPart::whole),
                                  nullptr);
  const auto scratch = integrator.make_scratch();
  ViewingRays rays = repeated(ray_towards({0, 0, 5}, {0, 0.1f, 0}), 1, 64);
  rays.rays[0] = ray_towards({0, 0, 5}, {0, 0.1f, 10});  // sees the light itself
  RadianceBatch out;
  out.reset(rays.size());
  Counters counters;
  integrator.radiance(rays, *scratch, out, counters);
  CHECK(log.weighed > 50);
  CHECK(log.weighed < 64);
  CHECK(!log.is_weighed_without_density);
  CHECK(out.direct[0].g == 1);
  // LoggedDirect::flush sets the value of what was queued; emission arrives a wave later.
  CHECK(out.direct[1].g < 2.0f);
}

TEST_CASE("methods are found by name and report their parts") {
  for (const Method m : {Method::certified, Method::kj92, Method::fixed, Method::path})
    CHECK(Method::find(m.row().name) == m);
  CHECK(Method::find("certified") == Method::certified);
  CHECK(Method::find("kj92") == Method::kj92);
  CHECK(Method::find("fixed") == Method::fixed);
  CHECK(Method::find("path") == Method::path);
  CHECK(!Method::find(""));
  CHECK(Method::names() == "certified, kj92, fixed, path or cached-path");
  CHECK(Indirect::find("auto") == Indirect::automatic);
  CHECK(Indirect::find("none") == Indirect::none);
  CHECK(Indirect::find("radiosity") == Indirect::radiosity);
  CHECK(Indirect::find("cells") == Indirect::cells);
  CHECK(needs_cells(Method::certified, Indirect::cells));
  CHECK(!needs_cells(Method::kj92, Indirect::cells));
  CHECK(!needs_radiosity(Method::certified, Indirect::automatic));
  CHECK(needs_cells(Method::certified, Indirect::automatic));
  CHECK(!needs_radiosity(Method::certified, Indirect::none));
  CHECK(needs_radiosity(Method::kj92, Indirect::none));
  CHECK(!needs_radiosity(Method::path, Indirect::automatic));
  CHECK(!needs_radiosity(Method::path, Indirect::radiosity));
}

TEST_CASE("light-tree sampling and fixed rays give the same light") {
  Scene s;
  add_quad(s, add_diffuse(s, Rgb{0.5f}), {Vec3{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}});
  add_ceiling_light(s, 2, 2, Rgb{3});
  const uint32_t side = add_quad(s, 0, {Vec3{3, -1, 0.5f}, {3, 1, 0.5f}, {3, 1, 2}, {3, -1, 2}});
  make_light(s, side, Rgb{2}, true);
  add_block(s, 0, {-0.4f, -0.4f, 0.5f}, {0.4f, 0.4f, 0.6f});
  const PreparedScene scene(std::move(s));
  const WaveIntegrator tree(scene, std::make_unique<LightTreeDirect>(scene), nullptr);
  const WaveIntegrator fixed = fixed_integrator(scene, 16);
  for (const Vec3& x : {Vec3{0.5f, 0.2f, 0}, Vec3{2, 1, 0}}) {
    const Ray ray = ray_towards({-3, -3, 3}, x);
    const Probed a = probe(tree, ray, 256, 64), b = probe(fixed, ray, 16, 64, 7);
    CHECK(std::abs(a.total.mean() - b.total.mean()) <
          4.5 * std::hypot(a.total.standard_error(), b.total.standard_error()));
    CHECK(a.total.mean() > 0.01);
  }
}
