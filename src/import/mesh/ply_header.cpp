#include "import/mesh/ply_header.h"

#include <array>
#include <charconv>

#include "base/error.h"

namespace troffer {

namespace {

constexpr size_t max_header_items = 10000;

struct PlyTypeRow {
  std::string_view name;
  PlyType type;
};
constexpr std::array ply_type_rows{
    PlyTypeRow{"char", PlyType::int8},      PlyTypeRow{"int8", PlyType::int8},
    PlyTypeRow{"uchar", PlyType::uint8},    PlyTypeRow{"uint8", PlyType::uint8},
    PlyTypeRow{"short", PlyType::int16},    PlyTypeRow{"int16", PlyType::int16},
    PlyTypeRow{"ushort", PlyType::uint16},  PlyTypeRow{"uint16", PlyType::uint16},
    PlyTypeRow{"int", PlyType::int32},      PlyTypeRow{"int32", PlyType::int32},
    PlyTypeRow{"uint", PlyType::uint32},    PlyTypeRow{"uint32", PlyType::uint32},
    PlyTypeRow{"float", PlyType::float32},  PlyTypeRow{"float32", PlyType::float32},
    PlyTypeRow{"double", PlyType::float64}, PlyTypeRow{"float64", PlyType::float64},
};

struct Word {
  std::string_view text;
  int column = 1;
};

class HeaderParser {
 public:
  HeaderParser(std::string_view text, const std::string& file) : text_(text), file_(file) {}
  PlyHeader parse();

 private:
  std::string_view text_;
  const std::string& file_;
  size_t at_ = 0;
  int line_ = 0;
  std::vector<Word> words_;
  PlyHeader header_;

  [[noreturn]] void fail(size_t word, const std::string& what) const {
    throw InputError(file_, line_, word < words_.size() ? words_[word].column : 1, what);
  }
  bool next_line();
  std::string_view word(size_t i) const { return i < words_.size() ? words_[i].text : ""; }
  PlyType type_at(size_t i) const;
  void read_format();
  void read_element();
  void read_property();
};

// Splits the next line into words. A line ends with "\n", "\r\n" or a lone "\r".
bool HeaderParser::next_line() {
  words_.clear();
  if (at_ >= text_.size()) return false;
  ++line_;
  const size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
  const size_t begin = at_;
  for (size_t i = begin; i < end;) {
    while (i < end && (text_[i] == ' ' || text_[i] == '\t')) ++i;
    const size_t word_begin = i;
    while (i < end && text_[i] != ' ' && text_[i] != '\t') ++i;
    if (i > word_begin && words_.size() < 8)
      words_.push_back({text_.substr(word_begin, i - word_begin), int(word_begin - begin) + 1});
  }
  at_ = end < text_.size() ? end + 1 : end;
  if (end + 1 < text_.size() && text_[end] == '\r' && text_[end + 1] == '\n') ++at_;
  return true;
}

PlyType HeaderParser::type_at(size_t i) const {
  for (const PlyTypeRow& row : ply_type_rows)
    if (row.name == word(i)) return row.type;
  fail(i, "unknown PLY type '" + std::string(word(i).substr(0, 40)) + "'");
}

void HeaderParser::read_format() {
  if (word(1) == "ascii")
    header_.format = PlyFormat::ascii;
  else if (word(1) == "binary_little_endian")
    header_.format = PlyFormat::little_endian;
  else if (word(1) == "binary_big_endian")
    header_.format = PlyFormat::big_endian;
  else
    fail(1, "unknown PLY format '" + std::string(word(1).substr(0, 40)) + "'");
  if (word(2) != "1.0") fail(2, "only version 1.0 of PLY is supported");
}

void HeaderParser::read_element() {
  PlyElement element;
  element.name = std::string(word(1));
  const std::string_view count = word(2);
  const auto result = std::from_chars(count.data(), count.data() + count.size(), element.count);
  if (count.empty() || result.ec != std::errc() || result.ptr != count.data() + count.size())
    fail(2, "expected 'element NAME COUNT'");
  header_.elements.push_back(std::move(element));
}

void HeaderParser::read_property() {
  if (header_.elements.empty()) fail(0, "a property before any element");
  PlyProperty property;
  property.is_list = word(1) == "list";
  if (property.is_list) {
    property.count_type = type_at(2);
    if (!is_integer(property.count_type)) fail(2, "the length of a list must be of integer type");
  }
  const size_t type_word = property.is_list ? 3 : 1;
  property.type = type_at(type_word);
  if (word(type_word + 1).empty()) fail(type_word, "a property without a name");
  property.name = std::string(word(type_word + 1));
  header_.elements.back().properties.push_back(std::move(property));
}

PlyHeader HeaderParser::parse() {
  if (!next_line() || words_.size() != 1 || word(0) != "ply")
    throw InputError(file_, 1, 1, "not a PLY file: the first line is not 'ply'");
  bool has_format = false;
  for (size_t items = 0; next_line(); ++items) {
    if (items > max_header_items) fail(0, "the header is too long");
    const std::string_view keyword = word(0);
    if (keyword.empty() || keyword == "comment" || keyword == "obj_info") continue;
    if (keyword == "format") {
      read_format();
      has_format = true;
    } else if (keyword == "element") {
      read_element();
    } else if (keyword == "property") {
      read_property();
    } else if (keyword == "end_header") {
      if (!has_format) fail(0, "the header names no format");
      header_.body = at_;
      header_.body_line = line_ + 1;
      return std::move(header_);
    } else {
      fail(0, "unknown word '" + std::string(keyword.substr(0, 40)) + "' in the header");
    }
  }
  throw InputError(file_, line_ + 1, 1, "the header ends without 'end_header'");
}

}  // namespace

size_t size_of(PlyType type) {
  constexpr std::array<size_t, 8> sizes{1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[size_t(type)];
}

PlyHeader parse_ply_header(std::string_view text, const std::string& file) {
  return HeaderParser(text, file).parse();
}

}  // namespace troffer
