// Discomfort glare from luminaires: the Unified Glare Rating.
//
//   UGR = 8 log10(0.25 / Lb · Σ L² ω / p²)                                            [1, Eq. 1]
//
// Lb: background luminance, cd/m²: what of the vertical illuminance at the eye does not come
// straight from luminaires, over pi. L: mean luminance of a luminaire's luminous parts as seen from
// the eye, cd/m²; ω: their solid angle, sr; p: position index.
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

struct Observer {
  Vec3d position;   // of the eye, in the file's coordinates, m
  Vec3d direction;  // of the line of sight, unit
};

// Guth's position index of what lies in the direction `towards` (any length): at and above the line
// of sight [3], which CIE 117 has as a table, below it [4]. Infinite where CIE 117's table ends: a
// source counts that lies up to 1.9 times as high above the line of sight, and up to 3 times as far
// beside it, as it is ahead.
double position_index(const Vec3d& towards, const Vec3d& line_of_sight, const Vec3d& up);

// A luminaire as an observer sees it: lights of one name whose surfaces share corners.
struct SeenLuminaire {
  std::string name;
  double luminance = 0;       // cd/m², mean of what is seen of it; 0: a point
  double solid_angle = 0;     // sr
  double position_index = 0;  // of the middle of what is seen of it
  Figure term;                // L² ω / p², cd²/m⁴ sr
  // Less than .005 m² of it are seen: [2] has it glare as if it were so large.
  bool is_small = false;
};

// The luminaires that an observer sees from there, the one that glares most first. What hides them
// and glass before them are seen to by rays: `samples` to a luminaire, or 4 to each of its pieces,
// if that is more.
std::vector<SeenLuminaire> seen_luminaires(const PreparedScene& scene, const Observer& observer,
                                           const Vec3d& up, uint64_t seed, int samples = 256);

struct Glare {
  Observer observer;
  Figure background;  // Lb, cd/m²
  // 0 and without meaning where !is_defined: no luminaire is seen, or nothing but luminaires is.
  Figure ugr;
  bool is_defined = false;
  bool is_large = false;  // a luminaire takes more than .1 sr: CIE 117 does not hold
  std::vector<SeenLuminaire> luminaires;
};

// indirect: vertical illuminance at the eye, facing the line of sight, but for what comes straight
// from luminaires, lx.
Glare glare_of(const Observer& observer, const Figure& indirect,
               std::vector<SeenLuminaire> luminaires);

}  // namespace troffer
