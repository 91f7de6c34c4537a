#include "import/gltf/gltf_file.h"

#include <span>

#include "base/error.h"
#include "import/file.h"

namespace troffer {

namespace {

constexpr uint64_t max_json_bytes = uint64_t(1) << 30;
constexpr uint32_t magic_gltf = 0x46546c67, chunk_json = 0x4e4f534a, chunk_binary = 0x004e4942;
constexpr size_t glb_header_size = 12, chunk_header_size = 8;

uint32_t little_endian_32(std::span<const uint8_t> bytes, size_t at) {
  return uint32_t(bytes[at]) | uint32_t(bytes[at + 1]) << 8 | uint32_t(bytes[at + 2]) << 16 |
         uint32_t(bytes[at + 3]) << 24;
}

bool has_magic(std::span<const uint8_t> bytes) {
  return bytes.size() >= 4 && little_endian_32(bytes, 0) == magic_gltf;
}

// Returns the bytes that the header declares, header included [1] §4.4.2.
std::span<const uint8_t> checked_extent(const std::string& path, std::span<const uint8_t> bytes) {
  if (bytes.size() < glb_header_size) throw InputError(path, 0, 0, "the GLB header is cut short");
  const uint32_t version = little_endian_32(bytes, 4), length = little_endian_32(bytes, 8);
  if (version != 2)
    throw InputError(path, 0, 0,
                     "is GLB version " + std::to_string(version) + ", only 2 is supported");
  if (length > bytes.size())
    throw InputError(path, 0, 0,
                     "the GLB header declares " + std::to_string(length) +
                         " bytes, but the file has " + std::to_string(bytes.size()));
  if (length < glb_header_size + chunk_header_size)
    throw InputError(path, 0, 0, "the GLB header declares a length too short for any content");
  return bytes.first(length);
}

GltfFile read_chunks(const std::string& path, std::span<const uint8_t> bytes) {
  GltfFile file;
  file.is_glb = true;
  bytes = checked_extent(path, bytes);
  size_t at = glb_header_size;
  for (int index = 0; at < bytes.size(); ++index) {
    const std::string name = "GLB chunk " + std::to_string(index);
    if (bytes.size() - at < chunk_header_size)
      throw InputError(path, 0, 0, name + ": its header is cut short");
    const uint32_t length = little_endian_32(bytes, at), type = little_endian_32(bytes, at + 4);
    at += chunk_header_size;
    if (length > bytes.size() - at)
      throw InputError(path, 0, 0,
                       name + ": has " + std::to_string(length) + " bytes, but only " +
                           std::to_string(bytes.size() - at) + " are left");
    if (length % 4 != 0) throw InputError(path, 0, 0, name + ": its length is not a multiple of 4");
    const auto content = bytes.subspan(at, length);
    at += length;
    if (index == 0) {
      if (type != chunk_json) throw InputError(path, 0, 0, "the first GLB chunk is not JSON");
      if (length == 0) throw InputError(path, 0, 0, "the JSON chunk is empty");
      if (length > max_json_bytes) throw InputError(path, 0, 0, "the JSON chunk is too large");
      file.json_text.assign(content.begin(), content.end());
    } else if (type == chunk_json) {
      throw InputError(path, 0, 0, "has two JSON chunks");
    } else if (type == chunk_binary && !file.binary_chunk) {
      file.binary_chunk.emplace(content.begin(), content.end());
      file.is_out_of_order = index > 1;
    }  // clients must ignore chunks of other types [1] §4.4.3
  }
  return file;
}

}  // namespace

GltfFile read_gltf_file(const std::string& path) {
  const std::vector<uint8_t> bytes = read_file(path);
  if (bytes.empty()) throw InputError(path, 0, 0, "is empty");
  if (has_magic(bytes)) return read_chunks(path, bytes);
  if (lower_case_ending(path) == "glb") throw InputError(path, 0, 0, "is not a GLB file");
  if (bytes.size() > max_json_bytes) throw InputError(path, 0, 0, "is too large for a JSON text");
  GltfFile file;
  file.json_text.assign(bytes.begin(), bytes.end());
  return file;
}

}  // namespace troffer
