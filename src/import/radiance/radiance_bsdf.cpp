#include "import/radiance/radiance_bsdf.h"

#include <charconv>
#include <cmath>
#include <filesystem>

#include "base/units.h"
#include "import/file.h"
#include "import/window_xml.h"

namespace troffer {

namespace {

constexpr uint64_t max_bsdf_bytes = uint64_t(256) << 20;

// Adds a Lambertian part, share / pi, to all pairs of patches.
void add_diffuse(AngleMatrix& m, const std::vector<double>& reals, size_t first) {
  if (reals.size() < first + 3) return;
  const float share =
      luminance(Rgb{float(reals[first]), float(reals[first + 1]), float(reals[first + 2])});
  if (!(share > 0)) return;
  if (m.is_empty()) {
    m.in = m.out = klems_full();
    m.values.assign(m.in.size() * m.out.size(), 0.0f);
  }
  for (float& v : m.values) v += share * inv_pi_f;
}

// Returns the up vector from the string arguments; vertical if it is given by functions.
Vec3d up_of(const RadianceModifier& m, size_t first, WarningLog& warnings) {
  Vec3d up;
  for (size_t k = 0; k < 3; ++k) {
    const std::string& word = m.arguments.strings[first + k];
    const auto read = std::from_chars(word.data(), word.data() + word.size(), up[k]);
    if (read.ec == std::errc() && read.ptr == word.data() + word.size() && std::isfinite(up[k]))
      continue;
    warnings.add("\"" + m.type + "\": an up vector given by functions is taken as 0 0 1");
    return {0, 0, 1};
  }
  return up;
}

std::shared_ptr<const AngularBsdf> file_of(const RadianceModifier& m, const std::string& name,
                                           const std::string& folder, WarningLog& warnings) {
  ConfinedPath path = confined_path(folder, name);
  if (!path.is_fine() || !std::filesystem::exists(path.path)) {
    const std::string beside = path_beside(folder, name);
    if (beside.empty()) {
      warnings.add("\"" + m.type + "\": cannot use '" + shortened(name) +
                   "': " + (path.is_fine() ? "there is no such file" : path.problem) +
                   ": shown diffuse grey");
      return nullptr;
    }
    path.path = beside;
  }
  return std::make_shared<const AngularBsdf>(
      read_window_xml(path.path, read_text_file(path.path, max_bsdf_bytes), warnings));
}

}  // namespace

Material radiance_bsdf(const RadianceModifier& m, const std::string& folder, WarningLog& warnings) {
  const std::vector<std::string>& strings = m.arguments.strings;
  const bool has_thickness = m.type == "BSDF";
  const size_t file = has_thickness ? 1 : 0;
  if (strings.size() < file + 5)
    m.place.fail(m.type + " needs " + std::to_string(file + 5) + " string arguments");
  if (has_thickness && strings[0].find_first_not_of("0.") != std::string::npos)
    warnings.add(
        "\"BSDF\" with a thickness: it scatters light, and does not pass views to the "
        "geometry that it stands for");
  if (strings.size() > file + 5)
    warnings.add("\"" + m.type + "\": the transform of its up vector is left out");
  Material out;
  const auto read = m.bsdf ? m.bsdf : file_of(m, strings[file], folder, warnings);
  if (!read) return out;
  AngularBsdf whole = *read;
  const std::vector<double>& reals = m.arguments.reals;
  add_diffuse(whole.front_reflection, reals, 0);
  add_diffuse(whole.back_reflection, reals, 3);
  add_diffuse(whole.to_front, reals, 6);
  add_diffuse(whole.to_back, reals, 6);
  const Vec3d up = m.world.vector(up_of(m, file + 1, warnings));
  const double l = length(up);
  out.kind = MaterialKind::angular;
  out.angular = std::make_shared<const AngularBsdf>(std::move(whole));
  out.angular_up = l > 0 && std::isfinite(l) ? Vec3(up / l) : Vec3{0, 0, 1};
  out.has_sharp_peak = !has_thickness;
  return out;
}

}  // namespace troffer
