// Log of the cost of shared work per job, one line of JSON each, to predict the gain of more
// processes (experiments/mpi). Rank 0 writes it if TROFFER_MPI_JOURNAL names a file. Times are in
// seconds, sizes in bytes.
#pragma once

#include <cstddef>
#include <fstream>
#include <string>
#include <vector>

namespace troffer {

// Returns the processor time of the calling thread in seconds. Other programs on the machine do not
// affect it.
double thread_seconds();

// Cost of one job. Times are processor seconds, except wall_seconds.
struct JobRecord {
  size_t items = 0;
  bool is_for_all = false;
  double seconds_before = 0;  // time of the calling thread since the last job
  double wall_seconds = 0;
  // Rank 0's time for messages.
  double message_seconds = 0;
  size_t messages = 0;
  size_t brief_bytes = 0, answer_bytes = 0;  // sent with leases and answers
  size_t sent_bytes = 0;                     // sent to all processes after the job
  std::vector<float> item_seconds;           // per item, of the first process that did it
};

class JobLog {
 public:
  // Throws EnvironmentError if the file cannot be written.
  explicit JobLog(const std::string& file);
  // Writes one line of JSON.
  void add(const JobRecord& job);

 private:
  std::ofstream out_;
};

}  // namespace troffer
