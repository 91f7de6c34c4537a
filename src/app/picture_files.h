// Writes the picture files of `render`, and previews in their place during the rendering.
#pragma once

#include <string>
#include <vector>

#include "app/commands.h"
#include "image/write_image.h"

namespace troffer {

// Returns how the command's options want a picture written. is_quiet: print nothing about its
// exposure.
WriteOptions write_options(const RenderCommand& command, const Camera& camera, const Image& picture,
                           bool is_quiet);

// Warns, unless the command is quiet, if no output can hold the layers of --aov; only .exr can.
void warn_of_layers(const RenderCommand& command);

// Previews that stand in for the command's outputs until these are written. An existing file stays,
// and its preview goes next to it. The destructor removes remaining previews.
class PreviewFiles {
 public:
  // Command and camera must outlive this.
  PreviewFiles(const RenderCommand& command, const Camera& camera)
      : command_(command), camera_(camera) {}
  ~PreviewFiles();
  PreviewFiles(const PreviewFiles&) = delete;
  PreviewFiles& operator=(const PreviewFiles&) = delete;

  // Writes previews of the outputs that are plain files. Pipes and devices get only the final
  // picture.
  void write(const Image& picture);
  // Call after the output `path` has been written: removes a preview next to it.
  void is_finished(const std::string& path);
  // Returns the file for an unfinished picture of the output `path`: its preview, or
  // place_for_unfinished(). The file no longer counts as a preview.
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
