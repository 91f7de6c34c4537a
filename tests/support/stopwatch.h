// Processor time of this process, over all its threads; independent of other load on the machine.
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
