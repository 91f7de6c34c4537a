// Thinning of gather records: where pixels are closer together than light changes, only the pixels
// of a lattice need records of their own. Used by GatherPass in large pictures.
#pragma once

#include "gather/gather_fits.h"

namespace troffer {

// True if most pixels of the whole picture are so close. False for small pictures, which gain
// nothing. Uses the scratch memory and adds its rays to the counters.
bool has_close_pixels(const Cells& cells, const PictureView& view, uint64_t seed,
                      GatherScratch& viewing, CellsScratch& gathering, Counters& counters);

// True if the records of lattice pixels around say all about record r of pixel (x, y): all see the
// same surface, and light is nearly linear between them.
bool is_redundant(const GatherRecords& records, GatherFits& fits, int x, int y, uint32_t r);

}  // namespace troffer
