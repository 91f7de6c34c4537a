// Linear images -> picture files.
// References: [1] Ward, "Radiance File Formats", "Picture File Format (.hdr)".
//   [2] Debevec, "PFM Portable FloatMap Image Format".
#pragma once

#include <span>
#include <string>

#include "image/image.h"
#include "image/tone_map.h"

namespace troffer {

enum class ImageFormat { exr, hdr, pfm, png };

// The format that a path's ending stands for, in any case of letters; EXR for pipes, devices and
// /dev/stdout with another ending or none. UsageError for other files.
ImageFormat image_format(const std::string& path);

// Where a cropped picture lies in the whole one; full_width = 0 means that it is the whole.
struct ImageWindow {
  int x = 0, y = 0;  // of the picture's top left pixel
  int full_width = 0, full_height = 0;
};

struct WriteOptions {
  Display display{0, ToneMap::filmic};  // PNG only
  ImageWindow window{};                 // EXR only: data and display window
  int threads = 0;
  std::string note;      // EXR only: kept in the header as the attribute `troffer`; empty: none
  bool is_safe = false;  // the disk has it before the old file goes (AtomicFile::commit_to_disk)
};

// Writes layers of equal size, at least one; the first is the picture.
//   .exr  scan lines, 32-bit float, ZIP; channel C of layer "" is named C, of layer L "L.C"
//   .hdr  RGBE, run lengths [1]; see rgbe.h for what the format cannot hold
//   .pfm  little endian, bottom row first [2]
//   .png  8-bit sRGB through WriteOptions::display
// All but EXR hold the first layer only. The bytes depend on the pixels and options alone. The file
// is whole or absent (AtomicFile). Errors: UsageError (ending), EnvironmentError (cannot write).
void write_image(const std::string& path, std::span<const Layer> layers,
                 const WriteOptions& options = {});
void write_image(const std::string& path, const Image& image, const WriteOptions& options = {});

}  // namespace troffer
