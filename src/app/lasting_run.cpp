#include "app/lasting_run.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include "app/part_note.h"
#include "app/printable.h"
#include "app/solution_file.h"
#include "base/error.h"
#include "base/process_group.h"
#include "image/read_image.h"
#include "render/camera.h"

namespace troffer {

namespace {

namespace fs = std::filesystem;

// Returns the current contents of the --solution file; empty if there is none.
std::vector<uint8_t> bytes_of_solution(const std::string& path) {
  const SolutionKind kind = kind_of_solution(path);
  if (kind == SolutionKind::none || kind == SolutionKind::missing) return {};
  if (!fs::is_regular_file(path))
    throw UsageError("--checkpoint and --part read --solution twice, so it must be a regular file");
  return read_file_bytes(path);
}

}  // namespace

void reserve_checkpoint(const RenderCommand& c, std::vector<OutputReservation>& reserved) {
  const std::string& path = c.lasting.checkpoint;
  if (c.options.parts > 1 && needs_cells(c.options.method, c.options.indirect) &&
      kind_of_solution(c.solution) == SolutionKind::missing)
    throw UsageError("--part reads the cells of --solution but does not create the file: " +
                     c.solution + " (create it with troffer radiosity --cells)");
  if (!path.empty()) reserve_checkpoint_file(path, c.lasting.is_resumed, reserved);
}

void reserve_checkpoint_file(const std::string& path, bool is_resumed,
                             std::vector<OutputReservation>& reserved) {
  if (output_target(path).kind != OutputTarget::Kind::file)
    throw UsageError("--checkpoint must be a regular file: " + path);
  if (!is_resumed && fs::exists(path))
    throw InputError(path, 0, 0, "already exists: continue from it with --resume, or remove it");
  reserved.emplace_back(path);
  remove_abandoned_files(path);  // a killed process may have left temporary files
}

LastingRun::LastingRun(RenderCommand& command, Clock::time_point start, const StopFlag& stop)
    : command_(command), stop_(stop) {
  if (!(command.lasting.time_limit > 0)) return;
  const std::chrono::duration<double> limit(command.lasting.time_limit);
  deadline_.emplace(stop, start + std::chrono::duration_cast<Clock::duration>(limit));
  command.options.deadline = &*deadline_;
}

void LastingRun::begin(const Scene& scene, const Camera& camera) {
  RenderOptions& o = command_.options;
  const LastingOptions& l = command_.lasting;
  if (o.parts == 1 && l.checkpoint.empty() && o.group == nullptr) return;
  key_ = picture_key(TROFFER_VERSION, scene, camera, o, bytes_of_solution(command_.solution));
  if (l.checkpoint.empty()) return;
  const auto warn = [](const std::string& what) {
    fmt::print(stderr, "warning: {}: the work done is not saved\n", printable(what));
  };
  checkpoint_ = std::make_unique<Checkpoint>(l.checkpoint, key_, PictureShare{o.part, o.parts},
                                             l.checkpoint_interval, warn);
  o.checkpoint = checkpoint_.get();
  if (!l.is_resumed) return;
  if (fs::exists(l.checkpoint))
    checkpoint_->read();
  else if (!command_.is_quiet)
    fmt::print(stderr, "{} does not exist yet: starting the picture from the beginning\n",
               printable(l.checkpoint));
}

void LastingRun::agree() const {
  ProcessGroup* group = command_.options.group;
  if (group == nullptr) return;
  std::vector<uint8_t> own(key_.program.begin(), key_.program.end());
  append(own, key_.settings);
  append(own, key_.scene);
  append(own, key_.preparation);
  std::vector<uint8_t> bytes = own;
  if (!group->tell(bytes, stop())) return;  // stopped
  if (bytes != own)
    throw EnvironmentError("scene, options, --solution or program differ from those of process 0");
}

std::string LastingRun::note(const RenderResult& result, const Camera& camera) const {
  const RenderOptions& o = command_.options;
  if (o.parts == 1) return {};
  const ImageSize size = image_size(camera, o.width, o.height);
  const std::array<int, 4> all{0, 0, size.width, size.height};
  return text_of({{o.part, o.parts},
                  result.is_complete,
                  o.has_crop ? o.crop : all,
                  size.width,
                  size.height,
                  o.has_crop,
                  key_});
}

void LastingRun::finish(const RenderResult& result) const {
  if (!checkpoint_) return;
  if (!result.is_complete) {
    if (!checkpoint_->failure().empty()) throw EnvironmentError(checkpoint_->failure());
    return;
  }
  std::error_code ignored;  // a remaining checkpoint does no harm
  fs::remove(output_target(command_.lasting.checkpoint).path, ignored);
}

}  // namespace troffer
