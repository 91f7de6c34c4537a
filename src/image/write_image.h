// Writes linear images to picture files: EXR with layers, HDR, PFM or PNG. All commands that make
// pictures use it. Values are written in the image's unit; only PNG applies exposure and tone map.
// References: [1] Ward, "Radiance File Formats", "Picture File Format (.hdr)".
//   [2] Debevec, "PFM Portable FloatMap Image Format".
#pragma once

#include <span>
#include <string>

#include "image/image.h"
#include "image/tone_map.h"

namespace troffer {

enum class ImageFormat { exr, hdr, pfm, png };

// Returns the format of a path by its extension, ignoring case. Pipes, devices and /dev/stdout with
// another extension or none get EXR. Throws UsageError for other files.
ImageFormat image_format(const std::string& path);

// Position of a cropped picture in the whole one; full_width = 0: it is the whole.
struct ImageWindow {
  int x = 0, y = 0;  // top left pixel of the picture
  int full_width = 0, full_height = 0;
};

struct WriteOptions {
  Display display{0, ToneMap::filmic};  // PNG only
  ImageWindow window{};                 // EXR only: data and display window
  int threads = 0;
  std::string note;      // EXR only: header attribute `troffer`; empty: none
  bool is_safe = false;  // flush to disk before replacing the old file (commit_to_disk)
};

// Writes one or more layers of equal size; the first is the picture.
//   .exr  scan lines, 32-bit float, ZIP; channel C of layer "" is named C, of layer L "L.C"
//   .hdr  RGBE, run lengths [1]; see rgbe.h for what the format cannot hold
//   .pfm  little endian, bottom row first [2]
//   .png  8-bit sRGB through WriteOptions::display
// Formats other than EXR store only the first layer. The bytes depend only on pixels and options.
// The file is complete or absent (AtomicFile). Throws UsageError (extension) or EnvironmentError
// (cannot write).
void write_image(const std::string& path, std::span<const Layer> layers,
                 const WriteOptions& options = {});
void write_image(const std::string& path, const Image& image, const WriteOptions& options = {});

}  // namespace troffer
