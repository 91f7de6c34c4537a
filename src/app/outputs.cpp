#include "app/outputs.h"

namespace troffer {

std::vector<OutputReservation> reserve_outputs(const std::vector<std::string>& outputs,
                                               const std::string& stats) {
  std::vector<OutputReservation> reserved;
  for (const std::string& path : outputs) reserved.emplace_back(path);
  if (!stats.empty()) reserved.emplace_back(stats);
  return reserved;
}

}  // namespace troffer
