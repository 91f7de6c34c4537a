// Layout of the program's own binary files (solutions, checkpoints). A header begins with `char
// magic[8]` and `uint32_t version` and has a `uint64_t hash` of everything else. The body is a
// sequence of plain structures. Little endian. Such files may come from anyone, so all that is read
// is checked.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"

namespace troffer {

static_assert(std::endian::native == std::endian::little, "the program's files are little endian");

struct OwnFile {
  char magic[8];
  uint32_t version;
  const char* name;  // for messages: "radiosity solution"

  bool is_of(std::span<const uint8_t> bytes) const {
    return bytes.size() >= sizeof(magic) && std::memcmp(bytes.data(), magic, sizeof(magic)) == 0;
  }
};

template <class T>
void append(std::vector<uint8_t>& out, const T& v) {
  const size_t at = out.size();
  out.resize(at + sizeof(T));
  std::memcpy(out.data() + at, &v, sizeof(T));
}

// Reads values in sequence. The caller ensures that there are enough bytes (CHECK).
class ByteReader {
 public:
  explicit ByteReader(std::span<const uint8_t> bytes) : bytes_(bytes) {}
  template <class T>
  T next() {
    TROFFER_CHECK(bytes_.size() >= sizeof(T));
    T v;
    std::memcpy(&v, bytes_.data(), sizeof(T));
    bytes_ = bytes_.subspan(sizeof(T));
    return v;
  }
  size_t left() const { return bytes_.size(); }

 private:
  std::span<const uint8_t> bytes_;
};

// Hash that detects damage, not manipulation.
uint64_t hash_of_parts(std::span<const uint8_t> header, std::span<const uint8_t> body);

// Checks magic, version and header size. Throws InputError.
void check_kind(const OwnFile& kind, std::span<const uint8_t> bytes, size_t header_size,
                const std::string& file);

// Accounts for the parts of a body that the header announces. Throws InputError if the body is too
// short or too long.
class BodySize {
 public:
  BodySize(const OwnFile& kind, uint64_t bytes, const std::string& file)
      : kind_(kind), left_(bytes), file_(file) {}
  void take(uint64_t count, uint64_t size);
  void check_end() const;

 private:
  const OwnFile& kind_;
  uint64_t left_;
  const std::string& file_;
};

template <class Header>
uint64_t hash_of_file(Header h, std::span<const uint8_t> body) {
  h.hash = 0;
  std::vector<uint8_t> header;
  append(header, h);
  return hash_of_parts(header, body);
}

// Returns the file's bytes. Sets magic, version and hash of the header.
template <class Header>
std::vector<uint8_t> own_file(const OwnFile& kind, Header h, std::span<const uint8_t> body) {
  std::memcpy(h.magic, kind.magic, sizeof(h.magic));
  h.version = kind.version;
  h.hash = hash_of_file(h, body);
  std::vector<uint8_t> out;
  out.reserve(sizeof(Header) + body.size());
  append(out, h);
  out.insert(out.end(), body.begin(), body.end());
  return out;
}

// Returns the header of a file after checking kind, version, size and hash. `count(header,
// BodySize&)` takes the parts that the body must have. The caller checks the meaning of the
// header's values. Throws InputError.
template <class Header, class Count>
Header checked_header(const OwnFile& kind, std::span<const uint8_t> bytes, const std::string& file,
                      const Count& count) {
  check_kind(kind, bytes, sizeof(Header), file);
  const auto h = ByteReader(bytes).next<Header>();
  const std::span<const uint8_t> body = bytes.subspan(sizeof(Header));
  BodySize size(kind, body.size(), file);
  count(h, size);
  size.check_end();
  if (hash_of_file(h, body) != h.hash)
    throw InputError(file, 0, 0, std::string(kind.name) + " is damaged");
  return h;
}

}  // namespace troffer
