#include "app/annual_lasting.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "app/lasting_options.h"
#include "app/lasting_run.h"
#include "app/option_values.h"
#include "app/printable.h"
#include "app/process.h"
#include "app/progress.h"
#include "base/error.h"

namespace troffer {

void add_annual_lasting(CLI::App& app, AnnualLasting& l) {
  app.add_option("--checkpoint", l.checkpoint,
                 "File to save finished reflected light, at intervals and when interrupted");
  app.add_option("--checkpoint-interval", l.interval, "Seconds between checkpoints")
      ->check(number_between(0.001, 1e9))
      ->capture_default_str();
  app.add_flag("--resume", l.is_resumed, "Continue from --checkpoint, if the file exists");
  app.add_option("--part", l.part,
                 "Compute only part K of N of the reflected light and keep it in --checkpoint, for "
                 "--join");
  app.add_option("--join", l.joined, "Checkpoint of a part, to start from; may be repeated")
      ->allow_extra_args(false);
}

AnnualStore::AnnualStore(const AnnualLasting& lasting, OutputGuard& guard) : lasting_(lasting) {
  if (lasting.is_part()) {
    parse_part(lasting.part, part_, parts_);
    if (lasting.checkpoint.empty()) throw UsageError("--part needs --checkpoint FILE");
  }
  if (lasting.is_resumed && lasting.checkpoint.empty())
    throw UsageError("--resume needs --checkpoint FILE");
  for (const std::string& file : lasting.joined) guard.add_input("--join", file);
  if (lasting.checkpoint.empty()) return;
  guard.add_output("--checkpoint", lasting.checkpoint);
  reserve_checkpoint_file(lasting.checkpoint, lasting.is_resumed, reserved_);
}

void AnnualStore::begin(AnnualRequest& request, const AnnualOptions& options, bool is_quiet) {
  if (lasting_.checkpoint.empty() && lasting_.joined.empty()) return;
  const PictureKey key = key_of_store(TROFFER_VERSION, request, options);
  store_ = std::make_unique<ReflectedStore>(part_, parts_);
  for (const std::string& file : lasting_.joined) store_->read(file, key);
  if (!lasting_.checkpoint.empty()) {
    if (lasting_.is_resumed && std::filesystem::exists(lasting_.checkpoint))
      store_->read(lasting_.checkpoint, key);
    else if (lasting_.is_resumed && !is_quiet)
      fmt::print(stderr, "{} does not exist yet: starting from the beginning\n",
                 printable(lasting_.checkpoint));
    store_->save_to(lasting_.checkpoint, key, lasting_.interval, [](const std::string& what) {
      fmt::print(stderr, "warning: {}: the work done is not saved\n", printable(what));
    });
  }
  request.store = store_.get();
}

int AnnualStore::run_part(const AnnualRequest& request, const AnnualOptions& options, bool is_quiet,
                          const StopFlag& stop) {
  ProgressBar bar("annual", is_quiet);
  const bool is_complete = compute_reflected_share(
      request, options, [&](double f) { bar.update(f); }, stop);
  if (!is_complete) return end_early();
  if (const std::string failure = store_->save(); !failure.empty()) throw EnvironmentError(failure);
  if (!is_quiet)
    fmt::print(stderr, "part {} of {} is in {}\n", part_, parts_, printable(lasting_.checkpoint));
  return exit_done;
}

int AnnualStore::end_early() {
  if (lasting_.checkpoint.empty()) {
    fmt::print(stderr, "interrupted: nothing was written\n");
    return exit_interrupted;
  }
  if (const std::string failure = store_->save(); !failure.empty()) throw EnvironmentError(failure);
  fmt::print(stderr, "interrupted: finished work is in {}; --resume continues\n",
             printable(lasting_.checkpoint));
  return exit_interrupted;
}

void AnnualStore::remove() const {
  if (lasting_.checkpoint.empty()) return;
  std::error_code ignored;  // a remaining checkpoint does no harm
  std::filesystem::remove(output_target(lasting_.checkpoint).path, ignored);
}

}  // namespace troffer
