#include "app/launcher.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "app/commands.h"

namespace troffer {

namespace {

namespace fs = std::filesystem;

int number_in(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? std::atoi(value) : 0;
}

// Checks for Open MPI's mpirun, and for Slurm's srun with PMI or PMIx, which gives no size. srun
// sets the latter two for any program, even for parts of a picture, which need one process each.
bool is_one_of_several(int argc, char** argv) {
  if (number_in("OMPI_COMM_WORLD_SIZE") > 0) return number_in("OMPI_COMM_WORLD_SIZE") > 1;
  for (int i = 2; i < argc; ++i)
    if (std::strncmp(argv[i], "--part", 6) == 0) return false;
  const bool speaks_pmix = std::getenv("PMIX_RANK") != nullptr;
  return number_in("PMI_SIZE") > 1 || (speaks_pmix && number_in("SLURM_STEP_NUM_TASKS") > 1);
}

}  // namespace

int hand_over_to_mpi(int argc, char** argv) {
  if (argc < 2 || std::strcmp(argv[1], "render") != 0 || !is_one_of_several(argc, argv)) return 0;
  std::error_code error;
  const fs::path other = fs::read_symlink("/proc/self/exe", error).parent_path() / "troffer-mpi";
  execv(other.c_str(), argv);
  const bool is_first =
      number_in("OMPI_COMM_WORLD_RANK") + number_in("PMI_RANK") + number_in("PMIX_RANK") == 0;
  if (is_first)
    fmt::print(stderr,
               "error: mpirun has started this program several times, but it was built without "
               "MPI: there is no {} (--part splits a picture without MPI)\n",
               other.string());
  return exit_usage;
}

}  // namespace troffer
