// Makes the gather records of a picture (gather_records.h), for GatherRecords::make(). The steps
// are first gathers, thinning, further rays and fits, each over the whole picture before the next.
// Tiles are shared by threads and processes; the result does not depend on either. Where light
// varies little between pixels, only every second pixel of every second row has a record
// (gather_thinning.h).
#pragma once

#include <vector>

#include "gather/gather_fits.h"

namespace troffer {

class GatherPass {
 public:
  GatherPass(const Cells& cells, const PictureView& view, const GatherOptions& options,
             const StopFlag& stop, GatherRecords& out);
  bool run(const std::function<void(double)>& progress, Counters& counters);

 private:
  struct Tile {
    PixelWindow pixels;  // pixels of the tile, within the window
    int x = 0, y = 0;    // first pixel of the tile in the tiling of the whole picture
    std::vector<GatherRecord> records;  // pixel by pixel, row by row; empty after join()
    std::vector<uint16_t> counts;       // records of each pixel
    RegionVisibility sight;             // lit regions as seen from the tile's surfaces
  };
  struct Worker {
    Worker() { viewing.is_view = true; }
    GatherScratch viewing;
    CellsScratch cells;
    Counters counters;
  };
  // Choice of the rays of a record that are gathered.
  enum class Rays : uint8_t { first, further };

  bool thin(std::vector<Tile>& tiles, Counters& counters);
  void see(Tile& tile, Worker& w) const;
  void gather(std::vector<GatherRecord>& records, const std::vector<uint32_t>& counts,
              const Tile& tile, const std::vector<uint32_t>& places, Rays which, Worker& w,
              GuidingStatistics* tally = nullptr) const;
  void join(std::vector<Tile>& tiles);
  void gather_wanted(const Tile& tile, Rays which, Worker& w);
  // work: complete except for the numbers of tiles and threads.
  bool over_tiles(std::vector<Tile>& tiles, SharedWork work, Counters& counters);
  bool see_all(std::vector<Tile>& tiles, Counters& counters);
  bool gather_wanted(std::vector<Tile>& tiles, Rays which, Counters& counters);
  template <class Visit>
  void records_of(const Tile& tile, const Visit& visit) const;
  template <class T, class Of>
  bool for_records(std::vector<Tile>& tiles, Counters& counters, std::vector<T>& values,
                   const Of& of);

  const Cells& cells_;
  const PictureView& view_;
  const GatherOptions& options_;
  const StopFlag& stop_;
  GatherRecords& out_;
  std::vector<Worker> workers_;
  bool is_thinned_;               // records between lattice pixels may be missing
  GatherFits fits_;               // over out_
  std::vector<uint32_t> wanted_;  // per record: rays to be gathered next
};

// Calls visit(x, y, record) for all records of a tile.
template <class Visit>
void GatherPass::records_of(const Tile& t, const Visit& visit) const {
  for (int y = t.pixels.y0; y < t.pixels.y1; ++y)
    for (int x = t.pixels.x0; x < t.pixels.x1; ++x)
      out_.of_pixel(x, y, [&](uint32_t r) { visit(x, y, r); });
}

// Sets values[record] to of(x, y, record) for all records. `of` may read records, but not `values`.
template <class T, class Of>
bool GatherPass::for_records(std::vector<Tile>& tiles, Counters& counters, std::vector<T>& values,
                             const Of& of) {
  SharedWork work;
  work.act = [&](size_t t, size_t) {
    records_of(tiles[t], [&](int x, int y, uint32_t r) { values[r] = of(x, y, r); });
    return true;
  };
  work.save = [&](size_t t, SharedWork::Bytes& out) {
    records_of(tiles[t], [&](int, int, uint32_t r) { append(out, values[r]); });
  };
  work.load = [&](size_t t, ByteReader in) {
    records_of(tiles[t], [&](int, int, uint32_t r) { values[r] = in.next<T>(); });
  };
  return over_tiles(tiles, std::move(work), counters);
}

}  // namespace troffer
