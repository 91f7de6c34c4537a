// What shared work took, written down job by job, so that it can be told what more processes would
// gain (experiments/mpi).
#pragma once

#include <cstddef>
#include <fstream>
#include <string>
#include <vector>

namespace troffer {

// Of the calling thread, of the processor: other programs on the machine do not count.
double thread_seconds();

// Seconds are the processor's but for wall_seconds.
struct JobRecord {
  size_t items = 0;
  bool is_for_all = false;
  double seconds_before = 0;  // since the last job, of the thread that calls for work
  double wall_seconds = 0;
  // Rank 0's, for letters.
  double message_seconds = 0;
  size_t messages = 0;
  size_t brief_bytes = 0, answer_bytes = 0;  // sent with leases and answers
  size_t sent_bytes = 0;                     // to all, once it was over
  std::vector<float> item_seconds;           // of each item, by whoever did it first
};

class Journal {
 public:
  // Throws EnvironmentError where the file cannot be written.
  explicit Journal(const std::string& file);
  // One line of JSON.
  void add(const JobRecord& job);

 private:
  std::ofstream out_;
};

}  // namespace troffer
