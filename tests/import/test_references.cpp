// Tests of file names as other machines write them: backslashes, drives, another case.
#include <doctest/doctest.h>

#include <filesystem>
#include <string>

#include "base/error.h"
#include "import/file.h"
#include "import/gltf_builder.h"
#include "import/import.h"
#include "import/reference_notes.h"
#include "scene_checks.h"
#include "temp_folder.h"

using namespace troffer;

namespace test_references {

namespace {

// Returns a red texel.
std::string red_tga() {
  std::string tga(18, '\0');
  tga[2] = 2;
  tga[12] = tga[14] = 1;
  tga[16] = 24;
  return tga + std::string("\x00\x00\xff", 3);
}

// Checks that the scene has the red image and reports the name under which it was found.
void check_red(const Scene& scene, const std::string& found = "is read from 'textures/floor.tga'") {
  bool is_there = false;
  for (const Texture& t : scene.textures)
    is_there = is_there || (t.width == 1 && !t.texels8.empty() && t.texels8[0] == 255);
  CHECK(is_there);
  const std::string first =
      scene.warnings.entries().empty() ? "no warning" : scene.warnings.entries()[0].text;
  CAPTURE(first);
  const bool is_noted = found.empty() || has_warning(scene, found);
  CHECK(is_noted);
}

const char* const obj =
    "mtllib A.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n";

}  // namespace

TEST_CASE("images are found whatever the separator and the case") {
  const TempFolder folder;
  folder.write("textures/floor.tga", red_tga());
  for (const char* name :
       {"textures\\floor.tga", "Textures/Floor.TGA", "TEXTURES\\FLOOR.tga",
        "C:\\Users\\me\\scene\\textures\\floor.tga", "d:/scene/Textures/floor.tga",
        "\\\\server\\share\\textures\\floor.tga"}) {
    CAPTURE(std::string(name));
    folder.write("a.mtl", "newmtl m\nmap_Kd " + std::string(name) + "\n");
    // In .mtl files a plain backslash counts as a slash and needs no note.
    if (name[0] != '\\')
      check_red(import_scene(folder.write("s.obj", obj)),
                std::string(name) == "textures\\floor.tga" ? "" : "textures/floor.tga'");
    const Scene pbrt = import_scene(folder.write(
        "s.pbrt", "WorldBegin\nTexture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"" +
                      std::string(name) +
                      "\"\nMaterial \"diffuse\" \"texture reflectance\" \"t\"\n"
                      "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" "
                      "[0 1 2]\n"));
    check_red(pbrt);
    std::string uri = name;
    for (size_t at = 0; (at = uri.find('\\', at)) != std::string::npos; at += 2)
      uri.insert(at, 1, '\\');
    check_red(import_scene(folder.write(
        "s.gltf", square_scene("[{'mesh':0}]", "'images':[{'uri':'" + uri +
                                                   "'}],'textures':[{'source':0}],'materials':[{"
                                                   "'pbrMetallicRoughness':{'baseColorTexture':{"
                                                   "'index':0}}}]"))));
    check_red(import_scene(folder.write(
        "s.xml",
        "<scene version=\"3.0.0\"><shape type=\"rectangle\"><bsdf type=\"diffuse\">"
        "<texture type=\"bitmap\" name=\"reflectance\"><string name=\"filename\" value=\"" +
            std::string(name) + "\"/></texture></bsdf></shape></scene>")));
  }
}

TEST_CASE("includes, meshes and function files are found too") {
  const TempFolder folder;
  folder.write("parts/floor.rad", "void plastic p 0 0 5 .5 .5 .5 0 0\np sphere s 0 0 4 0 0 0 1\n");
  for (const char* command : {"!cat Parts\\Floor.rad\n", "!xform -t 1 0 0 parts\\FLOOR.RAD\n"}) {
    const Scene s = import_scene(folder.write("s.rad", command));
    CHECK(s.spheres.size() == 1);
    CHECK(has_warning(s, "is read from 'parts/floor.rad'"));
  }
  folder.write("parts/floor.pbrt", "Shape \"sphere\"\n");
  for (const char* name : {"parts\\floor.pbrt", "PARTS/floor.pbrt"})
    CHECK(
        import_scene(folder.write("s.pbrt", "WorldBegin\nInclude \"" + std::string(name) + "\"\n"))
            .spheres.size() == 1);
  folder.write("parts/tri.ply",
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
               "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
               "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  CHECK(import_scene(folder.write("s.xml",
                                  "<scene version=\"3.0.0\"><shape type=\"ply\"><string "
                                  "name=\"filename\" value=\"Parts\\TRI.ply\"/></shape></scene>"))
            .meshes.size() == 1);
}

TEST_CASE("other spellings never lead out of the folder, and an exact match has priority") {
  const TempFolder folder;
  folder.write("secret.txt", "x");
  folder.write("inner/a.txt", "x");
  folder.write("inner/B.txt", "x");
  folder.write("inner/b.txt", "x");
  folder.write("inner/with\\slash.txt", "x");
  const std::string inner = folder.path("inner");
  for (const char* name : {"..\\secret.txt", "C:\\..\\secret.txt", "..\\inner\\..\\secret.txt"}) {
    CAPTURE(name);
    const ConfinedPath path = confined_path(inner, name);
    std::error_code error;
    CHECK_FALSE(std::filesystem::exists(path.path, error));
  }
  CHECK_FALSE(confined_path(inner, "../secret.txt").is_fine());
  CHECK_FALSE(confined_path(inner, "/secret.txt").is_fine());
  const ReferenceNotes notes;
  CHECK(confined_path(inner, "b.txt").path == inner + "/b.txt");
  CHECK(confined_path(inner, "B.txt").path == inner + "/B.txt");
  CHECK(confined_path(inner, "with\\slash.txt").path == inner + "/with\\slash.txt");
  CHECK(confined_path(inner, "gone.txt").path == inner + "/gone.txt");
  CHECK(notes.notes().empty());
  CHECK(confined_path(inner, "A.TXT").path == inner + "/a.txt");
  CHECK(notes.notes().size() == 1);
}

}  // namespace test_references
