// Feeds libFuzzer's data to a reader, as a file without companions. It may refuse with InputError
// only. Reading in pieces must give the same result as reading at once.
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "base/error.h"
#include "image/raster.h"
#include "image/read_image.h"
#include "import/file.h"
#include "import/import.h"
#include "import/luminaire/luminaire.h"
#include "import/measured_bsdf.h"
#include "import/mesh/obj.h"
#include "import/mesh/ply.h"
#include "import/mesh/stl.h"
#include "input_folder.h"

namespace {

using namespace troffer;

constexpr std::string_view ending = FUZZ_ENDING;

template <class T>
void append_bytes(std::string& out, const std::vector<T>& values) {
  out.append(std::to_string(values.size()) + ":");
  if (!values.empty())
    out.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

void append_mesh(std::string& out, const Mesh& mesh) {
  append_bytes(out, mesh.positions);
  append_bytes(out, mesh.normals);
  append_bytes(out, mesh.uvs);
  append_bytes(out, mesh.triangles);
}

// Returns the outcome of reading a file: the error, or its meshes and warnings.
std::string outcome(const std::string& path, size_t piece_bytes) {
  const PieceReading how{piece_bytes, {}};
  std::string out;
  WarningLog warnings;
  try {
    if (ending == "ply") {
      append_mesh(out, read_ply(path, warnings, {60'000'000, how}).mesh);
    } else {
      const Scene scene = ending == "obj" ? import_obj(path, how) : import_stl(path, how);
      for (const Mesh& mesh : scene.meshes) append_mesh(out, mesh);
      warnings = scene.warnings;
    }
  } catch (const InputError& error) {
    return error.what();
  }
  for (const Warning& w : warnings.entries()) out += w.text + std::to_string(w.count);
  return out;
}

void read(const InputFolder& folder, const std::string& path) {
  if constexpr (ending == "ies" || ending == "ldt") {
    WarningLog warnings;
    read_luminaire(path, warnings);
  } else if constexpr (ending == "mtl") {
    constexpr std::string_view user =
        "mtllib input.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";
    import_scene(folder.write("user.obj", user.data(), user.size()));
  } else if constexpr (ending == "serialized") {
    constexpr std::string_view user =
        "<scene version='3.0.0'><shape type='serialized'><string name='filename' "
        "value='input.serialized'/></shape></scene>";
    import_scene(folder.write("user.xml", user.data(), user.size()));
  } else if constexpr (ending == "bsdf") {
    WarningLog warnings;
    measured_material(folder.path(), "input.bsdf", warnings);
  } else if constexpr (ending == "png" || ending == "jpg" || ending == "hdr" || ending == "pfm" ||
                       ending == "exr" || ending == "webp" || ending == "tga") {
    read_image(path, size_t(1) << 22);
    Raster raster = decode_raster(read_file(path, size_t(1) << 26), path, size_t(1) << 22);
    convert_to_srgb(raster);
  } else if constexpr (ending == "obj" || ending == "ply" || ending == "stl") {
    import_scene(path);
    if (outcome(path, 0) != outcome(path, 61)) std::abort();
  } else {
    ImportOptions options;
    if (ending == "gltf" || ending == "glb") options.time = 0.5;
    import_scene(path, options);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const InputFolder folder;
  const std::string path = folder.write("input." + std::string(ending), data, size);
  try {
    read(folder, path);
  } catch (const InputError&) {
    return 0;
  }
  return 0;
}
