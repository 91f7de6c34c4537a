// Daylight glare of a view from a luminance picture: the Daylight Glare Probability and other
// indices. Sources are found as `evalglare` finds them. `troffer glare` uses it.
//
//   DGP = 5.87e-5 Ev + 0.092 log10(1 + Σ L² ω / (Ev^1.87 P²)) + 0.159                  [1, Eq. 13]
//
// Ev: vertical illuminance at the eye, lx; L: mean luminance of a source, cd/m²; ω: its solid
// angle, sr; P: position index.
//
// References: [1] Wienold & Christoffersen, "Evaluation Methods and Development of a New Glare
//   Prediction Model for Daylight Environments", Energy and Buildings 38(7), 2006. [2] Wienold,
//   evalglare 3 (Radiance, src/util/evalglare.c): detection, defaults, correction for low light.
//   [3] Chauvel et al., "Glare from Windows", Lighting Research & Technology 14(1), 1982 (DGI).
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "base/vec.h"
#include "image/image.h"

namespace troffer {

struct GlareSettings {
  // Luminance above which a pixel belongs to a source, cd/m². Up to 100 it is a factor on the
  // task's mean luminance, or on that of the picture without a task [2].
  double threshold = 2000;
  // Pixels of sources belong together if they are less than half of this apart, radians [2].
  double search_rad = 0.2;
  // Parts of a source from this luminance on become sources of their own, cd/m²; 0: never [2].
  double peak = 50000;
  bool corrects_low_light = true;  // lowers the DGP below Ev = 1000 lx [2]
  // Middle of a round task area in the picture, in pixels from the top left, and its opening angle.
  std::optional<Vec2> task;
  double task_rad = 0.2;
};

// A source as the eye sees it: z is the line of sight, y is up, x to the right.
struct DaylightGlareSource {
  Vec3d direction;  // of its middle, unit
  Vec2 pixel;       // its middle in the picture
  size_t pixels = 0;
  double luminance = 0;       // mean, cd/m²
  double solid_angle = 0;     // sr
  double position_index = 1;  // of its middle
  double illuminance = 0;     // at the eye, lx
};

struct DaylightGlare {
  double dgp = 0;          // 0 to 1
  double dgi = 0;          // [3], with position indices as evalglare; 0 without sources
  double ugr = 0;          // as evalglare; 0 without sources
  double vertical_lx = 0;  // Ev
  double mean_luminance = 0, background_luminance = 0;  // cd/m²
  double threshold = 0;                                 // cd/m², as used
  std::vector<DaylightGlareSource> sources;             // by falling L² ω / P²
};

// Rates a fisheye picture of 180° whose distances from the middle are proportional to the angles
// from the line of sight. The picture is square and holds luminances in cd/m² in channel r; pixels
// beyond 90° do not count. Throws UsageError for other pictures and for a task outside.
DaylightGlare daylight_glare(const Image& luminances, const GlareSettings& settings);

// The DGP of an illuminance and sources, without the correction for low light.
double daylight_glare_probability(double vertical_lx,
                                  const std::vector<DaylightGlareSource>& sources);

// Factor on the DGP for low light [2]: below 1 for Ev below 1000 lx.
double low_light_factor(double vertical_lx);

}  // namespace troffer
