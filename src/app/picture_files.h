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

// Pictures that take the place of the command's outputs before these are there. What a failure
// leaves of them is removed.
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
  // This output itself has been written.
  void is_replaced(const std::string& path) { std::erase(written_, path); }

 private:
  const RenderCommand& command_;
  const Camera& camera_;
  std::vector<std::string> written_;
};

}  // namespace troffer
