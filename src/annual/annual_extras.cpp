#include "annual/annual_extras.h"

namespace troffer {

std::string glare_level(const EyeYear& eye) {
  for (size_t k = 0; k < glare_limits.size(); ++k)
    if (eye.shares[k] <= most_glare_share) return glare_limits[k].level;
  return "none";
}

}  // namespace troffer
