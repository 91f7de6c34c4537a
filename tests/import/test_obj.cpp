// Tests of OBJ and MTL files.
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "base/error.h"
#include "base/random.h"
#include "base/units.h"
#include "image/write_image.h"
#include "import/mesh/obj.h"
#include "import/mesh_clean.h"
#include "import/polygon.h"
#include "import/reference_notes.h"
#include "scene_checks.h"
#include "temp_folder.h"

using namespace troffer;

namespace test_obj {

namespace {

Scene import_text(const std::string& obj, const std::string& mtl = "") {
  const TempFolder folder;
  if (!mtl.empty()) folder.write("m.mtl", mtl);
  return import_obj(folder.write("m.obj", (mtl.empty() ? "" : "mtllib m.mtl\n") + obj));
}

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

Material material_of(const std::string& mtl) {
  const Scene scene = import_text(square + "usemtl a\nf 1 2 3\n", "newmtl a\n" + mtl);
  return scene.materials.at(scene.meshes.at(0).material);
}

double area_of(const Scene& scene) {
  double sum = 0;
  for (const Mesh& mesh : scene.meshes) sum += area_of(mesh);
  return sum;
}

}  // namespace

TEST_CASE("every form of face") {
  const std::string data = square + "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 2\n# comment\r\n";
  for (const char* face :
       {"f 1 2 3 4", "f 1/1 2/2 3/3 4/4", "f 1//1 2//1 3//1 4//1", "f 1/1/1 2/2/1 3/3/1 4/4/1",
        "f -4 -3 -2 -1", "f -4/-4/-1 -3/-3/-1 -2/-2/-1 -1/-1/-1", "f 1 2 \\\n 3 4",
        "f\t1  2 3 4 # quad", "f 1 2 3 4\r\n", "f 1 2 3\nf 1 3 4"}) {
    CAPTURE(face);
    const Scene scene = import_text(data + face);
    REQUIRE(scene.meshes.size() == 1);
    const Mesh& mesh = scene.meshes[0];
    CHECK(mesh.triangles.size() == 2);
    CHECK(mesh.positions.size() == 4);  // shared
    CHECK(area_of(mesh) == doctest::Approx(1));
    CHECK(area_vector(mesh, mesh.triangles[0]).z > 0);
    const std::string text = face;
    if (text.find('/') != std::string::npos && text.find("//") == std::string::npos)
      CHECK(mesh.uvs.at(2) == Vec2(1, 1));
    if (text.find("/1 ") != std::string::npos && text.find("//") != std::string::npos)
      CHECK(mesh.normals.at(0) == Vec3(0, 0, 1));
    CHECK(scene.cameras.empty());
    CHECK_FALSE(scene.is_photometric);
    CHECK(scene.warnings.entries().empty());
  }
}

TEST_CASE("vertices that differ in normal or texture coordinate are split") {
  const Scene scene = import_text(square + "vt 0 0\nvt 1 1\nf 1/1 2/1 3/1\nf 1/2 3/2 4/2\n");
  CHECK(scene.meshes.at(0).positions.size() == 6);
}

TEST_CASE("concave polygons keep their area when triangulated") {
  // An arrow head, a comb, a star: shoelace areas.
  const Scene arrow = import_text("v 0 0 0\nv 2 1 0\nv 0 2 0\nv 1 1 0\nf 1 2 3 4\n");
  CHECK(area_of(arrow) == doctest::Approx(1));
  std::vector<Vec3> star;
  for (int i = 0; i < 40; ++i) {
    const double r = i % 2 == 0 ? 1 : 0.3, phi = 2 * pi * i / 40;
    star.emplace_back(float(r * std::cos(phi)), 2.0f, float(-r * std::sin(phi)));
  }
  double area = 0;
  for (size_t i = 0; i < 40; ++i) {
    const Vec3 a = star[i], b = star[(i + 1) % 40];
    area += 0.5 * (double(a.x) * double(-b.z) - double(-a.z) * double(b.x));
  }
  std::vector<Triangle> triangles;
  triangulate(star, triangles);
  CHECK(triangles.size() == 38);
  double sum = 0;
  for (const Triangle& t : triangles) {
    const Vec3d n =
        cross(Vec3d(star[t[1]]) - Vec3d(star[t[0]]), Vec3d(star[t[2]]) - Vec3d(star[t[0]]));
    CHECK(n.y > -1e-9);  // all wind like the polygon
    sum += 0.5 * length(n);
  }
  CHECK(sum == doctest::Approx(area).epsilon(1e-6));
}

TEST_CASE("one mesh per object, group and material") {
  const Scene scene = import_text(square +
                                      "o first thing\nusemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\n"
                                      "usemtl a\nf 2 3 4\ng second\nf 1 2 4\n",
                                  "newmtl a\nKd 1 0 0\nnewmtl b\nKd 0 1 0\n");
  REQUIRE(scene.meshes.size() == 3);
  CHECK(scene.meshes[0].name == "first thing");
  CHECK(scene.meshes[0].triangles.size() == 2);
  CHECK(scene.meshes[2].name == "second");
  CHECK(scene.materials.at(scene.meshes[1].material).base_color.value == Rgb(0, 1, 0));
}

TEST_CASE("errors in OBJ files have their places") {
  struct Row {
    const char* text;
    int line, column;
  };
  for (const Row& row :
       {Row{"v 1 2\n", 1, 6}, Row{"v 1 bleh 3\n", 1, 5}, Row{"v\n", 1, 2},
        Row{"v 1 2 3 4 5\n", 1, 12}, Row{"vn 1 2 3 4\n", 1, 10}, Row{"vt\n", 1, 3},
        Row{"v 0 0 0\nf 1 1 2\n", 2, 7}, Row{"v 0 0 0\nf 1 1 0\n", 2, 7},
        Row{"v 0 0 0\nf 1 1 -2\n", 2, 7}, Row{"v 0 0 0\nf 1 1 99999999999\n", 2, 7},
        Row{"v 0 0 0\nvt 0 0\nf 1/1 1/2 1/1\n", 3, 7}, Row{"v 0 0 0\nf 1/ 1 1\n", 2, 3},
        Row{"v 0 0 0\nf 1/1/1/1 1 1\n", 2, 3}, Row{"v 0 0 0\nf\n", 2, 2},
        Row{"v 0 0 0\nf a b c\n", 2, 3}}) {
    CAPTURE(row.text);
    int line = -1, column = -1;
    try {
      import_text(row.text);
    } catch (const InputError& e) {
      line = e.line();
      column = e.column();
    }
    CHECK(line == row.line);
    CHECK(column == row.column);
  }
}

TEST_CASE("materials of an MTL library") {
  Material m = material_of("Kd .1 .2 .3\nillum 1\nKs 1 1 1\n");
  CHECK(m.kind == MaterialKind::diffuse);
  CHECK(m.base_color.value == Rgb(0.1f, 0.2f, 0.3f));

  m = material_of("Kd .5 .5 .5\nKs .5 .5 .5\nNs 98\nillum 2\nNi 1.45\n");
  CHECK(m.kind == MaterialKind::metallic_roughness);
  CHECK(m.metallic.value == 0);
  CHECK(m.specular.value == 0.5f);
  CHECK(m.roughness.value == doctest::Approx(std::sqrt(0.02)));
  CHECK(m.roughness_meaning == RoughnessMeaning::alpha);
  CHECK(m.ior == 1.45f);

  m = material_of("Kd 0 0 0\nKs .9 .9 .9\nillum 3\n");
  CHECK(m.metallic.value == 1);
  CHECK(m.base_color.value.r == doctest::Approx(0.9));
  CHECK(m.roughness.value == 0);

  m = material_of("Kd .5 .5 .5\nd .1\nillum 7\nNi 1.33\n");
  CHECK(m.kind == MaterialKind::dielectric);
  CHECK(m.ior == 1.33f);
  CHECK_FALSE(m.is_thin);

  m = material_of("Kd .5 .5 .5\nTr .25\n");
  CHECK(m.transmission.value == 0.25f);
  CHECK(m.is_thin);

  m = material_of("Kd .5 .5 .5\nd .1\nTf .2 .9 1.5\n");  // a pane of coloured glass
  CHECK(m.base_color.value == Rgb(0.2f, 0.9f, 1));
  CHECK(m.transmission.value == doctest::Approx(0.9));
  m = material_of("Kd .5 .5 .5\nTf 1 1 1\nillum 4\n");  // some programs write this for every
                                                        // material
  CHECK(m.transmission.value == 0);
  CHECK(m.base_color.value == Rgb(0.5f));

  m = material_of("Kd 1 .5 0\nPr .4\nPm .7\nPc .5\nPcr .1\n");
  CHECK(m.coat.value == 0.5f);
  CHECK(m.coat_roughness.value == 0.1f);
  CHECK(m.kind == MaterialKind::metallic_roughness);
  CHECK(m.roughness.value == 0.4f);
  CHECK(m.roughness_meaning == RoughnessMeaning::alpha_is_square);
  CHECK(m.metallic.value == 0.7f);

  m = material_of("  Kd .25\n");  // one number stands for three
  CHECK(m.base_color.value == Rgb(0.25f));
}

TEST_CASE("MTL: gloss of two widths and its direction, sheen, colours and images of gloss") {
  const Material grain = material_of("Kd .5 .5 .5\nPr .4\nPm 1\naniso .8\nanisor .25\nPs .5\n");
  // Burley: widths .16 / a and .16 a, a = sqrt(1 - .9 × .8).
  const double a = std::sqrt(1 - 0.9 * 0.8), narrow = 0.16 * a, wide = 0.16 / a;
  CHECK(sqr(double(grain.roughness.value)) == doctest::Approx(narrow));
  CHECK(narrow + (1 - narrow) * sqr(double(grain.anisotropy.value)) == doctest::Approx(wide));
  CHECK(grain.anisotropy_rotation_rad == doctest::Approx(0.5 * pi));
  CHECK(grain.sheen_color.value == Rgb{0.5f});
  CHECK(material_of("Kd .5 .5 .5\nPr .4\n").anisotropy.value == 0);

  const Material gloss = material_of("Kd .1 .1 .1\nKs .2 .4 .8\nNs 100\nillum 2\n");
  CHECK(gloss.specular.value == 0.8f);
  CHECK(gloss.specular_color.value.r == doctest::Approx(0.25));

  const auto told = [](const std::string& mtl, const char* words) {
    return has_warning(import_text(square + "usemtl a\nf 1 2 3\n", "newmtl a\n" + mtl), words);
  };
  CHECK(told("Kd .5 .5 .5\naniso .8\n", "aniso and Ps without Pr or Pm"));
  CHECK(!told("Kd .5 .5 .5\nPr .4\naniso .8\n", "aniso"));
  for (const char* other : {"Pr .4\n", "illum 3\nKs 1 1 1\n", "illum 1\n"})
    CHECK(told(other + std::string("map_Ks gone.png\n"), "map_Ks is ignored unless"));

  const TempFolder folder;
  write_image(folder.path("k.pfm"), Image(2, 2, Rgb{0.5f}));
  folder.write("m.mtl", "newmtl a\nKd .1 .1 .1\nKs 1 1 1\nmap_Ks -s 2 2 1 k.pfm\nmap_Ke k.pfm\n");
  const std::string faces = "mtllib m.mtl\n" + square + "usemtl a\nf 1 2 3\n";
  const Scene lamp = import_obj(folder.write("s.obj", faces));
  CHECK(lamp.materials.at(lamp.meshes.at(0).material).specular_color.texture >= 0);
  REQUIRE(lamp.lights.size() == 1);  // without Ke the image alone counts
  CHECK(lamp.lights[0].radiance == Rgb{1});
  folder.write("m.mtl", "newmtl a\nKe 0 0 0\nmap_Ke k.pfm\n");
  const Scene dark = import_obj(folder.write("s.obj", faces));
  CHECK(dark.lights.empty());
  CHECK(has_warning(dark, "map_Ke with a Ke of 0"));
}

TEST_CASE("images of materials: options, blanks, backslashes, and never outside the folder") {
  const TempFolder folder;
  folder.write("scene/tex/empty", "");
  write_image(folder.path("scene/tex/a b.pfm"), Image(1, 1, Rgb{0.5f}));
  write_image(folder.path("outside.pfm"), Image(1, 1, Rgb{0.5f}));
  const auto import_map = [&](const std::string& statement) {
    folder.write("scene/tex/m.mtl", "newmtl a\nKd 0 0 0\n" + statement + "\n");
    return import_obj(
        folder.write("scene/m.obj", "mtllib tex\\m.mtl\n" + square + "usemtl a\nf 1 2 3\n"));
  };
  for (const char* statement :
       {"map_Kd a b.pfm", "map_Kd -s 2 3 1 -o .5 a b.pfm", "map_Kd ..\\tex\\a b.pfm",
        "map_Kd -clamp on -bm 2 a b.pfm", "map_Kd a b.pfm -bm 1"}) {
    CAPTURE(statement);
    const Scene scene = import_map(statement);
    CHECK(scene.warnings.entries().empty());
    REQUIRE(scene.textures.size() == 1);
    CHECK(scene.textures[0].kind == TextureKind::image);
    // A black Kd beside an image means the image.
    CHECK(scene.materials.at(0).base_color.value == Rgb(1));
    if (std::string(statement).find("-s") != std::string::npos) {
      CHECK(scene.textures[0].uv_scale == Vec2(2, -3));
      CHECK(scene.textures[0].uv_offset == Vec2(0.5f, 1));
    }
  }
  for (const char* statement :
       {"map_Kd ../../outside.pfm", "map_Kd /etc/passwd", "map_Kd no.png"}) {
    CAPTURE(statement);
    const Scene scene = import_map(statement);
    CHECK(scene.warnings.total() == 1);
    CHECK(scene.textures.at(0).kind == TextureKind::constant);
  }
}

TEST_CASE("libraries with spaces in their names, several and missing ones") {
  const TempFolder folder;
  folder.write("my lib.mtl", "newmtl a b\nKd 1 0 0\n");
  folder.write("two.mtl", "newmtl c\nKd 0 1 0\n");
  const std::string faces = square + "usemtl a b\nf 1 2 3\nusemtl  c \nf 1 3 4\n";
  for (const char* libraries :
       {"mtllib my lib.mtl two.mtl\n", "mtllib my lib.mtl\nmtllib two.mtl\n",
        "mtllib two.mtl gone.mtl my lib.mtl\n"}) {
    CAPTURE(libraries);
    const Scene scene = import_obj(folder.write("s.obj", libraries + faces));
    REQUIRE(scene.meshes.size() == 2);
    CHECK(scene.materials.at(scene.meshes[0].material).base_color.value == Rgb(1, 0, 0));
    CHECK(scene.materials.at(scene.meshes[1].material).base_color.value == Rgb(0, 1, 0));
    const bool names_missing = std::string(libraries).find("gone") != std::string::npos;
    CHECK(has_warning(scene, "gone.mtl") == names_missing);
    CHECK(scene.warnings.entries().size() == (names_missing ? 1 : 0));
  }
  const Scene missing = import_obj(folder.write("s.obj", "mtllib ../x.mtl\n" + faces));
  CHECK(has_warning(missing, "x.mtl"));
  CHECK(has_warning(missing, "'a b' is missing"));
  CHECK(missing.materials.at(0).kind == MaterialKind::diffuse);
}

TEST_CASE("Ke emits from the front, named in order of appearance") {
  const Scene scene = import_text(
      square +
          "o x\nusemtl dark\nf 1 2 3 4\no y\nusemtl lamp\nf 4 3 2 1\no z\nusemtl lamp\nf 1 2 3\n",
      "newmtl dark\nKd 1 1 1\nnewmtl lamp\nKd 0 0 0\nKe 3 2 1\n");
  REQUIRE(scene.lights.size() == 2);
  CHECK(scene.lights[0].name == "emitter0");
  CHECK(scene.lights[0].radiance == Rgb(3, 2, 1));
  CHECK(scene.lights[0].polygon.size() == 4);
  CHECK_FALSE(scene.lights[0].is_two_sided);
  const Mesh& mesh = scene.meshes.at(scene.lights[0].geometry);
  CHECK(area_vector(mesh, mesh.triangles[0]).z < 0);
  CHECK(scene.lights[1].name == "emitter1");
}

TEST_CASE("other statements of OBJ files are left out with warnings") {
  const Scene scene = import_text(
      "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\np 1\nl 1 2\ns off\n"
      "curv 0 1 1 2\nf 1 2\nv nan 1 1.#INF\nf 1 2 3\nf 1 2 4\nf 1 1 2\n");
  CHECK(triangle_count(scene) == 1);
  for (const char* part :
       {"points and lines", "curv", "fewer than three", "not finite", "without area"}) {
    CAPTURE(part);
    CHECK(has_warning(scene, part));
  }
}

TEST_CASE("OBJ: colours of vertices, from sRGB") {
  const Scene scene = import_text(
      "v 0 0 0 1 0 0\nv 1 0 0 0 0.5 0\nv 0 1 0 0 0 1\nv 0 1 1 1 0 1 0\nv 5 5 5\nf 1 2 3\nf 1 2 5\n"
      "f 4 4 4\n");
  REQUIRE(triangle_count(scene) == 2);
  const Mesh& mesh = scene.meshes.at(0);
  const Material& m = scene.materials[mesh.material];
  REQUIRE(m.base_color.texture >= 0);
  const auto color = [&](size_t t, size_t k) {
    return evaluate(scene.textures, m.base_color, mesh.uvs.at(mesh.triangles[t][k]));
  };
  CHECK(color(0, 0) == Rgb{1, 0, 0});
  CHECK(color(0, 1).g == doctest::Approx(linear_from_srgb(0.5f)));
  CHECK(color(0, 2) == Rgb{0, 0, 1});
  CHECK(color(1, 2) == Rgb{1, 1, 1});  // has no colour
}

TEST_CASE("kj92room as OBJ has four sources that face into the room") {
  const Scene scene = import_obj(std::string(TROFFER_SOURCE_DIR) + "/scenes/kj92room/kj92room.obj");
  CHECK(scene.warnings.entries().empty());
  CHECK(triangle_count(scene) == 92);
  REQUIRE(scene.lights.size() == 4);
  const Vec3 fronts[] = {{0, 0, -1}, {1, 0, 0}, {-1, 0, 0}, {-1, 0, 0}};
  for (size_t i = 0; i < 4; ++i) {
    const Light& e = scene.lights[i];
    CHECK(e.name == "emitter" + std::to_string(i));
    CHECK(e.polygon.size() == 4);
    const Mesh& mesh = scene.meshes.at(e.geometry);
    CHECK(length(Vec3(normalize(area_vector(mesh, mesh.triangles[0]))) - fronts[i]) < 1e-5f);
    CHECK(e.radiance == Rgb(i < 2 ? 4.0f : 600.0f));
  }
}

TEST_CASE("damaged OBJ and MTL files load or fail cleanly") {
  const std::string obj = "mtllib m.mtl\n" + square +
                          "vt 0 0\nvn 0 0 1\no a\ng b c\nusemtl x\nf 1/1/1 2/1/1 3/1/1 4/1/1\n"
                          "f 1 2 \\\n3\nf -1 -2 -3\n";
  const std::string mtl =
      "newmtl x\nKd .5 .25 1e-1\nKs 1 1 1\nNs 10\nKe 1 1 1\nd 0.5\nillum 2\n"
      "map_Kd -s 1 2 3 -o 0 0 -clamp on none.png\n";
  const TempFolder folder;
  Random random(5);
  for (int round = 0; round < 1000; ++round) {
    std::string texts[2] = {obj, mtl};
    std::string& damaged = texts[round % 2];
    for (int e = 0; e < 2; ++e) {
      const size_t at = random.next_u32() % damaged.size();
      if (random.next_u32() % 2 == 0)
        damaged[at] = char(random.next_u32());
      else
        damaged.erase(at, 1 + random.next_u32() % 4);
    }
    folder.write("m.mtl", texts[1]);
    try {
      const Scene scene = import_obj(folder.write("m.obj", texts[0]));
      for (const Mesh& mesh : scene.meshes)
        for (const Triangle& t : mesh.triangles)
          for (const uint32_t v : t) REQUIRE(v < mesh.positions.size());
    } catch (const InputError&) {
    }
  }
}

TEST_CASE("libraries and images with paths of another machine are read from the scene's folder") {
  const TempFolder folder;
  folder.write("m.mtl", "newmtl a\nmap_Kd C:\\\\work\\\\red.pfm\n");
  folder.write("red.pfm", "PF\n1 1\n-1.0\n" + std::string(12, '\0'));
  const ReferenceNotes references;
  const Scene scene = import_obj(
      folder.write("s.obj", "mtllib /home/somebody/m.mtl\n" + square + "usemtl a\nf 1 2 3\n"));
  CHECK(has_warning(scene, "the one beside the scene is used"));
  REQUIRE(references.notes().size() == 1);
  CHECK(references.notes()[0].find("is read from 'red.pfm'") != std::string::npos);
  CHECK(scene.textures.at(0).kind == TextureKind::image);
}

TEST_CASE("UTF-16 of both kinds, and Latin-1 in one file where the other has UTF-8") {
  const TempFolder folder;
  const std::string obj = "mtllib m.mtl\n" + square + "usemtl gr\xc3\xbcn\nf 1 2 3\n";
  folder.write("m.mtl", "newmtl gr\xfcn\nKd 0 1 0\n");
  const auto green = [](const Scene& scene) {
    return scene.materials.at(0).base_color.value == Rgb{0, 1, 0} && scene.warnings.total() == 0;
  };
  CHECK(green(import_obj(folder.write("s.obj", obj))));
  for (const bool is_little : {true, false}) {
    std::string wide = is_little ? "\xff\xfe" : "\xfe\xff";
    for (size_t i = 0; i < obj.size(); ++i) {
      const bool is_umlaut = obj[i] == '\xc3';
      const char low = is_umlaut ? '\xfc' : obj[i];
      wide += is_little ? std::string{low, '\0'} : std::string{'\0', low};
      i += is_umlaut ? 1 : 0;
    }
    CHECK(green(import_obj(folder.write("s.obj", wide))));
  }
}

}  // namespace test_obj
