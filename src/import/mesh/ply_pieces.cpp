#include "import/mesh/ply_pieces.h"

#include <algorithm>
#include <cstring>

#include "base/error.h"
#include "base/parallel.h"
#include "import/mesh/ply_body.h"

namespace troffer {

namespace {

// Returns the byte after the end of the line that contains `at`.
size_t next_line(std::string_view text, size_t at) {
  const size_t found = text.find('\n', at);
  return found == std::string_view::npos ? text.size() : found + 1;
}

size_t after_lines(std::string_view text, size_t at, uint64_t lines) {
  for (; lines > 0; --lines) at = next_line(text, at);
  return at;
}

}  // namespace

PlyCutter::PlyCutter(std::string_view text, const PlyHeader& header, const std::string& file,
                     size_t piece_bytes)
    : text_(text), header_(header), file_(file), piece_bytes_(piece_bytes) {
  if (piece_bytes > 0 && header.format == PlyFormat::ascii && header.body < text.size())
    find_lines();
}

void PlyCutter::find_lines() {
  const size_t begin = header_.body, n = text_.size() - begin;
  const size_t count = (n + piece_bytes_ - 1) / piece_bytes_;
  std::vector<PlyPiece> blocks(count);
  parallel_for(count, 0, [&](size_t i) {
    // A line belongs to the block in which it begins.
    const size_t from = begin + i * piece_bytes_, to = std::min(text_.size(), from + piece_bytes_);
    PlyPiece& block = blocks[i];
    block.begin = i == 0 ? from : next_line(text_, from - 1);
    block.end = std::max(block.begin, next_line(text_, to - 1));
    const char* const end = text_.data() + block.end;
    block.lines = int(std::count(text_.data() + block.begin, end, '\n'));
    const bool is_cut_off = block.end > block.begin && end[-1] != '\n';
    block.rows = uint64_t(block.lines) + (is_cut_off ? 1 : 0);
  });
  uint64_t rows = 0;
  for (PlyPiece& block : blocks) {
    block.first_row = rows;
    rows += block.rows;
  }
  blocks_ = std::move(blocks);
}

std::optional<std::vector<PlyPiece>> PlyCutter::cut_lines(const PlyElement& element,
                                                          size_t begin) const {
  const auto holding = std::find_if(blocks_.begin(), blocks_.end(),
                                    [&](const PlyPiece& block) { return begin < block.end; });
  std::vector<PlyPiece> pieces;
  uint64_t left = element.count;
  size_t at = begin;
  for (auto block = holding; block != blocks_.end() && left > 0; ++block) {
    PlyPiece piece{at, block->end, element.count - left, block->rows, block->lines};
    if (at != block->begin) {  // the element begins within the block
      const auto before = uint64_t(std::count(&text_[block->begin], &text_[at], '\n'));
      piece.rows -= before;
      piece.lines -= int(before);
    }
    if (left < piece.rows) {
      piece.end = after_lines(text_, at, left);
      piece.rows = left;
      piece.lines = int(left);
    }
    left -= piece.rows;
    at = piece.end;
    if (piece.rows > 0) pieces.push_back(piece);
  }
  if (left > 0) return std::nullopt;
  return pieces;
}

std::optional<std::vector<PlyPiece>> PlyCutter::cut_binary(const PlyElement& element,
                                                           size_t begin) const {
  size_t row = 0;
  bool has_lists = false;
  for (const PlyProperty& p : element.properties) {
    row += size_of(p.is_list ? p.count_type : p.type);
    has_lists = has_lists || p.is_list;
  }
  const uint64_t rows = std::max<uint64_t>(1, piece_bytes_ / row);
  std::vector<PlyPiece> pieces;
  PlyBody body(text_, begin, 0, header_.format, file_);
  for (uint64_t first = 0; first < element.count; first += rows) {
    PlyPiece piece{body.at(), 0, first, std::min(rows, element.count - first)};
    if (!has_lists) {
      if (body.remaining() / row < piece.rows) return std::nullopt;
      body.go_to(body.at() + size_t(piece.rows) * row, 0);
    }
    for (uint64_t i = 0; has_lists && i < piece.rows; ++i)
      for (const PlyProperty& p : element.properties) {
        const size_t bytes = p.is_list ? body.list_length(p) * size_of(p.type) : size_of(p.type);
        if (body.remaining() < bytes) return std::nullopt;
        body.go_to(body.at() + bytes, 0);
      }
    piece.end = body.at();
    pieces.push_back(piece);
  }
  return pieces;
}

std::optional<std::vector<PlyPiece>> PlyCutter::cut(const PlyElement& element, size_t begin) const {
  if (piece_bytes_ == 0 || element.properties.empty()) return std::nullopt;
  if (header_.format == PlyFormat::ascii) return cut_lines(element, begin);
  try {
    return cut_binary(element, begin);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

}  // namespace troffer
