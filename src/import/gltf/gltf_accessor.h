// Buffers, buffer views and accessors of glTF: typed, bounds-checked access to binary data.
// GltfBuffers loads and checks all of them once; AccessorView then decodes single elements on
// demand.
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

// Component types, numbered as in files [1] §3.6.2.2.
enum GltfComponentType : uint32_t {
  gltf_byte = 5120,
  gltf_unsigned_byte = 5121,
  gltf_short = 5122,
  gltf_unsigned_short = 5123,
  gltf_int = 5124,  // only for application-specific attributes, which are not read
  gltf_unsigned_int = 5125,
  gltf_float = 5126,
  gltf_double = 5130,  // only for application-specific attributes, which are not read
};

// A checked accessor: any element below `count` may be read. Elements are decoded on access, so
// that a view costs no memory, whatever its count.
struct AccessorView {
  const uint8_t* data = nullptr;  // null: all elements are zero, except sparse ones
  uint64_t count = 0;
  uint64_t stride = 0;
  uint32_t component_type = 0;  // GltfComponentType
  uint32_t components = 0;      // 1 to 16
  bool is_normalized = false;
  // Sparse elements, which replace those of `data` [1] §3.6.2.3. Their indices ascend.
  uint64_t sparse_count = 0;
  uint32_t sparse_index_type = 0;
  const uint8_t* sparse_indices = nullptr;
  const uint8_t* sparse_values = nullptr;

  // Returns up to four components of element i as floats; components that the accessor lacks are 0.
  // Normalised integers are mapped to [0,1] or [-1,1].
  std::array<float, 4> read(uint64_t i) const;
  // Returns all components of element i. The accessor must be of type MAT4 with float components.
  std::array<float, 16> read_matrix(uint64_t i) const;
  // Returns element i. The accessor must be an unsigned integer scalar.
  uint32_t read_index(uint64_t i) const;

 private:
  const uint8_t* element(uint64_t i) const;
};

// Binary data of one document. It must outlive all AccessorViews and spans taken from it. Sizes are
// compared in 64 bits before anything is read.
class GltfBuffers {
 public:
  // Loads every buffer from its data URI, a file in the scene's folder or the GLB's binary chunk.
  // Then checks all buffer views and accessors, used or not, and decodes compressed views [2].
  // Takes the binary chunk out of `file`. Throws InputError at the JSON value that is wrong.
  GltfBuffers(const JsonNode& root, GltfFile& file);

  // Returns the bytes of the buffer view that `reference` names; empty if its buffer has no data.
  std::span<const uint8_t> buffer_view(const JsonNode& reference) const;
  // Returns the accessor that `reference` names. Fails if it has no buffer view and more than 4 Mi
  // elements, because such an accessor costs the file nothing.
  const AccessorView& accessor(const JsonNode& reference) const;
  // True if the accessor's integers are normalised. Also works for accessors whose data is
  // compressed elsewhere (Draco).
  bool is_normalized(const JsonNode& reference) const;
  // Returns the largest value of accessor `index`, an unsigned integer scalar; 0 if it is empty.
  // Results are cached. Fails at `reference` if all such accessors together have too many elements.
  uint32_t largest_index(const JsonNode& reference, uint32_t index);

 private:
  struct View {
    std::span<const uint8_t> bytes;
    uint64_t stride = 0;  // bytes; 0: tightly packed
    bool has_data = true;
  };
  using Contents = std::shared_ptr<const std::vector<uint8_t>>;

  // Returns the bytes that `where` names by its buffer, byteOffset and byteLength; nothing if the
  // buffer has no data.
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
  std::vector<Contents> decoded_;  // contents of compressed views
  uint64_t decoded_bytes_ = 0;
  std::vector<AccessorView> accessors_;
  std::map<uint32_t, uint32_t> largest_indices_;  // by accessor
  uint64_t sparse_elements_ = 0, checked_indices_ = 0;
};

}  // namespace troffer
