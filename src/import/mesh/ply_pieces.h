// The rows of a PLY element in pieces that can be read side by side.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "import/mesh/ply_header.h"

namespace troffer {

struct PlyPiece {
  size_t begin = 0, end = 0;  // bytes of the file
  uint64_t first_row = 0, rows = 0;
  int lines = 0;  // ends of lines in it, of text
};

class PlyCutter {
 public:
  // piece_bytes: about how long pieces are to be; 0: nothing is cut. Both texts must outlive this.
  PlyCutter(std::string_view text, const PlyHeader& header, const std::string& file,
            size_t piece_bytes);

  // Pieces of an element whose first row begins at the byte `begin`, from there on without gaps. Of
  // text each line is taken for a row: whoever reads a piece has to see that it holds its rows and
  // nothing else. None where the file has no such rows, or has fewer.
  std::optional<std::vector<PlyPiece>> cut(const PlyElement& element, size_t begin) const;

 private:
  std::string_view text_;
  const PlyHeader& header_;
  const std::string& file_;
  size_t piece_bytes_;
  std::vector<PlyPiece> blocks_;  // of text: the whole body, rows being lines

  void find_lines();
  std::optional<std::vector<PlyPiece>> cut_lines(const PlyElement& element, size_t begin) const;
  std::optional<std::vector<PlyPiece>> cut_binary(const PlyElement& element, size_t begin) const;
};

}  // namespace troffer
