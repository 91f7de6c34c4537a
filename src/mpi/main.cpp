// troffer-mpi: the program as one of several processes that render a picture together.
#include <fmt/format.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "app/commands.h"
#include "base/error.h"
#include "mpi/follower.h"
#include "mpi/job_log.h"
#include "mpi/leader.h"
#include "mpi/mpi_post.h"

namespace {

constexpr double patience = 120;  // seconds without a message from rank 0

[[noreturn]] void exit_leader_is_silent() {
  fmt::print(stderr, "error: no message from process 0 for {} s\n", patience);
  _exit(troffer::exit_bad_input);
}

// True if another MPI started several processes, each of which would believe it is alone.
bool has_other_launcher() {
  const char* size = std::getenv("PMI_SIZE");
  return size != nullptr && std::atoi(size) > 1;
}

int run_alone(int argc, char** argv) {
  if (!has_other_launcher()) return troffer::run(argc, argv, nullptr);
  fmt::print(stderr,
             "error: started by the launcher of a different MPI than the one this program was "
             "built with\n");
  return troffer::exit_usage;
}

// Returns a thread count with which all processes on this machine share its cores. Assumes that
// each process is bound to the same number of cores, either all disjoint or all the same.
int default_threads() {
  cpu_set_t own;
  CPU_ZERO(&own);
  if (sched_getaffinity(0, sizeof(own), &own) != 0) return 1;
  const char* size = std::getenv("OMPI_COMM_WORLD_LOCAL_SIZE");
  const int here = size != nullptr ? std::max(1, std::atoi(size)) : 1;
  const int cores = int(std::max(1L, sysconf(_SC_NPROCESSORS_ONLN))), mine = CPU_COUNT(&own);
  const int sharing = std::max(1, (here * mine + cores - 1) / cores);
  return std::max(1, mine / sharing);
}

int run_together(troffer::MpiPost& post, int argc, char** argv) {
  const int threads = default_threads();
  std::unique_ptr<troffer::ProcessGroup> group;
  if (post.rank() == 0) {
    const char* file = std::getenv("TROFFER_MPI_JOURNAL");
    const auto warn = [](const std::string& what) { fmt::print(stderr, "warning: {}\n", what); };
    group = std::make_unique<troffer::Leader>(
        post, threads, warn, file != nullptr ? std::make_unique<troffer::JobLog>(file) : nullptr);
  } else {
    group = std::make_unique<troffer::Follower>(post, threads, patience, exit_leader_is_silent);
  }
  const int status = troffer::run(argc, argv, group.get());
  group.reset();
  post.close(status);
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    troffer::MpiPost post(argc, argv);
    return post.size() == 1 ? run_alone(argc, argv) : run_together(post, argc, argv);
  } catch (const std::exception& e) {
    fmt::print(stderr, "error: {}\n", e.what());
    return troffer::exit_bad_input;
  }
}
