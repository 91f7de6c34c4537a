#include "annual/npy_array.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <fstream>
#include <span>
#include <string>
#include <string_view>

#include "base/error.h"
#include "import/file.h"

namespace troffer {

namespace {

[[noreturn]] void fail_npy(const std::string& path, const std::string& what) {
  throw InputError(path, -1, 0, what);
}

// Opens a file for reads at many places, without a buffer that would read more than is needed.
std::ifstream open_unbuffered(const std::string& path) {
  (void)size_of_file(path);  // refuses pipes, which would make the next line wait
  std::ifstream in;
  in.rdbuf()->pubsetbuf(nullptr, 0);
  in.open(path, std::ios::binary);
  if (!in) fail_npy(path, "cannot be read");
  return in;
}

void read_floats(std::ifstream& in, const std::string& path, uint64_t at, std::span<float> to) {
  in.seekg(std::streamoff(at));
  in.read(reinterpret_cast<char*>(to.data()), std::streamsize(to.size_bytes()));
  if (in.gcount() != std::streamsize(to.size_bytes()) || !in)
    fail_npy(path, "has changed while it was in use");
}

// Text of a header without blanks, and where the numbers begin.
struct NpyHeader {
  std::string text;
  uint64_t end = 0;
};

NpyHeader read_npy_header(const std::string& path) {
  std::ifstream in = open_unbuffered(path);
  constexpr std::string_view magic("\x93NUMPY");
  constexpr size_t most = 1 << 16;
  std::array<char, 12> head{};
  in.read(head.data(), head.size());
  if (in.gcount() != std::streamsize(head.size()) ||
      !std::string_view(head.data(), 6).starts_with(magic))
    fail_npy(path, "is not an array of NumPy");
  const auto byte = [&](size_t i) { return size_t(uint8_t(head[i])); };
  const size_t version = byte(6), begin = version == 1 ? 10 : 12;
  size_t length = byte(8) + 256 * byte(9);
  if (version != 1) length += 65536 * (byte(10) + 256 * byte(11));
  if (version < 1 || version > 3 || length > most)
    fail_npy(path, "has a header of NumPy that is not understood");
  std::string text(length, '\0');
  in.seekg(std::streamoff(begin));
  in.read(text.data(), std::streamsize(length));
  if (in.gcount() != std::streamsize(length)) fail_npy(path, "ends within its header");
  std::erase_if(text, [](char c) { return c == ' ' || c == '\n'; });
  return {text, begin + length};
}

// Returns the two numbers of "'shape':(R,C)".
bool read_shape(std::string_view text, std::array<size_t, 2>& shape) {
  constexpr std::string_view key = "'shape':(";
  const size_t at = text.find(key);
  if (at == text.npos) return false;
  const char *from = text.data() + at + key.size(), *end = text.data() + text.size();
  for (size_t i = 0; i < 2; ++i) {
    const auto [next, error] = std::from_chars(from, end, shape[i]);
    if (error != std::errc() || next == end || *next != (i == 0 ? ',' : ')')) return false;
    from = next + 1;
  }
  return true;
}

}  // namespace

NpyArray::NpyArray(std::string path, size_t rows, size_t columns)
    : path_(std::move(path)), rows_(rows), columns_(columns) {
  const NpyHeader header = read_npy_header(path_);
  if (header.text.find("'descr':'<f4'") == std::string::npos ||
      header.text.find("'fortran_order':False") == std::string::npos)
    fail_npy(path_, "does not hold 32-bit floats row by row, as troffer annual writes them");
  std::array<size_t, 2> shape{};
  if (!read_shape(header.text, shape)) fail_npy(path_, "does not hold a table of numbers");
  if (shape[0] != rows || shape[1] != columns)
    fail_npy(path_, fmt::format("holds {} sensors and {} hours, and the folder has {} sensors and "
                                "{} hours",
                                shape[0], shape[1], rows, columns));
  first_byte_ = header.end;
  const uint64_t needed = first_byte_ + uint64_t(rows) * columns * sizeof(float);
  const uint64_t size = size_of_file(path_);
  if (size != needed)
    fail_npy(path_, fmt::format("has {} bytes where its header announces {}", size, needed));
}

std::vector<float> NpyArray::columns(size_t first, size_t count) const {
  TROFFER_CHECK(first <= columns_ && count <= columns_ - first);
  std::ifstream in = open_unbuffered(path_);
  std::vector<float> row(count), all(rows_ * count);
  for (size_t r = 0; r < rows_; ++r) {
    read_floats(in, path_, first_byte_ + (uint64_t(r) * columns_ + first) * sizeof(float), row);
    for (size_t c = 0; c < count; ++c) all[c * rows_ + r] = row[c];
  }
  return all;
}

std::vector<float> NpyArray::row(size_t number) const {
  TROFFER_CHECK(number < rows_);
  std::ifstream in = open_unbuffered(path_);
  std::vector<float> values(columns_);
  read_floats(in, path_, first_byte_ + uint64_t(number) * columns_ * sizeof(float), values);
  return values;
}

}  // namespace troffer
