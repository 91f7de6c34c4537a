#include "import/mitsuba/mitsuba_serialized.h"

#include <zlib.h>

#include <algorithm>
#include <cstring>

#include "base/error.h"
#include "import/limits.h"

namespace troffer {

namespace {

constexpr uint16_t magic = 0x041C;
constexpr uint64_t max_vertices = 180'000'000;
constexpr size_t chunk = size_t(1) << 16;  // numbers that are allocated at once

enum Flag : uint32_t {
  has_normals = 0x0001,
  has_uvs = 0x0002,
  has_colors = 0x0008,
  use_face_normals = 0x0010,
  single_precision = 0x1000,
  double_precision = 0x2000,
};

// Reader of little-endian values from deflated data.
class Inflated {
 public:
  Inflated(std::span<const uint8_t> data, const std::string& path) : path_(path) {
    stream_.next_in = const_cast<Bytef*>(data.data());  // zlib does not write there
    stream_.avail_in = uInt(std::min<size_t>(data.size(), 0xffffffffu));
    if (inflateInit(&stream_) != Z_OK) fail("cannot be decompressed");
  }
  ~Inflated() { inflateEnd(&stream_); }
  Inflated(const Inflated&) = delete;
  Inflated& operator=(const Inflated&) = delete;

  void read(void* to, size_t bytes) {
    stream_.next_out = static_cast<Bytef*>(to);
    stream_.avail_out = uInt(bytes);
    while (stream_.avail_out > 0) {
      const int status = inflate(&stream_, Z_NO_FLUSH);
      if (stream_.avail_out == 0) return;
      if (status != Z_OK) fail("the mesh is cut short or broken");
    }
  }
  template <class T>
  T value() {
    T v{};
    read(&v, sizeof v);
    return v;
  }
  // Reads `count` numbers of type T.
  template <class T>
  std::vector<double> reals(uint64_t count) {
    std::vector<double> out;
    std::vector<T> part(chunk);
    while (out.size() < count) {
      const size_t n = size_t(std::min<uint64_t>(chunk, count - out.size()));
      read(part.data(), n * sizeof(T));
      out.insert(out.end(), part.begin(), part.begin() + ptrdiff_t(n));
    }
    return out;
  }
  [[noreturn]] void fail(const std::string& what) const { throw InputError(path_, 0, 0, what); }

 private:
  z_stream stream_{};
  const std::string& path_;
};

template <class T>
T value_at(std::span<const uint8_t> file, size_t at, const std::string& path) {
  if (at > file.size() || file.size() - at < sizeof(T))
    throw InputError(path, 0, 0, "is cut short");
  T v{};
  std::memcpy(&v, file.data() + at, sizeof v);
  return v;
}

// Byte offset of mesh `index`, from the table at the end of the file.
uint64_t offset_of(std::span<const uint8_t> file, size_t index, const std::string& path) {
  const auto version = value_at<uint16_t>(file, 2, path);
  if (value_at<uint16_t>(file, 0, path) != magic || (version != 3 && version != 4))
    throw InputError(path, 0, 0, "is not a serialized mesh of version 3 or 4");
  const uint64_t count = value_at<uint32_t>(file, file.size() - 4, path);
  if (index >= count)
    throw InputError(
        path, 0, 0,
        "has " + std::to_string(count) + " meshes, none of index " + std::to_string(index));
  const uint64_t entry = version == 4 ? 8 : 4;
  if (count * entry + 4 > file.size()) throw InputError(path, 0, 0, "is cut short");
  const size_t at = size_t(file.size() - 4 - (count - index) * entry);
  const uint64_t offset =
      version == 4 ? value_at<uint64_t>(file, at, path) : value_at<uint32_t>(file, at, path);
  if (offset >= file.size()) throw InputError(path, 0, 0, "its table has offsets beyond its end");
  return offset;
}

std::vector<double> reals(Inflated& in, uint32_t flags, uint64_t count) {
  return (flags & double_precision) != 0 ? in.reals<double>(count) : in.reals<float>(count);
}

void read_vertices(Inflated& in, uint32_t flags, uint64_t count, AnchoredMesh& out) {
  const std::vector<double> p = reals(in, flags, count * 3);
  std::vector<Vec3d> positions;
  positions.reserve(size_t(count));
  for (size_t i = 0; i + 2 < p.size(); i += 3) positions.emplace_back(p[i], p[i + 1], p[i + 2]);
  set_positions(out, positions);
  if ((flags & has_normals) != 0) {
    const std::vector<double> n = reals(in, flags, count * 3);
    for (size_t i = 0; i + 2 < n.size(); i += 3)
      out.mesh.normals.emplace_back(Vec3d{n[i], n[i + 1], n[i + 2]});
  }
  if ((flags & has_uvs) != 0) {
    const std::vector<double> t = reals(in, flags, count * 2);
    for (size_t i = 0; i + 1 < t.size(); i += 2)
      out.mesh.uvs.emplace_back(float(t[i]), float(t[i + 1]));
  }
  if ((flags & has_colors) != 0) reals(in, flags, count * 3);
}

void read_triangles(Inflated& in, uint64_t count, uint64_t vertices, Mesh& mesh) {
  std::vector<uint32_t> part(chunk * 3);
  while (mesh.triangles.size() < count) {
    const size_t n = size_t(std::min<uint64_t>(chunk, count - mesh.triangles.size()));
    in.read(part.data(), n * 3 * sizeof(uint32_t));
    for (size_t i = 0; i < n * 3; ++i)
      if (part[i] >= vertices) in.fail("index " + std::to_string(part[i]) + " is out of range");
    for (size_t i = 0; i < n; ++i)
      mesh.triangles.push_back({part[3 * i], part[3 * i + 1], part[3 * i + 2]});
  }
}

}  // namespace

SerializedMesh read_serialized(std::span<const uint8_t> file, size_t index,
                               const std::string& path) {
  const uint64_t offset = offset_of(file, index, path);
  const auto version = value_at<uint16_t>(file, size_t(offset) + 2, path);
  if (value_at<uint16_t>(file, size_t(offset), path) != magic || (version != 3 && version != 4))
    throw InputError(path, 0, 0,
                     "mesh " + std::to_string(index) + " does not begin as a serialized mesh");
  Inflated in(file.subspan(size_t(offset) + 4), path);
  const auto flags = in.value<uint32_t>();
  SerializedMesh out;
  out.has_face_normals = (flags & use_face_normals) != 0;
  if (version == 4) {
    for (char c = in.value<char>(); c != '\0'; c = in.value<char>()) {
      if (out.mesh.mesh.name.size() > 4096) in.fail("a name does not end");
      out.mesh.mesh.name += c;
    }
  }
  const auto vertices = in.value<uint64_t>(), triangles = in.value<uint64_t>();
  if (vertices > max_vertices || triangles > max_scene_triangles) in.fail("the mesh is too large");
  read_vertices(in, flags, vertices, out.mesh);
  read_triangles(in, triangles, vertices, out.mesh.mesh);
  return out;
}

}  // namespace troffer
