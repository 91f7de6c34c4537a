// Irradiance gathered for a picture before its viewing rays are shaded. One ray through the middle
// of every pixel finds the matte surfaces that it sees: directly, in mirrors and through glass.
// Each gets 8 gather rays, as many more as the asked error needs, and a linear fit over neighbours
// on the same surface. Viewing rays look up the result (CellsIndirect; docs/method/cells.md).
//
// The result of a pixel depends on the pixels around it, not on tiles, threads or the window.
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
  PixelWindow image, window;                 // the whole picture, and the part to be made
  std::function<Ray(float x, float y)> ray;  // ray through a point of the picture, in pixels
  // Returns the ray through the middle of a pixel. spread: distance to the next pixel's ray, per
  // metre along it.
  Ray pixel_ray(int x, int y, float& spread) const;
};

struct GatherOptions {
  double error = 0.01;  // asked relative error of a pixel's gathered light
  double typical = 0;   // luminance of indirect light in the picture
  int threads = 0;
  uint64_t seed = 0;
  ProcessGroup* group = nullptr;  // processes that make the same picture; may be null
  // Gathers in the window alone. Pixels near its edge then have fewer neighbours than in the whole
  // picture, so only the cost counts.
  bool is_trial = false;
};

// Sums over the rays of a gather.
struct GatherSums {
  Rgb sum;
  float squares = 0;          // sum of squared luminance
  float bright_nearness = 0;  // sum of luminance / distance
  float half = 0;             // sum of draws of the noise of cells, luminance (CellLight)
  float weight = 0;           // not a sum: luminance of the pixel per unit of this light
};

// The gather at one surface that a pixel sees.
struct GatherRecord {
  CellHit hit;
  float spacing = 0;  // metres between neighbouring pixels, at right angles to the ray
  float rays = 0;
  float nearness = 0;  // sum of 1 / distance over the rays, 1/m
  GatherSums matte;    // irradiance
  // Wide gloss. Its light is the mean radiance over the lobe: the radiance that the lobe reflects
  // to the eye, divided by what it reflects under a uniform radiance of 1.
  GlossPlace place;
  GatherSums gloss;
  float width = 1;  // width of the gloss (GGX)
};

// The fit at a record.
struct FittedRecord {
  Rgb irradiance;
  float error = 0;  // standard error of its luminance
  float reach = 0;  // metres around the record within which its fits hold, irradiance and gloss
  Rgb gloss;        // mean radiance of wide gloss, as in GatherRecord
  float gloss_error = 0;
  float rays = 0;  // gather rays of a viewing ray that cannot use the fit
  // True if lookups fail where this record is the nearest: another surface stands close in front of
  // it.
  bool is_alone = false;
};

class GatherRecords {
 public:
  static constexpr int tile_side = 16;  // pixels

  // Gathers for a picture. Returns null once `stop` is set.
  static std::unique_ptr<GatherRecords> make(const Cells& cells, const PictureView& view,
                                             const GatherOptions& options,
                                             const std::function<void(double)>& progress,
                                             const StopFlag& stop, Counters& counters);

  // Looks up the fit at a place that pixel (x, y) sees: irradiance, and what wide gloss of this
  // material shows (GlossPlace; no_material: none). Returns false if the surrounding pixels see
  // another surface, or if their fits do not hold there. is_rough: accepts fits that do not hold.
  bool irradiance_at(int x, int y, const CellHit& hit, uint32_t gloss, bool is_rough,
                     FittedRecord& out) const;
  // A distribution of gather rays and the record at which it was made; no_record if there is none.
  static constexpr uint32_t no_record = 0xffffffffu;
  struct CachedDistribution {
    GatherDistribution aim;
    uint32_t record = no_record;
  };
  // Returns the distribution of gather rays at a place that pixel (x, y) sees. All places near a
  // record of the pixel, on the same surface, use the distribution at that record, which `last`
  // caches. A cache serves one caller and one GatherRecords.
  const GatherDistribution& aim_at(int x, int y, const CellHit& hit, const LitRegions& places,
                                   CachedDistribution& last) const;
  size_t bytes() const {
    return records_.capacity() * sizeof(GatherRecord) + fitted_.capacity() * sizeof(FittedRecord) +
           first_.capacity() * sizeof(uint32_t) +
           (visible_.capacity() + rest_.capacity()) * sizeof(float);
  }

  const std::vector<GatherRecord>& all() const { return records_; }
  // Calls visit(record) for every record of a pixel.
  template <class Visit>
  void of_pixel(int x, int y, const Visit& visit) const {
    if (!window_.has(x, y)) return;
    const size_t p = size_t(y - window_.y0) * size_t(window_.width()) + size_t(x - window_.x0);
    for (uint32_t r = first_[p]; r < first_[p + 1]; ++r) visit(r);
  }

 private:
  friend class GatherPass;
  GatherRecords(const PixelWindow& window) : window_(window) {}
  // Removes the records whose flag is set and renumbers the others.
  void leave_out(const std::vector<uint8_t>& flags);

  PixelWindow window_;
  std::vector<uint32_t> first_;  // first record of each pixel, and the end
  std::vector<GatherRecord> records_;
  std::vector<FittedRecord> fitted_;
  // Per tile, row by row: visibility of each lit region, and RegionVisibility::rest.
  std::vector<float> visible_, rest_;
};

// True if two places lie on one surface, so that irradiance has no jump between them. spacing:
// metres between pixels there.
bool is_one_surface(const CellHit& a, const CellHit& b, float spacing);

}  // namespace troffer
