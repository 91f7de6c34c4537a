// Feeds a reader what libFuzzer makes: it may refuse by InputError and nothing else. Readers take
// paths, so each input becomes a file in a folder of its own (in memory, where there is /dev/shm),
// beside it nothing.
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

#include "base/error.h"
#include "image/read_image.h"
#include "import/import.h"
#include "import/luminaire.h"
#include "import/measured_bsdf.h"

namespace {

namespace fs = std::filesystem;
using namespace troffer;

constexpr std::string_view ending = FUZZ_ENDING;

fs::path make_folder() {
  const fs::path memory = "/dev/shm";
  const fs::path above = fs::is_directory(memory) ? memory : fs::temp_directory_path();
  fs::path folder = above / ("troffer_fuzz_" + std::to_string(getpid()));
  fs::create_directories(folder);
  return folder;
}

struct Folder {
  fs::path path = make_folder();
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
};

void write(const fs::path& path, const void* data, size_t size) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr || std::fwrite(data, 1, size, file) != size) std::abort();
  std::fclose(file);
}

void read(const fs::path& folder, const std::string& path) {
  if constexpr (ending == "ies" || ending == "ldt") {
    WarningLog warnings;
    read_luminaire(path, warnings);
  } else if constexpr (ending == "mtl") {
    constexpr std::string_view user =
        "mtllib input.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";
    write(folder / "user.obj", user.data(), user.size());
    import_scene((folder / "user.obj").string());
  } else if constexpr (ending == "serialized") {
    constexpr std::string_view user =
        "<scene version='3.0.0'><shape type='serialized'><string name='filename' "
        "value='input.serialized'/></shape></scene>";
    write(folder / "user.xml", user.data(), user.size());
    import_scene((folder / "user.xml").string());
  } else if constexpr (ending == "bsdf") {
    WarningLog warnings;
    measured_material(folder.string(), "input.bsdf", warnings);
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
  static const Folder folder;
  const fs::path path = folder.path / ("input." + std::string(ending));
  write(path, data, size);
  try {
    read(folder.path, path.string());
  } catch (const InputError&) {
    return 0;
  }
  return 0;
}
