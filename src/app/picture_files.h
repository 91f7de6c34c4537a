// The picture files of `render`, and what stands in their place while it is under way.
#pragma once

#include <string>
#include <vector>

#include "app/commands.h"
#include "image/write_image.h"

namespace troffer {

// How the command wants a picture written, of all that it asks for. is_quiet: without a word about
// its exposure.
WriteOptions write_options(const RenderCommand& command, const Camera& camera, const Image& picture,
                           bool is_quiet);

// Says, unless the command is quiet, that no output can hold the layers of --aov: .exr alone can.
void warn_of_layers(const RenderCommand& command);

// Pictures that take the place of the command's outputs before these are there. A file that stood
// there before stays, and its previews go beside it. What a failure leaves of previews is removed.
class PreviewFiles {
 public:
  // Both must outlive this.
  PreviewFiles(const RenderCommand& command, const Camera& camera)
      : command_(command), camera_(camera) {}
  ~PreviewFiles();
  PreviewFiles(const PreviewFiles&) = delete;
  PreviewFiles& operator=(const PreviewFiles&) = delete;

  // Writes the outputs that are plain files; what takes what is written as it comes (pipes,
  // devices) gets the last picture alone.
  void write(const Image& picture);
  // The output `path` itself has been written: a preview beside it goes.
  void is_finished(const std::string& path);
  // Where an unfinished picture for the output `path` goes: to its preview, or else by
  // place_for_unfinished(). It is no preview any more.
  std::string take_place(const std::string& path, bool is_kept);

 private:
  struct Shown {
    std::string output, file;
  };
  std::string file_for(const std::string& output);

  const RenderCommand& command_;
  const Camera& camera_;
  std::vector<Shown> shown_;
};

}  // namespace troffer
