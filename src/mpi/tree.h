// Binomial tree along which rank 0 sends results to all processes. Leader and Follower forward
// result messages to their children. A message reaches all n processes after about log2(n) steps.
#pragma once

#include <vector>

namespace troffer {

// Returns the children of a process, those with the most descendants first.
inline std::vector<int> children_of(int rank, int size) {
  std::vector<int> children;
  int step = 1;
  while (step <= rank) step *= 2;
  for (; step < size - rank; step *= 2) children.insert(children.begin(), rank + step);
  return children;
}

}  // namespace troffer
