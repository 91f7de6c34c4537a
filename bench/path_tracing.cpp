// How much of the path tracer's time is tracing: renders scenes on one thread, and replays the very
// same rays, batch by batch, through Embree alone.
//
//   bench_path [SCENE…]     (default: scenes/kj92room and scenes/modern-hall of the repository)

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <string>
#include <vector>

#include "import/import.h"
#include "render/render.h"

using namespace troffer;

namespace {

using Clock = std::chrono::steady_clock;
constexpr int rounds = 5;  // the fastest counts

double seconds_since(Clock::time_point t) {
  return std::chrono::duration<double>(Clock::now() - t).count();
}

struct Replay {
  double seconds = 0;
  size_t rays = 0;
};

// Traces the logged batches of one kind again.
Replay replay(const Tracer& tracer, const RayLog& log, bool is_occlusion) {
  std::vector<Hit> hits;
  std::vector<uint8_t> occluded;
  Replay r;
  const Clock::time_point start = Clock::now();
  for (const RayLog::Batch& b : log.batches) {
    if (b.is_occlusion != is_occlusion) continue;
    const std::span<const Ray> rays(log.rays.data() + b.first, b.size);
    r.rays += b.size;
    if (is_occlusion) {
      occluded.resize(b.size);
      tracer.occluded(rays, occluded, b.coherence);
    } else {
      hits.resize(b.size);
      tracer.closest(rays, hits, b.coherence);
    }
  }
  r.seconds = seconds_since(start);
  return r;
}

void keep_fastest(Replay& best, const Replay& r) {
  if (best.rays == 0 || r.seconds < best.seconds) best = r;
}

void run(const std::string& file) {
  PreparedScene scene(import_scene(file));
  const Camera camera = scene.scene.cameras.at(0);
  RenderOptions o;
  o.method = Method::path;
  o.width = o.height = 256;
  o.spp = 4;
  o.threads = 1;
  const StopFlag never = false;

  RayLog log;
  scene.tracer.set_log(&log);
  render(scene, camera, o, {}, never);
  scene.tracer.set_log(nullptr);

  double path = 1e9;
  Replay closest, occlusion;
  for (int i = 0; i < rounds; ++i) {  // in turns, so that a busy machine is unfair to none
    const Clock::time_point start = Clock::now();
    render(scene, camera, o, {}, never);
    path = std::min(path, seconds_since(start));
    keep_fastest(closest, replay(scene.tracer, log, false));
    keep_fastest(occlusion, replay(scene.tracer, log, true));
  }
  const double tracing = closest.seconds + occlusion.seconds;
  fmt::print("{}\n", file);
  fmt::print("  path tracer, 256x256, 4 spp, 1 thread   {:7.3f} s\n", path);
  fmt::print("  Embree alone, closest hits              {:7.3f} s  {:6.2f} M rays  {:6.2f} M/s\n",
             closest.seconds, double(closest.rays) * 1e-6,
             double(closest.rays) * 1e-6 / closest.seconds);
  fmt::print("  Embree alone, occlusion                 {:7.3f} s  {:6.2f} M rays  {:6.2f} M/s\n",
             occlusion.seconds, double(occlusion.rays) * 1e-6,
             double(occlusion.rays) * 1e-6 / occlusion.seconds);
  fmt::print("  share of tracing                        {:6.1f} %\n", 100 * tracing / path);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> files(argv + 1, argv + argc);
  if (files.empty())
    files = {TROFFER_SOURCE_DIR "/scenes/kj92room/kj92room.gltf",
             TROFFER_SOURCE_DIR "/scenes/modern-hall/modern-hall.pbrt"};
  try {
    for (const std::string& f : files) run(f);
  } catch (const std::exception& e) {
    fmt::print(stderr, "error: {}\n", e.what());
    return 1;
  }
  return 0;
}
