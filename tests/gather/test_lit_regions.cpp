// Gather rays that are guided to lit regions: the same mean, and less noise.
#include <doctest/doctest.h>

#include <cmath>

#include "base/random.h"
#include "base/units.h"
#include "gather/lit_regions.h"
#include "gather/sensor_distributions.h"
#include "support/light_scenes.h"

using namespace troffer;
using namespace troffer::test;

namespace {

constexpr float cell_size = 0.1f;

CellHit facing(const Vec3& position, const Vec3& normal) {
  return {position, normal, normal, 1e-5f};
}

// Pilot hits of rays that look down on a floor of 4 × 4 m with a bright square of 30 cm.
struct Floor {
  static constexpr int side = 40;
  std::vector<PilotHit> seen;
  std::vector<Rgb> irradiance;

  explicit Floor(float brightness) {
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i) {
        const Vec3 p{(float(i) + 0.5f) * cell_size - 2, (float(j) + 0.5f) * cell_size - 2, 0};
        const bool is_bright = i >= 5 && i < 8 && j >= 5 && j < 8;
        seen.push_back({facing(p, {0, 0, 1}), uint32_t(irradiance.size()), 1, 0.5f});
        irradiance.push_back(Rgb{is_bright ? brightness : 1});
      }
  }
  static constexpr float first = 5 * cell_size - 2,
                         last = 8 * cell_size - 2;  // borders of the square, metres
  // Radiance along a ray.
  static float shines(const Vec3& from, const Vec3& direction, float brightness) {
    if (direction.z >= 0) return 0.5f;
    const Vec3 p = from - direction * (from.z / direction.z);
    return p.x > first && p.x < last && p.y > first && p.y < last ? 0.5f * brightness : 0.5f;
  }
  // Mean of shines() over cosine-distributed rays, by a sum over the square.
  static double mean_at(const CellHit& at, float brightness) {
    constexpr int n = 400;
    const double step = double(last - first) / n;
    double share = 0;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const Vec3 d =
            Vec3{first + float((i + 0.5) * step), first + float((j + 0.5) * step), 0} - at.position;
        const float cosine = dot(d, at.normal);
        if (cosine > 0) share += double(cosine * -d.z / sqr(length_squared(d)));
      }
    return 0.5 + 0.5 * (double(brightness) - 1) * share * sqr(step) / pi;
  }
};

Scene nothing_in_the_way() {
  Scene s;
  add_quad(s, add_diffuse(s, Rgb{0.5f}), {Vec3{0, 0, -9}, {1, 0, -9}, {1, 1, -9}, {0, 1, -9}});
  return s;
}

struct RayMoments {
  double n = 0, sum = 0, squares = 0, largest = 0;
  void add(double x) {
    n += 1;
    sum += x;
    squares += x * x;
    largest = std::max(largest, x);
  }
  double mean() const { return sum / n; }
  double variance() const { return squares / n - sqr(mean()); }
  double error() const { return std::sqrt(variance() / n); }
};

Vec2 number(Random& random) {
  const float x = random.next_float();
  return {x, random.next_float()};
}

}  // namespace

TEST_CASE("no lit regions where light is uniform") {
  const Scene scene = nothing_in_the_way();
  const Tracer tracer(scene);
  const Floor even(1.5f), nothing(0);
  CHECK(LitRegions(tracer, even.seen, even.irradiance, cell_size).all().empty());
  CHECK(LitRegions(tracer, {}, {}, cell_size).all().empty());
  std::vector<Rgb> black(nothing.irradiance.size(), Rgb{0});
  CHECK(LitRegions(tracer, nothing.seen, black, cell_size).all().empty());
  const Floor bright(500);
  const LitRegions found(tracer, bright.seen, bright.irradiance, cell_size);
  REQUIRE(!found.all().empty());
  for (const LitRegion& p : found.all()) {
    CHECK(length(p.centre - Vec3{-1.35f, -1.35f, 0}) < 0.2f);
    CHECK(p.mean_square == doctest::Approx(sqr(250.0)).epsilon(0.01));
    CHECK(p.normal.z == doctest::Approx(1));
  }
}

TEST_CASE("rays guided to lit regions have the mean of cosine-distributed rays, and less noise") {
  const Scene scene = nothing_in_the_way();
  const Tracer tracer(scene);
  constexpr float brightness = 500;
  const Floor floor(brightness);
  const LitRegions places(tracer, floor.seen, floor.irradiance, cell_size);
  Random random(1);
  double fewest = 1e9;
  for (int k = 0; k < 40; ++k) {
    // Random places above the floor, with random normals: also beside the bright square, within its
    // sphere, and with the horizon through it.
    Vec3 p = random_point(random, 2);
    p.z = random_size(random, 0.02f, 2);
    if (k == 0) p = {-1.35f, -1.35f, 0.05f};
    const CellHit at = facing(p, k == 1 ? Vec3{0, 0, -1} : random_direction(random));
    const RegionVisibility sight = places.visibility_from({&at, 1});
    const GatherDistribution aim(places, sight, at), plain;
    CAPTURE(k);
    RayMoments ones, aimed, by_cosine;
    for (int i = 0; i < 40000; ++i) {
      float weight = 0;
      const Vec3 d = aim.direction(at, number(random), weight);
      CHECK_MESSAGE(length(d) == doctest::Approx(1), d.x, " ", d.y, " ", d.z);
      ones.add(double(weight));
      aimed.add(double(weight) * double(Floor::shines(p, d, brightness)));
      const Vec3 e = plain.direction(at, number(random), weight);
      REQUIRE(weight == 1);
      by_cosine.add(double(Floor::shines(p, e, brightness)));
    }
    CHECK(ones.largest <= 1 / double(GatherDistribution::least_by_cosine) + 1e-5);
    CHECK(std::abs(ones.mean() - 1) < 5 * ones.error() + 1e-6);
    CHECK(std::abs(aimed.mean() - Floor::mean_at(at, brightness)) < 5 * aimed.error() + 1e-3);
    CHECK(aimed.variance() < 2.2 * by_cosine.variance() + 0.2);
    if (k == 1 || by_cosine.variance() < 1) continue;
    fewest = std::min(fewest, aimed.variance() / by_cosine.variance());
  }
  CHECK(fewest < 0.1);
}

TEST_CASE("the first rays guide later ones") {
  const Scene scene = [] {  // a sheet between the bright square and half of the room
    Scene s;
    add_quad(s, add_diffuse(s, Rgb{0.5f}), {Vec3{-1, -3, 0}, {-1, 3, 0}, {-1, 3, 3}, {-1, -3, 3}});
    return s;
  }();
  const Tracer tracer(scene);
  const Floor floor(500);
  const LitRegions places(tracer, floor.seen, floor.irradiance, cell_size);
  const CellHit hidden = facing({1, 0, 1}, {0, 0, -1}), open = facing({-1.5f, 0, 1}, {0, 0, -1});
  const auto aimed = [&](const CellHit& at, const RegionVisibility& sight) {
    const GatherDistribution aim(places, sight, at);
    Random random(2);
    int n = 0;
    for (int i = 0; i < 1000; ++i) {
      float weight = 0;
      n += aim.is_towards_bright(aim.direction(at, number(random), weight)) ? 1 : 0;
    }
    return n;
  };
  // A few visibility tests find the sheet.
  const RegionVisibility of_hidden = places.visibility_from({&hidden, 1}),
                         of_open = places.visibility_from({&open, 1});
  CHECK(aimed(hidden, of_hidden) < 0.6 * aimed(open, of_open));
  // Rays that find nothing there also correct the aim.
  RegionVisibility told = of_open;
  const GatherDistribution aim(places, told, open);
  GuidingStatistics tally;
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    float weight = 0;
    const Vec3 d = aim.direction(open, number(random), weight);
    tally.add(aim, d, weight, 10 * weight);
  }
  tally.tell(told);
  CHECK(told.rest == doctest::Approx(100));
  CHECK(aimed(open, told) < 0.5 * aimed(open, of_open));
  // Without rays, nothing changes.
  GuidingStatistics().tell(told);
  CHECK(told.rest == doctest::Approx(100));
}

TEST_CASE(
    "sensors of a patch share a distribution: same mean as cosine-distributed rays, less noise") {
  const Scene scene = nothing_in_the_way();
  const Tracer tracer(scene);
  constexpr float brightness = 500;
  const Floor floor(brightness);
  const LitRegions places(tracer, floor.seen, floor.irradiance, cell_size);
  Random random(2);
  SensorDistributions aims;
  for (int round = 0; round < 8; ++round) {
    // Bumpy patches of 20 cm in different orientations, with 1000 sensors each.
    SensorBatch sensors;
    sensors.offset = 1e-5f;
    for (uint64_t patch = 0; patch < 4; ++patch) {
      Vec3 middle = random_point(random, 2);
      middle.z = random_size(random, 0.3f, 2);
      const Vec3 normal = random_direction(random);
      for (uint32_t i = 0; i < 1000; ++i) {
        sensors.positions.push_back(middle + random_point(random, 0.1f));
        sensors.normals.push_back(normalize(normal + random_point(random, 0.3f)));
        sensors.streams.push_back(patch);
        sensors.samples.push_back(i);
      }
    }
    aims.begin(places, sensors);
    RayMoments ones, aimed, by_cosine;
    double truth = 0;
    for (size_t i = 0; i < sensors.size(); ++i) {
      const CellHit at = hit_of(sensors, i);
      float weight = 0;
      const Vec3 d = aims.at(i).direction(at, number(random), weight);
      ones.add(double(weight));
      aimed.add(double(weight) * double(Floor::shines(at.position, d, brightness)));
      const Vec3 e = GatherDistribution().direction(at, number(random), weight);
      by_cosine.add(double(Floor::shines(at.position, e, brightness)));
      if (i % 50 == 0) truth += Floor::mean_at(at, brightness) * 50 / double(sensors.size());
    }
    CAPTURE(round);
    CHECK(ones.largest <= 1 / double(GatherDistribution::least_by_cosine) + 1e-5);
    CHECK(std::abs(ones.mean() - 1) < 5 * ones.error() + 1e-6);
    CHECK(std::abs(aimed.mean() - truth) < 5 * aimed.error() + 0.02 * truth);
    if (by_cosine.variance() > 50) CHECK(aimed.variance() < 0.7 * by_cosine.variance());
  }
}

TEST_CASE("the distribution of a single sensor does not depend on earlier requests") {
  const Scene scene = nothing_in_the_way();
  const Tracer tracer(scene);
  const Floor floor(500);
  const LitRegions places(tracer, floor.seen, floor.irradiance, cell_size);
  const SensorBatch apart{{{0, 0, 1}, {0, 0, 1}, {1, 0, 1}},
                          {{0, 0, -1}, {0, 0, -1}, {0, 0, -1}},
                          {1, 1, 2},
                          {0, 1, 0},
                          1e-5f};
  const SensorBatch patch{{{0, 0, 1}, {0, 1, 1}}, {{0, 0, -1}, {0, 0, -1}}, {1, 1}, {0, 1}, 1e-5f};
  SensorDistributions aims, fresh;
  const auto first_of = [&](SensorDistributions& by, const SensorBatch& batch) {
    by.begin(places, batch);
    std::vector<Vec3> directions;
    for (size_t i = 0; i < batch.size(); ++i) {
      float weight = 0;
      directions.push_back(by.at(i).direction(hit_of(batch, i), {0.9f, 0.4f}, weight));
    }
    return directions;
  };
  const std::vector<Vec3> alone = first_of(fresh, apart);
  const CellHit at = hit_of(apart, 0);
  float weight = 0;
  CHECK(alone[0] == GatherDistribution(places, places.visibility_from({&at, 1}), at)
                        .direction(at, {0.9f, 0.4f}, weight));
  CHECK(alone[0] == alone[1]);
  CHECK(!(alone[0] == alone[2]));
  first_of(aims, patch);
  CHECK(first_of(aims, apart) == alone);
  first_of(aims, patch);
  CHECK(first_of(aims, apart) == alone);
}
