// Computes the light of a scene for all its surfaces and stores it with them: as lightmaps, or as
// vertex colours. `troffer bake` uses it.
//
// The stored value is irradiance E in lx: for a texel, the mean over the part of the surface that
// the texel covers. A Lambertian surface sends the radiance base_color × E / π.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bake/atlas.h"
#include "export/baked_light.h"
#include "image/image.h"
#include "render/measure.h"

namespace troffer {

// Settings of bake().
struct BakeOptions {
  BakedShading shading = BakedShading::lightmap;
  AtlasOptions atlas;
  int samples = 64;                      // per texel or vertex
  std::optional<double> exposure_stops;  // for unlit and vertex_colors; none: automatic
  MeasureOptions light;                  // method and its settings; spp is ignored
};

// Counts and means, for the summary.
struct BakeFigures {
  size_t charts = 0, stands = 0, sites = 0;  // sites: covered texels, or vertices
  size_t layered = 0;                        // stands whose two sides are lit separately
  size_t degenerate = 0;                     // triangles without area; they get no light
  double mean_lx = 0;                        // over all sites
  double error_lx = 0;                       // root mean square of the sites' standard errors
};

// Result of bake().
struct BakeResult {
  Scene scene;       // scene to write, together with `baked`
  BakedLight baked;  // light of its surfaces
  Atlas atlas;       // size 0: none
  // Per page, in lx: irradiance and its standard error, gutters filled.
  std::vector<Image> irradiance, error;
  BakeFigures figures;
  std::vector<Warning> warnings;
  Counters counters;
  bool is_complete = false;  // false if stopped: everything else is empty
};

// Bakes the light of a scene that as_meshes() made. Throws UsageError as make_atlas() does. The
// result does not depend on the number of threads.
BakeResult bake(const PreparedScene& scene, const BakeOptions& options,
                const ProgressCallback& progress, const StopFlag& stop);

}  // namespace troffer
