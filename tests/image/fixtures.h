// Small pictures encoded with the formats' own libraries, and temporary folders.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "base/random.h"
#include "base/vec.h"
#include "image/image.h"
#include "image/raster.h"

namespace troffer::test {

struct PngFixture {
  int width = 1, height = 1;
  int colour_type = 2, depth = 8;  // as in IHDR
  bool is_interlaced = false;
  std::vector<std::vector<uint8_t>> rows;  // packed as in the file
  std::vector<uint8_t> palette_rgb, palette_alpha;
  double gamma = 0;  // 0: no gAMA chunk
  bool is_marked_srgb = false;
  std::vector<uint8_t> profile = {};
};
std::vector<uint8_t> make_png(const PngFixture& fixture);

// `components` per pixel: 1 grey, 3 rgb, 4 CMYK as stored (Adobe marker: inverted ink).
std::vector<uint8_t> make_jpeg(int width, int height, int components,
                               const std::vector<uint8_t>& samples, bool is_progressive = false,
                               const std::vector<uint8_t>& profile = {});

// Returns an ICC profile by matrix and power. Columns are X, Y, Z (D50) of red, green and blue;
// light is the encoded value to this power. Grey profiles have only the power.
std::vector<uint8_t> make_rgb_profile(const std::array<Vec3d, 3>& colorants, double power);
std::vector<uint8_t> make_grey_profile(double power);

// Returns a picture of random values in [0, 4), determined by the seed.
Image random_image(int width, int height, uint64_t seed);

// A new empty folder, removed with its contents.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  size_t entries() const;

 private:
  std::filesystem::path folder_;
};

}  // namespace troffer::test
