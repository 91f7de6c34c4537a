#include "base/own_file.h"

#include "base/random.h"

namespace troffer {

namespace {

uint64_t hash_bytes(std::span<const uint8_t> bytes) {
  uint64_t hash = hash_combine(2, bytes.size());
  size_t i = 0;
  for (; i + 8 <= bytes.size(); i += 8) {
    uint64_t word = 0;
    std::memcpy(&word, bytes.data() + i, 8);
    hash = hash_combine(hash, word);
  }
  for (; i < bytes.size(); ++i) hash = hash_combine(hash, bytes[i]);
  return hash;
}

}  // namespace

uint64_t hash_of_parts(std::span<const uint8_t> header, std::span<const uint8_t> body) {
  return hash_combine(hash_bytes(header), hash_bytes(body));
}

void check_kind(const OwnFile& kind, std::span<const uint8_t> bytes, size_t header_size,
                const std::string& file) {
  const std::string name = kind.name;
  if (bytes.empty()) throw InputError(file, 0, 0, "is empty, not a " + name);
  if (!kind.is_of(bytes)) throw InputError(file, 0, 0, "not a " + name);
  if (bytes.size() < header_size) throw InputError(file, 0, 0, name + " is cut short");
  uint32_t version = 0;
  std::memcpy(&version, bytes.data() + sizeof(kind.magic), sizeof(version));
  if (version != kind.version)
    throw InputError(file, 0, 0,
                     name + " of version " + std::to_string(version) + "; this program reads " +
                         std::to_string(kind.version));
}

void BodySize::take(uint64_t count, uint64_t size) {
  if (count > left_ / size)
    throw InputError(file_, 0, 0, std::string(kind_.name) + " is cut short");
  left_ -= count * size;
}

void BodySize::check_end() const {
  if (left_ != 0)
    throw InputError(file_, 0, 0, std::string(kind_.name) + " has extra bytes at its end");
}

}  // namespace troffer
