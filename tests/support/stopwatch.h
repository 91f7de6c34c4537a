// Time that this process worked, all of its threads together: a busy machine changes nothing.
#pragma once

#include <ctime>

namespace troffer::test {

class ProcessorStopwatch {
 public:
  double seconds() const { return double(std::clock() - start_) / CLOCKS_PER_SEC; }

 private:
  std::clock_t start_ = std::clock();
};

}  // namespace troffer::test
