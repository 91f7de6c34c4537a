#include "mpi/job_log.h"

#include <fmt/format.h>
#include <time.h>

#include "base/error.h"

namespace troffer {

double thread_seconds() {
  timespec t = {};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

JobLog::JobLog(const std::string& file) : out_(file) {
  if (!out_) throw EnvironmentError("cannot write " + file);
}

void JobLog::add(const JobRecord& j) {
  std::string seconds;
  for (const float s : j.item_seconds)
    seconds += fmt::format("{}{:.3g}", seconds.empty() ? "" : ",", double(s));
  out_ << fmt::format(
      "{{\"items\":{},\"for_all\":{},\"before\":{:.4g},\"wall\":{:.4g},\"messages\":{},"
      "\"message_seconds\":{:.4g},\"brief_bytes\":{},\"answer_bytes\":{},\"sent_bytes\":{},"
      "\"seconds\":[{}]}}\n",
      j.items, j.is_for_all, j.seconds_before, j.wall_seconds, j.messages, j.message_seconds,
      j.brief_bytes, j.answer_bytes, j.sent_bytes, seconds);
  out_.flush();
}

}  // namespace troffer
