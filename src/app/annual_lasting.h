// --checkpoint, --resume, --part and --join of `troffer annual`. Finished reflected light is kept
// (annual/reflected_store.h); the rest of the calculation follows from it quickly.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "annual/annual.h"
#include "app/output_guard.h"
#include "image/atomic_file.h"

namespace CLI {
class App;
}

namespace troffer {

// Values as typed.
struct AnnualLasting {
  std::string checkpoint;  // file, or empty
  double interval = 60;    // seconds
  bool is_resumed = false;
  std::string part;                 // K/N, or empty
  std::vector<std::string> joined;  // checkpoints of parts

  bool is_part() const { return !part.empty(); }
};

void add_annual_lasting(CLI::App& app, AnnualLasting& lasting);  // adds its options

// The store of one run.
class AnnualStore {
 public:
  // Checks before any work that the checkpoint can be written. Throws UsageError, InputError,
  // EnvironmentError. The options must outlive this.
  AnnualStore(const AnnualLasting& lasting, OutputGuard& guard);

  // Reads checkpoints. Sets AnnualRequest::store if anything is to be kept or read.
  void begin(AnnualRequest& request, const AnnualOptions& options, bool is_quiet);
  // Computes this part's share and writes it. Returns the exit status.
  int run_part(const AnnualRequest& request, const AnnualOptions& options, bool is_quiet,
               const StopFlag& stop);
  // Writes the checkpoint after a stop, and says where the work is. Returns the exit status.
  int end_early();
  // Removes the checkpoint of a finished year.
  void remove() const;

 private:
  const AnnualLasting& lasting_;
  int part_ = 1, parts_ = 1;
  std::vector<OutputReservation> reserved_;
  std::unique_ptr<ReflectedStore> store_;
};

}  // namespace troffer
