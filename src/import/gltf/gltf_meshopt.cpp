#include "import/gltf/gltf_meshopt.h"

#include <meshoptimizer.h>

namespace troffer {

namespace {

// Limit on the ratio of decoded to compressed bytes. The vertex codec stores sixteen zero bytes in
// two bits, which is a ratio of 64; the rest is margin.
constexpr uint64_t max_ratio = 256, always_allowed_bytes = 4096;

void decode_mode(const JsonNode& extension, std::span<const uint8_t> in, size_t count,
                 size_t stride, std::vector<uint8_t>& out) {
  const JsonNode mode_node = extension.member("mode");
  const std::string& mode = mode_node.as_string();
  int status = 0;
  if (mode == "ATTRIBUTES") {
    if (stride == 0 || stride % 4 != 0 || stride > 256)
      extension.fail("its byteStride should be a multiple of 4, at most 256");
    status = meshopt_decodeVertexBuffer(out.data(), count, stride, in.data(), in.size());
  } else if (mode == "TRIANGLES" || mode == "INDICES") {
    if (stride != 2 && stride != 4) extension.fail("its byteStride should be 2 or 4");
    if (mode == "TRIANGLES" && count % 3 != 0)
      extension.fail("its count should be a multiple of 3");
    status = mode == "TRIANGLES"
                 ? meshopt_decodeIndexBuffer(out.data(), count, stride, in.data(), in.size())
                 : meshopt_decodeIndexSequence(out.data(), count, stride, in.data(), in.size());
  } else {
    mode_node.fail("'" + printable(mode) + "' is not a compression mode");
  }
  if (status != 0) extension.fail("its compressed data is broken, or of a newer version");
}

void apply_filter(const JsonNode& extension, size_t count, size_t stride,
                  std::vector<uint8_t>& out) {
  const std::string filter = extension.string_or("filter", "NONE");
  if (filter == "NONE") return;
  const bool is_octahedral = filter == "OCTAHEDRAL", is_quaternion = filter == "QUATERNION";
  if (!is_octahedral && !is_quaternion && filter != "EXPONENTIAL")
    extension.fail("'" + printable(filter) + "' is not a filter");
  if ((is_octahedral && stride != 4 && stride != 8) || (is_quaternion && stride != 8) ||
      stride % 4 != 0)
    extension.fail("its byteStride does not match its filter");
  if (count == 0) return;
  if (is_octahedral)
    meshopt_decodeFilterOct(out.data(), count, stride);
  else if (is_quaternion)
    meshopt_decodeFilterQuat(out.data(), count, stride);
  else
    meshopt_decodeFilterExp(out.data(), count, stride);
}

}  // namespace

std::optional<JsonNode> meshopt_extension(const JsonNode& view) {
  auto found = view.extension("EXT_meshopt_compression");
  return found ? found : view.extension("KHR_meshopt_compression");
}

std::vector<uint8_t> decode_meshopt(const JsonNode& extension, std::span<const uint8_t> compressed,
                                    uint64_t byte_length) {
  const uint64_t stride = extension.member("byteStride").as_integer(256);
  const uint64_t count = extension.member("count").as_integer(0xffffffffu);
  if (stride * count != byte_length)
    extension.fail("its count times its byteStride is not the length of the buffer view");
  if (byte_length > compressed.size() * max_ratio + always_allowed_bytes)
    extension.fail("its data is too short for its decoded size");
  std::vector<uint8_t> out(size_t(byte_length), uint8_t(0));
  decode_mode(extension, compressed, size_t(count), size_t(stride), out);
  apply_filter(extension, size_t(count), size_t(stride), out);
  return out;
}

}  // namespace troffer
