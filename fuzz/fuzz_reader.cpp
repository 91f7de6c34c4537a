// Feeds a reader what libFuzzer makes, as a file with nothing beside it: it may refuse by
// InputError and nothing else.
#include <cstdint>
#include <string>
#include <string_view>

#include "base/error.h"
#include "image/read_image.h"
#include "import/import.h"
#include "import/luminaire.h"
#include "import/measured_bsdf.h"
#include "input_folder.h"

namespace {

using namespace troffer;

constexpr std::string_view ending = FUZZ_ENDING;

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
