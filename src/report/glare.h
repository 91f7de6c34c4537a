// Discomfort glare from luminaires: the Unified Glare Rating.
//
//   UGR = 8 log10(0.25 / Lb · Σ L² ω / p²)                                            [1, Eq. 1]
//
// Lb: background luminance, cd/m²: the vertical illuminance at the eye without light straight from
// luminaires, over pi. L: mean luminance of a luminaire's visible luminous parts, cd/m²; ω: their
// solid angle, sr; p: position index. assess() rates each observer with it.
//
// References: [1] CIE 117, "Discomfort Glare in Interior Lighting", 1995. [2] CIE 147, "Glare from
//   Small, Large and Complex Sources", 2002. [3] Guth's position index as a formula: IES Lighting
//   Handbook, "Quality of the Visual Environment". [4] Iwata & Tokura, "Position index for a glare
//   source located below the line of vision", Lighting Research & Technology 29(3), 1997; so too
//   Wienold & Christoffersen, Energy and Buildings 38(7), 2006.
#pragma once

#include <cstdint>
#include <vector>

#include "report/statistics.h"
#include "transport/prepared_scene.h"

namespace troffer {

// An eye and its line of sight.
struct Observer {
  Vec3d position;   // position of the eye, in the file's coordinates, m
  Vec3d direction;  // line of sight, unit length
};

// Returns Guth's position index of the direction `towards` (any length). At and above the line of
// sight it follows [3], which CIE 117 tabulates; below it follows [4]. Infinite outside of CIE
// 117's table: over 1.9 times as high above the line of sight, or over 3 times as far beside it, as
// the source is ahead.
double position_index(const Vec3d& towards, const Vec3d& line_of_sight, const Vec3d& up);

// The same for any direction ahead, at most 16, as evalglare has it (report/daylight_glare.h). It
// equals position_index() above the line of sight, and straight below it. z of the direction is the
// line of sight, y is up.
double wide_position_index(const Vec3d& direction);

// A luminaire as an observer sees it: lights of one name whose surfaces share corners.
struct SeenLuminaire {
  std::string name;
  double luminance = 0;       // mean of the visible part, cd/m²; 0 for a point
  double solid_angle = 0;     // sr
  double position_index = 0;  // position index of the middle of the visible part
  Figure term;                // L² ω / p², cd²/m⁴ sr
  // True if less than .005 m² are visible: [2] rates it as if it had that area.
  bool is_small = false;
};

// Returns the luminaires that an observer sees, by falling glare. Shadow rays account for occluders
// and glass. Each luminaire gets `samples` rays, or 4 for each of its pieces if that is more.
std::vector<SeenLuminaire> seen_luminaires(const PreparedScene& scene, const Observer& observer,
                                           const Vec3d& up, uint64_t seed, int samples = 256);

// Rating of one observer.
struct Glare {
  Observer observer;
  Figure background;  // Lb, cd/m²
  // Valid only if is_defined: a luminaire is visible, and the background is brighter than its
  // error.
  Figure ugr;
  bool is_defined = false;
  bool is_large = false;  // true if a luminaire exceeds .1 sr: CIE 117 does not apply
  std::vector<SeenLuminaire> luminaires;
};

// Returns the rating. indirect: vertical illuminance at the eye, facing along the line of sight,
// without light straight from luminaires, lx.
Glare glare_of(const Observer& observer, const Figure& indirect,
               std::vector<SeenLuminaire> luminaires);

}  // namespace troffer
