// Light of a scene, computed once for all its surfaces and kept with them: lightmaps, or colours of
// vertices.
//
// What is kept is irradiance E: of a texel the mean over what it covers of the surface. A surface
// that scatters evenly sends base_color × E / pi.
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

struct BakeOptions {
  BakedShading shading = BakedShading::lightmap;
  AtlasOptions atlas;
  int samples = 64;                      // of a texel, or of a vertex
  std::optional<double> exposure_stops;  // unlit, vertex_colors; none: as suits the surfaces
  MeasureOptions light;                  // method and what it wants; spp is not used
};

struct BakeFigures {
  size_t charts = 0, stands = 0, sites = 0;  // sites: texels covered, or vertices
  size_t layered = 0;                        // stands whose both sides have light of their own
  size_t degenerate = 0;                     // triangles without area: without light
  double mean_lx = 0;                        // over all sites
  double error_lx = 0;                       // root mean square of their standard errors
};

struct BakeResult {
  Scene scene;       // to be written, with …
  BakedLight baked;  // … this
  Atlas atlas;       // size 0: none
  // Per page: irradiance and its standard error, lx; gutters filled.
  std::vector<Image> irradiance, error;
  BakeFigures figures;
  std::vector<Warning> warnings;
  Counters counters;
  bool is_complete = false;  // false: stopped, all else is empty
};

// `scene`: as_meshes(), prepared. UsageError as make_atlas has it. The result does not depend on
// threads.
BakeResult bake(const PreparedScene& scene, const BakeOptions& options,
                const ProgressCallback& progress, const StopFlag& stop);

}  // namespace troffer
