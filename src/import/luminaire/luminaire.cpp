#include "import/luminaire/luminaire.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "import/file.h"
#include "import/luminaire/luminaire_formats.h"
#include "import/text_lines.h"

namespace troffer {

namespace {

constexpr double least_candela = 1e-12;

}  // namespace

void clean_intensities(Planes& planes, const PhotometricText& text, const std::string& path,
                       WarningLog& warnings) {
  size_t negative = 0;
  bool is_dark = true;
  for (double& c : planes.candela) {
    negative += c < 0 ? 1 : 0;
    c = std::max(c, 0.0);
    is_dark = is_dark && c < least_candela;
  }
  if (is_dark) text.fail("no intensity is above 0");
  if (negative > 0)
    warnings.add(fmt::format("{}: {} intensities below 0 are read as 0", path, negative));
  if (text.has_met_decimal_commas()) warnings.add(path + ": decimal commas are read as points");
}

Luminaire read_luminaire(const std::string& path, WarningLog& warnings) {
  std::string text = read_text_file(path, max_luminaire_bytes);
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) text = as_utf8(text);
  return lower_case_ending(path) == "ldt" ? read_ldt(path, text, warnings)
                                          : read_ies(path, text, folder_of(path), warnings);
}

Luminaire read_luminaire_text(const std::string& name, std::string_view text,
                              WarningLog& warnings) {
  return read_ies(name, text, "", warnings);
}

double tilt_factor(const Luminaire& luminaire, double tilt_deg) {
  const std::vector<double>&angles = luminaire.tilt.angles_deg, &factors = luminaire.tilt.factors;
  if (angles.empty()) return 1;
  const auto above = std::upper_bound(angles.begin(), angles.end(), tilt_deg);
  if (above == angles.begin()) return factors.front();
  if (above == angles.end()) return factors.back();
  const auto i = size_t(above - angles.begin());
  const double t = (tilt_deg - angles[i - 1]) / (angles[i] - angles[i - 1]);
  return std::lerp(factors[i - 1], factors[i], t);
}

}  // namespace troffer
