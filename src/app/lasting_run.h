// Implements --time-limit, --checkpoint, --resume and --part during a rendering.
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

// Checks before any work that the checkpoint can be written and does not replace another one.
// Throws UsageError, InputError, EnvironmentError.
void reserve_checkpoint(const RenderCommand& command, std::vector<OutputReservation>& reserved);
// The same for the file alone.
void reserve_checkpoint_file(const std::string& path, bool is_resumed,
                             std::vector<OutputReservation>& reserved);

// A rendering with a time limit, a checkpoint, or as one part of a picture.
class LastingRun {
 public:
  // start: of the program; stop: set by signals. The command and `stop` must outlive this.
  LastingRun(RenderCommand& command, Clock::time_point start, const StopFlag& stop);

  // Set by signals, and at the time limit.
  const StopFlag& stop() const { return deadline_ ? deadline_->flag() : stop_; }
  // Completes the command's options; call it when all others are final. Reads the checkpoint, and
  // throws InputError if it does not fit.
  void begin(const Scene& scene, const Camera& camera);
  // Verifies that all processes of the group render the same picture. Throws EnvironmentError if
  // this one differs from rank 0.
  void agree() const;
  // Returns the note for the file of a part; empty for a whole picture.
  std::string note(const RenderResult& result, const Camera& camera) const;
  // Call after the outputs are written. Removes the checkpoint of a finished picture. Throws
  // EnvironmentError if a checkpoint should exist but could not be written.
  void finish(const RenderResult& result) const;

 private:
  RenderCommand& command_;
  const StopFlag& stop_;
  std::optional<Deadline> deadline_;
  PictureKey key_;
  std::unique_ptr<Checkpoint> checkpoint_;
};

}  // namespace troffer
