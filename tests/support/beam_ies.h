// A photometric file (IES) of type A or B.
#pragma once

#include <string>
#include <vector>

namespace troffer::test {

// Returns a file of type A (3) or B (2), with the value 1000 + 10 × horizontal + vertical angle.
inline std::string beam_ies(int type, const std::vector<int>& vertical,
                            const std::vector<int>& horizontal) {
  std::string text = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 " + std::to_string(vertical.size()) +
                     " " + std::to_string(horizontal.size()) + " " + std::to_string(type) +
                     " 2 0 0 0 1 1 10\n";
  for (const auto* angles : {&vertical, &horizontal}) {
    for (const int a : *angles) text += std::to_string(a) + " ";
    text += "\n";
  }
  for (const int h : horizontal)
    for (const int v : vertical) text += std::to_string(1000 + 10 * h + v) + "\n";
  return text;
}

}  // namespace troffer::test
