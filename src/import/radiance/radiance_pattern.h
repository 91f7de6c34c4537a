// Radiance's patterns by functions (brightfunc, colorfunc), evaluated.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/rgb.h"
#include "base/transform.h"
#include "import/radiance/radiance_cal.h"
#include "import/radiance/radiance_text.h"

namespace troffer {

// A modifier: material, pattern, texture, mixture or alias.
struct RadianceModifier {
  std::string modifier, type;
  RadianceArguments arguments;
  SourcePlace place;
  Affine world;  // from the space of its file, which an xform may have moved
};

// The functions of a modifier. Copies are independent: one per thread.
class RadianceFunctions {
 public:
  // `count` expressions among m's string arguments from `first` on; string `file` names the
  // function file ("." = none; of the scene's `folder`, else one that comes with Radiance), which
  // options of a transform may follow. InputError at m's place, or in that file.
  RadianceFunctions(const RadianceModifier& m, size_t first, size_t count, size_t file,
                    const std::string& folder);

  // One value per expression for a ray in world space; at m's place InputError where there is none.
  // A value that is not finite (1/0, log(-1)) counts as 0.
  std::vector<double> values(const CalRay& world);
  // Whether any value so far depended on the ray.
  bool has_used_ray() const { return program_.has_used_ray(); }
  // InputError where no value so far was a finite number.
  void check() const;

 private:
  SourcePlace place_;
  CalProgram program_;
  std::vector<int32_t> expressions_;
  Affine local_from_world_;
  bool has_been_finite_ = false;
};

// The product of the patterns that a material wears.
struct RadiancePattern {
  std::vector<RadianceFunctions> functions;  // of one value, or of three

  static bool is_evaluated(const std::string& type) {
    return type == "brightfunc" || type == "colorfunc";
  }
  // InputError: as RadianceFunctions.
  void add(const RadianceModifier& m, const std::string& folder);
  Rgb value(const CalRay& world);
  // InputError: one of its functions gives no finite number in any of these directions.
  void check(const std::vector<Vec3d>& directions);
  // The same value everywhere, if it is.
  std::optional<Rgb> constant();
};

}  // namespace troffer
