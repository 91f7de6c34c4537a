#include "app/outputs.h"

namespace troffer {

std::vector<OutputReservation> reserve_outputs(const std::vector<std::string>& outputs,
                                               const std::string& stats) {
  std::vector<OutputReservation> reserved;
  for (const std::string& path : outputs) reserved.emplace_back(path);
  if (!stats.empty()) reserved.emplace_back(stats);
  return reserved;
}

void reserve_cells(const std::string& path, const Method& method, Indirect indirect,
                   std::vector<OutputReservation>& reserved) {
  if (!path.empty() && needs_cells(method, indirect)) reserved.emplace_back(path);
}

}  // namespace troffer
