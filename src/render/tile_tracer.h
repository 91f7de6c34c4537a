// Traces the viewing rays of tiles into the film. Used by Rendering, from many threads: each has
// its own TileWork, and no two work on the same tile.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "render/camera.h"
#include "render/film.h"
#include "render/further_choice.h"
#include "render/further_rays.h"
#include "render/tile.h"
#include "transport/integrator.h"

namespace troffer {

// Memory of one thread.
struct TileWork {
  ViewingRays rays;
  RadianceBatch radiance;
  std::vector<Pixel2> pixels;                           // per ray
  std::unique_ptr<IntegratorScratch> scratch, cheaper;  // cheaper: of Integrator::cheaper()
  RadianceBatch known;                                  // surrogate samples beside `radiance`
  Counters before;                                      // work of the current tile in earlier steps
  Counters counters;                                    // and in this step
};

// Returns the name of ray i of the TileWork at `work`, for messages of failed checks.
std::string name_of_ray(const void* work, size_t i);

class TileTracer {
 public:
  // All arguments must outlive this object.
  TileTracer(const ViewingCamera& camera, const Integrator& integrator,
             const RenderOptions& options, FurtherRays& further, Film& film, const StopFlag& stop)
      : camera_(camera),
        integrator_(integrator),
        options_(options),
        further_(further),
        film_(film),
        stop_(stop) {}

  // Prepares the memory for a tile.
  void begin(TileWork& w) const;
  // Traces the next `count` samples of all pixels.
  void first_pass(const PixelRect& tile, uint32_t count, TileWork& w);
  // Traces up to samples_per_pass further rays of each pixel that wants more than `first` samples,
  // next to the records of its neighbours (kj92).
  void further_pass(const PixelRect& tile, int first, TileWork& w);
  // Traces all further rays of a tile. Returns false if it was stopped before the end.
  bool further_rays(const PixelRect& tile, TileWork& w);
  // Adds surrogate samples to the pixels of a tile.
  void surrogates(const PixelRect& tile, TileWork& w);
  // Returns the typical luminance of the whole picture: the mean without the brightest twentieth,
  // which holds visible lamps. Its few rays enter neither the picture nor its statistics.
  double typical_luminance(const PixelRect& image, TileWork& w) const;

 private:
  void add_rays(const Pixel2& p, uint32_t count, TileWork& w) const;
  void number_like_first(ViewingRays& rays) const;
  void compute(const FurtherWay& way, TileWork& w);
  void trace(const FurtherWay& way, TileWork& w);
  double further_rays_planned(const Pixel2& p) const;
  std::vector<Pixel2> pixels_to_test(const PixelRect& tile, double wanted) const;
  TestPixel test_pixel(const Pixel2& p, const TileWork& w) const;
  void test(const std::vector<Pixel2>& pixels, uint32_t first, uint32_t count, TestedWay& tested,
            TileWork& w);
  FurtherChoice choose_way(const PixelRect& tile, double cost_of_first, TileWork& w);
  Rgb edge_correction(const TileWork& w, size_t ray) const;

  const ViewingCamera& camera_;
  const Integrator& integrator_;
  const RenderOptions& options_;
  FurtherRays& further_;
  Film& film_;
  const StopFlag& stop_;
};

}  // namespace troffer
