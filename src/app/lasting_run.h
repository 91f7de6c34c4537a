// What stands behind --time-limit, --checkpoint, --resume and --part while a picture is made.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/process.h"
#include "base/deadline.h"
#include "image/atomic_file.h"
#include "render/checkpoint.h"

namespace troffer {

// Before any work: makes sure that the checkpoint can be written, and that none is lost. Throws
// UsageError, InputError, EnvironmentError.
void reserve_checkpoint(const RenderCommand& command, std::vector<OutputReservation>& reserved);

class LastingRun {
 public:
  // start: of the program; stop: set by signals. Both the command and stop must outlive this.
  LastingRun(RenderCommand& command, Clock::time_point start, const StopFlag& stop);

  // Set by signals, and when time is over.
  const StopFlag& stop() const { return deadline_ ? deadline_->flag() : stop_; }
  // Once all else of the command's options is settled: sets what they have of all this. Reads the
  // checkpoint: InputError where it cannot be gone on from.
  void begin(const Scene& scene, const Camera& camera);
  // Makes sure that all of RenderOptions::crew make the same picture: EnvironmentError where this
  // process would make another than rank 0.
  void agree() const;
  // For the file of a share; empty where it is all of the picture.
  std::string note(const RenderResult& result, const Camera& camera) const;
  // Outputs are written: a checkpoint of a whole picture goes. Throws EnvironmentError where there
  // should be one, and it could not be written.
  void finish(const RenderResult& result) const;

 private:
  RenderCommand& command_;
  const StopFlag& stop_;
  std::optional<Deadline> deadline_;
  PictureKey key_;
  std::unique_ptr<Checkpoint> checkpoint_;
};

}  // namespace troffer
