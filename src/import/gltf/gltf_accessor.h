// Buffers, buffer views and accessors: typed, bounds-checked access to binary data.
// References: [1] Khronos, glTF 2.0 Specification, §3.6 (Binary Data Storage);
//   [2] Khronos extension EXT_meshopt_compression.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "import/gltf/gltf_file.h"
#include "import/gltf/gltf_json.h"

namespace troffer {

// What a component is, as files number it [1] §3.6.2.2.
enum GltfComponentType : uint32_t {
  gltf_byte = 5120,
  gltf_unsigned_byte = 5121,
  gltf_short = 5122,
  gltf_unsigned_short = 5123,
  gltf_int = 5124,  // for attributes of an application's own only, which are not read
  gltf_unsigned_int = 5125,
  gltf_float = 5126,
  gltf_double = 5130,  // likewise
};

// A checked accessor: any index below `count` may be read. Elements are decoded when asked for, so
// that a view costs no memory, whatever its count.
struct AccessorView {
  const uint8_t* data = nullptr;  // null: zeros, but for the sparse elements
  uint64_t count = 0;
  uint64_t stride = 0;
  uint32_t component_type = 0;  // GltfComponentType
  uint32_t components = 0;      // 1 … 16
  bool is_normalized = false;
  // Substituted elements [1] §3.6.2.3; indices ascend.
  uint64_t sparse_count = 0;
  uint32_t sparse_index_type = 0;
  const uint8_t* sparse_indices = nullptr;
  const uint8_t* sparse_values = nullptr;

  // The first components of element i as floats, normalised integers mapped to [0,1] or [-1,1];
  // zero for components that the accessor does not have.
  std::array<float, 4> read(uint64_t i) const;
  // All components of element i of an accessor of 4x4 floats.
  std::array<float, 16> read_matrix(uint64_t i) const;
  // Element i of an unsigned integer accessor of one component.
  uint32_t read_index(uint64_t i) const;

 private:
  const uint8_t* element(uint64_t i) const;
};

// The binary data of one document, which must outlive it. All lengths are compared in 64 bits
// before anything is read.
class GltfBuffers {
 public:
  // Loads every buffer: from its data URI, from a file in the scene's folder, or from the GLB's
  // binary chunk; then checks all buffer views and accessors, used or not, and decodes views that
  // are compressed [2]. InputError at the JSON value that is wrong.
  GltfBuffers(const JsonNode& root, GltfFile& file);

  // Of the buffer view that `reference` names; empty where its buffer has no data.
  std::span<const uint8_t> buffer_view(const JsonNode& reference) const;
  // The accessor that `reference` names. Fails where it has no data of its own and is larger than
  // what is taken for granted.
  const AccessorView& accessor(const JsonNode& reference) const;
  // Of an accessor whose data is elsewhere.
  bool is_normalized(const JsonNode& reference) const;
  // Of an accessor of unsigned integer scalars; 0 for an empty one. Remembered. Fails at
  // `reference` where the file makes too much work of it.
  uint32_t largest_index(const JsonNode& reference, uint32_t index);

 private:
  struct View {
    std::span<const uint8_t> bytes;
    uint64_t stride = 0;  // 0 = tightly packed
    bool has_data = true;
  };
  using Contents = std::shared_ptr<const std::vector<uint8_t>>;

  // The bytes that /buffer, /byteOffset and /byteLength of an object name; nothing where the buffer
  // has no data.
  std::optional<std::span<const uint8_t>> range(const JsonNode& where) const;
  void load_buffer(const JsonNode& buffer, size_t index, GltfFile& file);
  void check_view(const JsonNode& view);
  void check_accessor(const JsonNode& accessor);
  void check_sparse(const JsonNode& sparse, AccessorView& view, uint64_t element_size,
                    uint64_t packed);
  const uint8_t* checked_range(const JsonNode& where, uint64_t offset, uint64_t count,
                               uint64_t element_size, uint64_t stride) const;

  std::string folder_;
  std::map<std::string, Contents> files_;
  std::vector<Contents> buffers_;  // null: a buffer without data
  std::vector<View> views_;
  std::vector<Contents> decoded_;  // of compressed views
  uint64_t decoded_bytes_ = 0;
  std::vector<AccessorView> accessors_;
  std::map<uint32_t, uint32_t> largest_indices_;  // by accessor
  uint64_t sparse_elements_ = 0, checked_indices_ = 0;
};

}  // namespace troffer
