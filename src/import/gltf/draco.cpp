#include "import/gltf/draco.h"

#include <draco/compression/decode.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>

#include <algorithm>
#include <new>
#include <stdexcept>

namespace troffer {

namespace {

// Limits on what the header may claim. A flat grid compresses to almost nothing, so small meshes
// are always allowed; larger ones must be in proportion to the data.
constexpr uint64_t always_allowed = 1 << 20, triangles_per_byte = 1024;
constexpr uint64_t max_attribute_values = 400'000'000;

struct Claim {
  uint64_t triangles = 0, vertices = 0;
};

// Reads the triangle and vertex counts from the header of a bitstream of version 2.x: "DRACO",
// version, geometry type, method, flags, metadata, counts. Returns false if `bytes` is not such
// data.
bool read_claim(std::span<const uint8_t> bytes, Claim& claim) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::DracoHeader header;
  if (!buffer.Decode(&header.draco_string, 5) || !buffer.Decode(&header.version_major) ||
      !buffer.Decode(&header.version_minor) || !buffer.Decode(&header.encoder_type) ||
      !buffer.Decode(&header.encoder_method) || !buffer.Decode(&header.flags))
    return false;
  if (header.version_major != 2 || header.encoder_type != draco::TRIANGULAR_MESH) return false;
  buffer.set_bitstream_version(DRACO_BITSTREAM_VERSION(header.version_major, header.version_minor));
  if ((header.flags & METADATA_FLAG_MASK) != 0) {
    draco::GeometryMetadata metadata;
    if (!draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &metadata)) return false;
  }
  uint32_t first = 0, second = 0;
  uint8_t traversal = 0;
  const bool has_varints = header.version_minor >= 2;
  const auto read = [&](uint32_t& n) {
    return has_varints ? draco::DecodeVarint(&n, &buffer) : buffer.Decode(&n);
  };
  if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING) {
    if (!buffer.Decode(&traversal)) return false;
    uint32_t added = 0;  // vertices added by the encoder, in versions below 2.2
    if (!has_varints && !draco::DecodeVarint(&added, &buffer)) return false;
    if (!draco::DecodeVarint(&first, &buffer) || !draco::DecodeVarint(&second, &buffer))
      return false;
    claim = {second, first};
    return true;
  }
  if (!read(first) || !read(second)) return false;
  claim = {first, second};
  return true;
}

float largest_of(draco::DataType type) {
  switch (type) {
    case draco::DT_INT8:
      return 127;
    case draco::DT_UINT8:
      return 255;
    case draco::DT_INT16:
      return 32767;
    case draco::DT_UINT16:
      return 65535;
    default:
      return 1;
  }
}

bool read_attribute(const draco::Mesh& mesh, uint32_t id, DracoMesh& out) {
  const draco::PointAttribute* const from = mesh.GetAttributeByUniqueId(id);
  if (from == nullptr) return true;
  DracoAttribute to;
  to.id = id;
  to.components = uint32_t(std::clamp<int>(from->num_components(), 1, 4));
  to.largest = from->normalized() ? 1 : largest_of(from->data_type());
  if (out.vertex_count * to.components > max_attribute_values) return false;
  to.values.resize(size_t(out.vertex_count) * to.components);
  for (uint32_t v = 0; v < out.vertex_count; ++v) {
    const draco::AttributeValueIndex value = from->mapped_index(draco::PointIndex(v));
    if (value.value() >= from->size() ||
        !from->ConvertValue<float>(value, int8_t(to.components), &to.values[v * to.components]))
      return false;
  }
  out.attributes.push_back(std::move(to));
  return true;
}

bool read_triangles(const draco::Mesh& mesh, DracoMesh& out) {
  out.indices.reserve(size_t(mesh.num_faces()) * 3);
  for (uint32_t i = 0; i < mesh.num_faces(); ++i) {
    const draco::Mesh::Face& face = mesh.face(draco::FaceIndex(i));
    for (size_t k = 0; k < 3; ++k) {
      if (face[k].value() >= out.vertex_count) return false;
      out.indices.push_back(face[k].value());
    }
  }
  return true;
}

DracoMesh failed(const std::string& problem) {
  DracoMesh mesh;
  mesh.problem = problem;
  return mesh;
}

DracoMesh decode(std::span<const uint8_t> bytes, std::span<const uint32_t> ids) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) return failed("broken Draco data");
  const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
  DracoMesh out;
  out.vertex_count = mesh->num_points();
  if (!read_triangles(*mesh, out)) return failed("broken Draco data: an index is out of range");
  for (const uint32_t id : ids)
    if (out.find(id) == nullptr && !read_attribute(*mesh, id, out))
      return failed("broken Draco data: an attribute cannot be read");
  return out;
}

}  // namespace

const DracoAttribute* DracoMesh::find(uint32_t id) const {
  for (const DracoAttribute& a : attributes)
    if (a.id == id) return &a;
  return nullptr;
}

DracoMesh decode_draco(std::span<const uint8_t> bytes, std::span<const uint32_t> ids,
                       uint64_t max_triangles) {
  try {
    Claim claim;
    if (!read_claim(bytes, claim)) return failed("no Draco mesh of version 2");
    const uint64_t allowed = std::max(always_allowed, triangles_per_byte * bytes.size());
    if (claim.triangles > max_triangles) return failed("the Draco data has too many triangles");
    if (claim.triangles > allowed || claim.vertices > 3 * allowed)
      return failed("the Draco data is too short for its decoded size");
    return decode(bytes, ids);
  } catch (const std::bad_alloc&) {
    return failed("not enough memory for the Draco data");
  } catch (const std::length_error&) {
    return failed("broken Draco data");
  }
}

}  // namespace troffer
