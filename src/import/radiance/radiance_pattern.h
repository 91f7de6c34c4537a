// Evaluates Radiance's patterns by functions (brightfunc, colorfunc). Used by RadianceMaterials and
// for sky lights.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/rgb.h"
#include "base/transform.h"
#include "import/radiance/radiance_cal.h"
#include "import/radiance/radiance_text.h"
#include "scene/angular_bsdf.h"

namespace troffer {

// A modifier: material, pattern, texture, mixture or alias.
struct RadianceModifier {
  std::string modifier, type;
  RadianceArguments arguments;
  SourcePlace place;
  Affine world;  // from the space of its file, which an xform may have transformed
  // Matrices of a BSDF that does not name a file; null: it names one.
  std::shared_ptr<const AngularBsdf> bsdf;
};

// The functions of a modifier. Evaluation changes the object: use one copy per thread.
class RadianceFunctions {
 public:
  // Takes `count` expressions from m's string arguments, from number `first` on. String number
  // `file` names the function file; "." means none. It is looked up in the scene's `folder`, then
  // among Radiance's own. Options of a transform may follow it. Throws InputError at m's place or
  // in that file.
  RadianceFunctions(const RadianceModifier& m, size_t first, size_t count, size_t file,
                    const std::string& folder);

  // Returns one value per expression, for a ray in world space. A value that is not finite (1/0,
  // log(-1)) counts as 0. Throws InputError, at m's place, if an expression has no value.
  std::vector<double> values(const CalRay& world);
  // True if any value so far depended on the ray.
  bool has_used_ray() const { return program_.has_used_ray(); }
  // Throws InputError if no value so far was finite.
  void check() const;

 private:
  SourcePlace place_;
  CalProgram program_;
  std::vector<int32_t> expressions_;
  Affine local_from_world_;
  bool has_been_finite_ = false;
};

// Product of a material's patterns.
struct RadiancePattern {
  std::vector<RadianceFunctions> functions;  // functions of one or three values each

  static bool is_evaluated(const std::string& type) {
    return type == "brightfunc" || type == "colorfunc";
  }
  // Adds a pattern. Throws InputError as RadianceFunctions does.
  void add(const RadianceModifier& m, const std::string& folder);
  Rgb value(const CalRay& world);
  // Throws InputError if a function has no finite value in any of these directions.
  void check(const std::vector<Vec3d>& directions);
  // Returns the value if it is the same everywhere.
  std::optional<Rgb> constant();
};

}  // namespace troffer
