#include "annual/light_paths.h"

namespace troffer {

std::vector<size_t> first_states(const std::vector<LightPath>& paths) {
  std::vector<size_t> first{0};
  for (const LightPath& p : paths) first.push_back(first.back() + p.states.size());
  return first;
}

}  // namespace troffer
