#include "import/mesh/ply_body.h"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "base/error.h"

namespace troffer {

namespace {

template <class T>
double scalar_from(const char* bytes, bool is_big) {
  using Bits = std::conditional_t<sizeof(T) == 8, uint64_t,
                                  std::conditional_t<sizeof(T) == 4, uint32_t, uint16_t>>;
  if constexpr (sizeof(T) == 1) {
    return double(std::bit_cast<T>(*bytes));
  } else {
    Bits bits = 0;
    std::memcpy(&bits, bytes, sizeof bits);
    if (is_big != (std::endian::native == std::endian::big)) {
      if constexpr (sizeof(T) == 8)
        bits = __builtin_bswap64(bits);
      else if constexpr (sizeof(T) == 4)
        bits = __builtin_bswap32(bits);
      else
        bits = __builtin_bswap16(bits);
    }
    return double(std::bit_cast<T>(bits));
  }
}

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

}  // namespace

void PlyBody::fail(const std::string& what) const {
  if (!is_ascii()) throw InputError(file_, 0, 0, what);
  throw InputError(file_, line_, int(last_ - line_start_) + 1, what);
}

void PlyBody::skip_blanks() {
  for (; at_ < text_.size(); ++at_) {
    const char c = text_[at_];
    if (!is_blank(c)) break;
    if (c != '\n') continue;
    ++line_;
    line_start_ = at_ + 1;
  }
}

void PlyBody::go_past_last_scalar(size_t end, int lines) {
  while (is_ascii() && end > at_ && is_blank(text_[end - 1])) {
    --end;
    if (text_[end] == '\n') --lines;
  }
  if (lines > 0) line_start_ = text_.rfind('\n', end - 1) + 1;
  at_ = end;
  line_ += lines;
}

bool PlyBody::is_done() {
  if (is_ascii()) skip_blanks();
  return at_ == text_.size();
}

double PlyBody::next_ascii(PlyType type) {
  skip_blanks();
  last_ = at_;
  if (at_ == text_.size()) fail("the file ends early");
  const char* begin = text_.data() + at_;
  const char* const end = text_.data() + text_.size();
  if (*begin == '+' && begin + 1 < end && begin[1] != '-') ++begin;
  double value = 0;
  const auto result = std::from_chars(begin, end, value);
  const bool is_whole = result.ptr == end || is_blank(*result.ptr);
  if (result.ec == std::errc::invalid_argument || !is_whole) fail("expected a number");
  if (result.ec == std::errc::result_out_of_range)
    value = std::strtod(std::string(begin, result.ptr).c_str(), nullptr);
  at_ = size_t(result.ptr - text_.data());
  if (is_integer(type) && std::floor(value) != value) fail("expected an integer");
  return value;
}

double PlyBody::next_binary(PlyType type) {
  const size_t size = size_of(type);
  if (remaining() < size) fail("the file ends early");
  const char* const bytes = text_.data() + at_;
  const bool is_big = format_ == PlyFormat::big_endian;
  at_ += size;
  switch (type) {
    case PlyType::int8:
      return scalar_from<int8_t>(bytes, is_big);
    case PlyType::uint8:
      return scalar_from<uint8_t>(bytes, is_big);
    case PlyType::int16:
      return scalar_from<int16_t>(bytes, is_big);
    case PlyType::uint16:
      return scalar_from<uint16_t>(bytes, is_big);
    case PlyType::int32:
      return scalar_from<int32_t>(bytes, is_big);
    case PlyType::uint32:
      return scalar_from<uint32_t>(bytes, is_big);
    case PlyType::float32:
      return scalar_from<float>(bytes, is_big);
    case PlyType::float64:
      return scalar_from<double>(bytes, is_big);
  }
  return 0;
}

size_t PlyBody::list_length(const PlyProperty& property) {
  const double length = next(property.count_type);
  const double smallest = is_ascii() ? 2 : double(size_of(property.type));
  if (!(length >= 0)) fail("a list of negative length");
  if (length * smallest > double(remaining()) + 1)
    fail("the file is too short for a list of this length");
  return size_t(length);
}

void PlyBody::skip(const PlyProperty& property) {
  const size_t n = property.is_list ? list_length(property) : 1;
  for (size_t i = 0; i < n; ++i) next(property.type);
}

}  // namespace troffer
