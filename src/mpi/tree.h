// The binomial tree along which news goes from rank 0 to all.
#pragma once

#include <vector>

namespace troffer {

// Of a process, the farthest first: those have most to pass on.
inline std::vector<int> children_of(int rank, int size) {
  std::vector<int> children;
  int step = 1;
  while (step <= rank) step *= 2;
  for (; step < size - rank; step *= 2) children.insert(children.begin(), rank + step);
  return children;
}

}  // namespace troffer
