// Irradiance gathered for a picture, before it is made: one ray through the middle of every pixel,
// to the matte surfaces that it sees, straight, in mirrors and through glass; 8 gather rays from
// each, as many more as the asked error needs, and a linear fit over what neighbours gathered that
// lie on the same surface. Viewing rays look the result up (docs/cells.md).
//
// What a pixel gets depends on the pixels around it, not on tiles, threads or the window.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "base/process_group.h"
#include "gather/cells.h"

namespace troffer {

// Pixels x0 … x1 - 1, y0 … y1 - 1.
struct PixelWindow {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  bool has(int x, int y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
};

// The picture for which light is gathered.
struct PictureView {
  PixelWindow image, window;                 // the whole picture, and what is made of it
  std::function<Ray(float x, float y)> ray;  // through a point of the picture
};

struct GatherOptions {
  double error = 0.01;  // of a pixel's light
  double typical = 0;   // luminance of indirect light in the picture
  int threads = 0;
  uint64_t seed = 0;
  ProcessGroup* group = nullptr;  // others that make the same picture; may be null
};

// What rays bring, over them.
struct GatherSums {
  Rgb sum;
  float squares = 0;          // of luminance
  float bright_nearness = 0;  // luminance / distance
  float half = 0;             // difference by halves of cells' rays (CellLight)
  float weight = 0;           // luminance that a unit of it brings the pixel
};

// Of one surface that a pixel sees.
struct GatherRecord {
  CellHit hit;
  float spacing = 0;  // metres between neighbouring pixels, at right angles to the ray
  float rays = 0;
  float nearness = 0;  // 1 / distance, over the rays
  GatherSums matte;    // irradiance
  // The mean radiance that wide gloss shows: what it sends to the eye, over what it would send if
  // radiance was 1 all around.
  GlossPlace place;
  GatherSums gloss;
  float width = 1;  // of the gloss
};

struct FittedRecord {
  Rgb irradiance;
  float error = 0;  // standard error of its luminance
  float reach = 0;  // metres over which both hold
  Rgb gloss;        // mean radiance that wide gloss shows, and its error
  float gloss_error = 0;
  float rays = 0;  // wanted of a pixel that gathers for itself
  // Something stands so close by, or neighbours are so few and to one side, that no fit holds where
  // this record is the nearest.
  bool is_alone = false;
};

class GatherRecords {
 public:
  static constexpr int tile_side = 16;  // pixels

  // Null once `stop` is set.
  static std::unique_ptr<GatherRecords> make(const Cells& cells, const PictureView& view,
                                             const GatherOptions& options,
                                             const std::function<void(double)>& progress,
                                             const StopFlag& stop, Counters& counters);

  // Irradiance at a place that pixel (x, y) sees, and what its gloss shows if it is of that
  // material (GlossPlace); false where the pixels around see another surface. is_rough: what is too
  // far away to hold there is better than nothing.
  bool irradiance_at(int x, int y, const CellHit& hit, uint32_t gloss, bool is_rough,
                     FittedRecord& out) const;
  // An aim, and the record for which it is; no_record: for a place that has none.
  static constexpr uint32_t no_record = 0xffffffffu;
  struct KnownAim {
    GatherAim aim;
    uint32_t record = no_record;
  };
  // How gather rays are drawn at a place that pixel (x, y) sees: as at a record of the pixel that
  // is of that surface, the last of them, so that one aim serves many rays. `last` is the caller's
  // memory, for these records alone.
  const GatherAim& aim_at(int x, int y, const CellHit& hit, const BrightPlaces& places,
                          KnownAim& last) const;
  size_t bytes() const {
    return records_.capacity() * sizeof(GatherRecord) + fitted_.capacity() * sizeof(FittedRecord) +
           first_.capacity() * sizeof(uint32_t) +
           (visible_.capacity() + rest_.capacity()) * sizeof(float);
  }

 private:
  friend class GatherPass;
  GatherRecords(const PixelWindow& window) : window_(window) {}
  // Calls visit(record) for those of a pixel.
  template <class Visit>
  void of_pixel(int x, int y, const Visit& visit) const {
    if (!window_.has(x, y)) return;
    const size_t p = size_t(y - window_.y0) * size_t(window_.width()) + size_t(x - window_.x0);
    for (uint32_t r = first_[p]; r < first_[p + 1]; ++r) visit(r);
  }

  PixelWindow window_;
  std::vector<uint32_t> first_;  // record of each pixel; and the end
  std::vector<GatherRecord> records_;
  std::vector<FittedRecord> fitted_;
  // What each tile sees of bright places, tiles row by row.
  std::vector<float> visible_, rest_;
};

// Whether two places lie on one surface, so that irradiance goes from one to the other without a
// jump; spacing: of pixels there, metres.
bool is_one_surface(const CellHit& a, const CellHit& b, float spacing);

}  // namespace troffer
