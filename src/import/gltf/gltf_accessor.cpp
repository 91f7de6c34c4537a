#include "import/gltf/gltf_accessor.h"

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "import/file.h"
#include "import/gltf/gltf_meshopt.h"
#include "import/gltf/gltf_uri.h"
#include "import/uri.h"

namespace troffer {

namespace {

// Limit on accessors without a buffer view, whose elements take no space in the file.
constexpr uint64_t max_elements_without_data = 4u << 20;
// Limits on the total over all accessors and views. Many accessors may share the same data, so the
// size of the file does not bound them.
constexpr uint64_t max_decoded_bytes = uint64_t(4) << 30;
constexpr uint64_t max_sparse_elements = 100'000'000, max_checked_indices = 1'000'000'000;

uint32_t component_size(uint32_t type) {
  switch (type) {
    case gltf_byte:
    case gltf_unsigned_byte:
      return 1;
    case gltf_short:
    case gltf_unsigned_short:
      return 2;
    case gltf_int:
    case gltf_unsigned_int:
    case gltf_float:
      return 4;
    case gltf_double:
      return 8;
    default:
      return 0;
  }
}

struct ElementShape {
  const char* name;
  uint32_t rows, columns;
};
constexpr std::array<ElementShape, 7> element_shapes{{{"SCALAR", 1, 1},
                                                      {"VEC2", 2, 1},
                                                      {"VEC3", 3, 1},
                                                      {"VEC4", 4, 1},
                                                      {"MAT2", 2, 2},
                                                      {"MAT3", 3, 3},
                                                      {"MAT4", 4, 4}}};

const ElementShape& shape_of(const JsonNode& type) {
  for (const ElementShape& shape : element_shapes)
    if (type.as_string() == shape.name) return shape;
  type.fail("'" + printable(type.as_string()) + "' is not an accessor type");
}

// Bytes from the first to the last byte of an element. Columns of matrices start at multiples of 4
// bytes [1] §3.6.2.4; no padding is required after the last column.
uint64_t size_of_element(const ElementShape& shape, uint32_t component_bytes) {
  const uint64_t column = uint64_t(shape.rows) * component_bytes;
  return (shape.columns - 1) * ((column + 3) / 4 * 4) + column;
}

// Bytes from one element to the next if byteStride is not given.
uint64_t packed_stride(const ElementShape& shape, uint32_t component_bytes) {
  const uint64_t size = size_of_element(shape, component_bytes);
  return shape.columns == 1 ? size : (size + 3) / 4 * 4;
}

template <class T>
T load(const uint8_t* at) {
  T value;
  std::memcpy(&value, at, sizeof value);  // assumes a little-endian machine, like the file's data
  return value;
}

// Returns a component as a float; normalised integers by the equations of [1] §3.6.2.2.
float component_as_float(const uint8_t* at, uint32_t type, bool is_normalized) {
  switch (type) {
    case gltf_byte: {
      const auto v = float(load<int8_t>(at));
      return is_normalized ? std::max(v / 127.0f, -1.0f) : v;
    }
    case gltf_unsigned_byte: {
      const auto v = float(*at);
      return is_normalized ? v / 255.0f : v;
    }
    case gltf_short: {
      const auto v = float(load<int16_t>(at));
      return is_normalized ? std::max(v / 32767.0f, -1.0f) : v;
    }
    case gltf_unsigned_short: {
      const auto v = float(load<uint16_t>(at));
      return is_normalized ? v / 65535.0f : v;
    }
    case gltf_int:
      return float(load<int32_t>(at));
    case gltf_unsigned_int:
      return float(load<uint32_t>(at));
    case gltf_double:
      return float(load<double>(at));
    default:
      return load<float>(at);
  }
}

uint32_t integer_at(const uint8_t* at, uint32_t type) {
  switch (type) {
    case gltf_unsigned_byte:
      return *at;
    case gltf_unsigned_short:
      return load<uint16_t>(at);
    default:
      return load<uint32_t>(at);
  }
}

bool is_unsigned_integer(uint32_t type) {
  return type == gltf_unsigned_byte || type == gltf_unsigned_short || type == gltf_unsigned_int;
}

// Returns the position of element i in the ascending list of sparse indices, or the list's length.
uint64_t sparse_position(const AccessorView& view, uint64_t i) {
  const uint64_t size = component_size(view.sparse_index_type);
  uint64_t first = 0, last = view.sparse_count;
  while (first < last) {
    const uint64_t middle = first + (last - first) / 2;
    const uint32_t at = integer_at(view.sparse_indices + middle * size, view.sparse_index_type);
    if (at == i) return middle;
    if (at < i)
      first = middle + 1;
    else
      last = middle;
  }
  return view.sparse_count;
}

std::vector<uint8_t> bytes_of_data_uri(const JsonNode& uri) {
  auto data = parse_data_uri(uri.as_string());
  if (!data) uri.fail("is a malformed data URI");
  return std::move(data->bytes);
}

}  // namespace

const uint8_t* AccessorView::element(uint64_t i) const {
  if (sparse_count > 0) {
    const uint64_t at = sparse_position(*this, i);
    // Elements read here have no padding: scalars, vectors or 4x4 floats.
    if (at < sparse_count) return sparse_values + at * components * component_size(component_type);
  }
  return data ? data + i * stride : nullptr;
}

std::array<float, 4> AccessorView::read(uint64_t i) const {
  std::array<float, 4> values{};
  const uint8_t* const at = element(i);
  if (!at) return values;
  const uint32_t size = component_size(component_type);
  for (uint32_t k = 0; k < std::min(components, 4u); ++k)
    values[k] = component_as_float(at + k * size, component_type, is_normalized);
  return values;
}

std::array<float, 16> AccessorView::read_matrix(uint64_t i) const {
  std::array<float, 16> values{};
  if (const uint8_t* const at = element(i)) std::memcpy(values.data(), at, sizeof values);
  return values;
}

uint32_t AccessorView::read_index(uint64_t i) const {
  const uint8_t* const at = element(i);
  return at ? integer_at(at, component_type) : 0;
}

GltfBuffers::GltfBuffers(const JsonNode& root, GltfFile& file) : folder_(folder_of(root.file())) {
  if (const auto buffers = root.find("buffers"))
    for (size_t i = 0; i < buffers->size(); ++i) load_buffer(buffers->element(i), i, file);
  if (const auto views = root.find("bufferViews"))
    for (size_t i = 0; i < views->size(); ++i) check_view(views->element(i));
  if (const auto accessors = root.find("accessors"))
    for (size_t i = 0; i < accessors->size(); ++i) check_accessor(accessors->element(i));
}

void GltfBuffers::load_buffer(const JsonNode& buffer, size_t index, GltfFile& file) {
  const JsonNode length = buffer.member("byteLength");
  Contents contents;
  if (const auto uri = buffer.find("uri")) {
    if (is_data_uri(uri->as_string())) {
      contents = std::make_shared<std::vector<uint8_t>>(bytes_of_data_uri(*uri));
    } else {
      // The normalised path is the key, so that different spellings share one copy.
      const std::string path = path_of_uri(*uri, folder_);
      Contents& cached = files_[std::filesystem::path(path).lexically_normal().string()];
      if (!cached) cached = std::make_shared<std::vector<uint8_t>>(read_file_of_uri(*uri, path));
      contents = cached;
    }
  } else if (file.is_glb && index == 0) {
    if (!file.binary_chunk) buffer.fail("has no uri, and the file has no binary chunk");
    contents = std::make_shared<std::vector<uint8_t>>(std::move(*file.binary_chunk));
  }
  if (contents && length.as_integer(~uint64_t(0)) > contents->size())
    length.fail("is " + std::to_string(length.as_integer(~uint64_t(0))) +
                ", but the buffer's data has only " + std::to_string(contents->size()) + " bytes");
  buffers_.push_back(std::move(contents));
}

std::optional<std::span<const uint8_t>> GltfBuffers::range(const JsonNode& where) const {
  const uint32_t index = where.member("buffer").as_index(buffers_.size(), "buffers");
  const uint64_t offset = where.integer_or("byteOffset", 0, ~uint64_t(0));
  const JsonNode length_node = where.member("byteLength");
  const uint64_t length = length_node.as_integer(~uint64_t(0));
  const Contents& contents = buffers_[index];
  if (!contents) return std::nullopt;
  const uint64_t available = contents->size();
  if (offset > available || length > available - offset)
    length_node.fail("the view ends after the " + std::to_string(available) + " bytes of buffer " +
                     std::to_string(index));
  return std::span(*contents).subspan(size_t(offset), size_t(length));
}

void GltfBuffers::check_view(const JsonNode& view) {
  View out;
  out.stride = view.integer_or("byteStride", 0, 252);
  std::optional<std::span<const uint8_t>> bytes;
  if (const auto compressed = meshopt_extension(view)) {
    const auto from = range(*compressed);
    if (!from) compressed->fail("its compressed data lies in a buffer without data");
    const uint64_t length = view.member("byteLength").as_integer(~uint64_t(0));
    if (length > max_decoded_bytes - decoded_bytes_)
      compressed->fail("the compressed data of this file decompresses to too much");
    decoded_bytes_ += length;
    decoded_.push_back(
        std::make_shared<std::vector<uint8_t>>(decode_meshopt(*compressed, *from, length)));
    bytes = *decoded_.back();
  } else {
    bytes = range(view);
  }
  out.has_data = bytes.has_value();
  if (bytes) out.bytes = *bytes;
  views_.push_back(out);
}

// Returns the first of `count` elements at `offset` of the buffer view that `where` names. Fails
// unless offset + stride (count - 1) + element_size <= length [1] §3.6.2.4.
const uint8_t* GltfBuffers::checked_range(const JsonNode& where, uint64_t offset, uint64_t count,
                                          uint64_t element_size, uint64_t stride) const {
  const JsonNode reference = where.member("bufferView");
  const uint32_t index = reference.as_index(views_.size(), "bufferViews");
  const View& view = views_[index];
  if (!view.has_data) reference.fail("lies in a buffer without data");
  const uint64_t available = view.bytes.size();
  // Division avoids overflow of stride (count - 1).
  const bool fits = count == 0 || (offset <= available && element_size <= available - offset &&
                                   (count - 1) <= (available - offset - element_size) / stride);
  if (!fits)
    where.fail("its " + std::to_string(count) + " elements do not fit into the " +
               std::to_string(available) + " bytes of buffer view " + std::to_string(index));
  return view.bytes.data() + (count == 0 ? 0 : offset);
}

void GltfBuffers::check_accessor(const JsonNode& accessor) {
  AccessorView view;
  const JsonNode type = accessor.member("componentType"), count = accessor.member("count");
  view.component_type = uint32_t(type.as_integer(0xffffffffu));
  const uint32_t bytes = component_size(view.component_type);
  if (bytes == 0) type.fail(std::to_string(view.component_type) + " is not a component type");
  const ElementShape& shape = shape_of(accessor.member("type"));
  view.components = shape.rows * shape.columns;
  view.count = count.as_integer(0xffffffffu);
  view.is_normalized = accessor.bool_or("normalized", false);
  const uint64_t element_size = size_of_element(shape, bytes);
  const uint64_t packed = packed_stride(shape, bytes);
  view.stride = packed;

  if (const auto reference = accessor.find("bufferView")) {
    const uint64_t stride = views_[reference->as_index(views_.size(), "bufferViews")].stride;
    if (stride > 0 && stride < element_size)
      reference->fail("its byteStride is less than the size of an element");
    if (stride > 0) view.stride = stride;
    view.data = checked_range(accessor, accessor.integer_or("byteOffset", 0, ~uint64_t(0)),
                              view.count, element_size, view.stride);
  }
  if (const auto sparse = accessor.find("sparse"))
    check_sparse(*sparse, view, element_size, packed);
  accessors_.push_back(view);
}

void GltfBuffers::check_sparse(const JsonNode& sparse, AccessorView& view, uint64_t element_size,
                               uint64_t packed) {
  const JsonNode count = sparse.member("count"), indices = sparse.member("indices"),
                 values = sparse.member("values"), type = indices.member("componentType");
  view.sparse_count = count.as_integer(view.count);
  view.sparse_index_type = uint32_t(type.as_integer(0xffffffffu));
  if (!is_unsigned_integer(view.sparse_index_type)) type.fail("is not an unsigned integer type");
  const uint32_t size = component_size(view.sparse_index_type);
  view.sparse_indices = checked_range(indices, indices.integer_or("byteOffset", 0, ~uint64_t(0)),
                                      view.sparse_count, size, size);
  view.sparse_values = checked_range(values, values.integer_or("byteOffset", 0, ~uint64_t(0)),
                                     view.sparse_count, element_size, packed);
  sparse_elements_ += view.sparse_count;
  if (sparse_elements_ > max_sparse_elements) count.fail("too many sparse elements in all");
  uint64_t least = 0;
  for (uint64_t i = 0; i < view.sparse_count; ++i) {
    const uint64_t at = integer_at(view.sparse_indices + i * size, view.sparse_index_type);
    if (at < least) indices.fail("the indices do not ascend");
    if (at >= view.count)
      indices.fail("an index is " + std::to_string(at) + ", but the accessor has " +
                   std::to_string(view.count) + " elements");
    least = at + 1;
  }
}

const AccessorView& GltfBuffers::accessor(const JsonNode& reference) const {
  const AccessorView& view = accessors_[reference.as_index(accessors_.size(), "accessors")];
  if (view.data == nullptr && view.count > max_elements_without_data)
    reference.fail("its accessor has no buffer view and more than " +
                   std::to_string(max_elements_without_data) + " elements");
  return view;
}

uint32_t GltfBuffers::largest_index(const JsonNode& reference, uint32_t index) {
  const auto known = largest_indices_.find(index);
  if (known != largest_indices_.end()) return known->second;
  const AccessorView& view = accessors_[index];
  checked_indices_ += view.count;
  if (checked_indices_ > max_checked_indices) reference.fail("too many vertex indices in all");
  uint32_t largest = 0;
  for (uint64_t i = 0; i < view.count; ++i) largest = std::max(largest, view.read_index(i));
  return largest_indices_[index] = largest;
}

bool GltfBuffers::is_normalized(const JsonNode& reference) const {
  return accessors_[reference.as_index(accessors_.size(), "accessors")].is_normalized;
}

std::span<const uint8_t> GltfBuffers::buffer_view(const JsonNode& reference) const {
  return views_[reference.as_index(views_.size(), "bufferViews")].bytes;
}

}  // namespace troffer
