#include "methods/openings_training.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "base/parallel.h"
#include "base/random.h"
#include "base/streams.h"
#include "methods/path.h"
#include "transport/purposes.h"

namespace troffer {

namespace {

constexpr size_t paths_at_a_time = 1024;
// Paths of the second round find light through the openings of the first one.
constexpr size_t rounds = 2;

// Returns the strongest piece that openings may let in, if there is one.
std::optional<uint32_t> sky_of(const PreparedScene& scene) {
  std::optional<uint32_t> strongest;
  for (const uint32_t p : scene.primitives.at_infinity())
    if (is_all_around(scene.scene, scene.primitives[p]) &&
        (!strongest || scene.primitives[p].power > scene.primitives[*strongest].power))
      strongest = p;
  return strongest;
}

// Returns training paths [first, end), stratified over the picture and over everything else.
ViewingRays training_rays(const PictureView& view, uint64_t stream, size_t first, size_t end) {
  ViewingRays rays;
  const auto width = float(view.image.width()), height = float(view.image.height());
  for (size_t i = first; i < end; ++i) {
    const Vec2 place = SobolGroup(stream, purpose_camera, uint32_t(i)).get2(0);
    rays.streams.push_back(stream);
    rays.samples.push_back(uint32_t(i));
    rays.rays.push_back(view.ray(place.x * width, place.y * height));
  }
  return rays;
}

// Samples of a piece along some of the training paths.
struct TrainingPart {
  std::vector<SkySample> samples;
  Counters counters;
};
TrainingPart trace_part(const PathIntegrator& paths, const ViewingRays& rays, uint32_t piece) {
  TrainingPart part;
  const std::unique_ptr<IntegratorScratch> scratch = paths.make_scratch();
  RadianceBatch out;
  out.reset(rays.size());
  paths.radiance_and_samples(rays, piece, *scratch, part.samples, out, part.counters);
  return part;
}

}  // namespace

std::shared_ptr<const Openings> find_openings(const PreparedScene& scene, const PictureView& view,
                                              const PathForecast& f, double rays, uint64_t seed,
                                              int threads, Counters& counters) {
  const std::optional<uint32_t> sky = sky_of(scene);
  if (!sky || !(f.rays_of_path > 0)) return nullptr;
  const auto parts =
      size_t(std::max(rays / f.rays_of_path / double(paths_at_a_time * rounds), 1.0));
  const uint64_t stream = hash_of(seed, stream::openings);
  std::vector<SkySample> samples;
  std::shared_ptr<const Openings> openings;
  for (size_t round = 0; round < rounds; ++round) {
    PathOptions options;
    options.openings = openings;
    const PathIntegrator paths(scene, options);
    std::vector<TrainingPart> done(parts);
    parallel_for(parts, threads, [&](size_t k) {
      const size_t first = (round * parts + k) * paths_at_a_time;
      done[k] =
          trace_part(paths, training_rays(view, stream, first, first + paths_at_a_time), *sky);
    });
    for (const TrainingPart& p : done) {
      samples.insert(samples.end(), p.samples.begin(), p.samples.end());
      counters += p.counters;
    }
    openings = std::make_shared<const Openings>(*sky, samples);
    if (openings->is_empty()) return nullptr;
  }
  return openings;
}

}  // namespace troffer
