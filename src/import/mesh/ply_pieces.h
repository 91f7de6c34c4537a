// Division of the rows of a PLY element into pieces that can be read in parallel. ply.cpp reads
// each piece with a PlyBody of its own, and falls back to sequential reading where an element
// cannot be cut. Positions in the file are byte offsets.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "import/mesh/ply_header.h"

namespace troffer {

// A range of rows of an element.
struct PlyPiece {
  size_t begin = 0, end = 0;  // bytes of the file
  uint64_t first_row = 0, rows = 0;
  int lines = 0;  // line ends in it, of an ascii body
};

// Cuts the elements of one file into pieces.
class PlyCutter {
 public:
  // `piece_bytes` is the approximate size of a piece; 0: no cutting. Both texts must outlive this
  // object.
  PlyCutter(std::string_view text, const PlyHeader& header, const std::string& file,
            size_t piece_bytes);

  // Returns pieces without gaps of an element whose first row starts at byte `begin`. In an ascii
  // body each line counts as a row, so a reader must check that its piece holds exactly its rows.
  // Returns nothing if the file has too few rows, the element has no properties, or piece_bytes is
  // 0.
  std::optional<std::vector<PlyPiece>> cut(const PlyElement& element, size_t begin) const;

 private:
  std::string_view text_;
  const PlyHeader& header_;
  const std::string& file_;
  size_t piece_bytes_;
  std::vector<PlyPiece> blocks_;  // blocks of an ASCII body: the whole body, with lines as rows

  void find_lines();
  std::optional<std::vector<PlyPiece>> cut_lines(const PlyElement& element, size_t begin) const;
  std::optional<std::vector<PlyPiece>> cut_binary(const PlyElement& element, size_t begin) const;
};

}  // namespace troffer
