// Tests of Mitsuba's materials, textures and mesh files.
#include <doctest/doctest.h>
#include <zlib.h>

#include <cmath>
#include <cstring>
#include <string>

#include "base/error.h"
#include "base/units.h"
#include "import/mitsuba/mitsuba.h"
#include "import/mitsuba/mitsuba_serialized.h"
#include "mutations.h"
#include "scene_checks.h"
#include "temp_folder.h"

using namespace troffer;

namespace test_mitsuba_data {

namespace {

Scene import_bsdf(const std::string& bsdf, const std::string& version = "3.0.0") {
  const TempFolder folder;
  return import_mitsuba(folder.write(
      "scene.xml",
      "<scene version='" + version + "'><shape type='sphere'>" + bsdf + "</shape></scene>"));
}
Material material_of(const std::string& bsdf, const std::string& version = "3.0.0") {
  const Scene scene = import_bsdf(bsdf, version);
  REQUIRE(scene.materials.size() == 1);
  return scene.materials[0];
}

template <class T>
void append(std::string& to, T value) {
  to.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// Returns a file of serialized meshes: a triangle at each height.
std::string serialized(const std::vector<float>& heights, bool is_double, bool has_normals) {
  std::string file;
  std::vector<uint64_t> offsets;
  for (const float z : heights) {
    offsets.push_back(file.size());
    std::string plain;
    append<uint32_t>(plain, (is_double ? 0x2000u : 0x1000u) | (has_normals ? 1u : 0u));
    plain += "name";
    plain += '\0';
    append<uint64_t>(plain, 3);
    append<uint64_t>(plain, 1);
    const auto real = [&](float v) {
      is_double ? append<double>(plain, v) : append<float>(plain, v);
    };
    for (const float v : {0.0f, 0.0f, z, 1.0f, 0.0f, z, 0.0f, 1.0f, z}) real(v);
    if (has_normals)
      for (int i = 0; i < 3; ++i)
        for (const float v : {0.6f, 0.0f, 0.8f}) real(v);
    for (const uint32_t i : {0, 1, 2}) append(plain, i);
    append<uint16_t>(file, 0x041C);
    append<uint16_t>(file, 4);
    uLongf size = compressBound(plain.size());
    std::string packed(size, '\0');
    compress(reinterpret_cast<Bytef*>(packed.data()), &size,
             reinterpret_cast<const Bytef*>(plain.data()), plain.size());
    file.append(packed, 0, size);
  }
  for (const uint64_t offset : offsets) append(file, offset);
  append<uint32_t>(file, uint32_t(offsets.size()));
  return file;
}

SerializedMesh read(const std::string& file, size_t index) {
  return read_serialized({reinterpret_cast<const uint8_t*>(file.data()), file.size()}, index,
                         "mesh.serialized");
}

}  // namespace

TEST_CASE("Mitsuba's smooth and rough materials") {
  Material m =
      material_of("<bsdf type='diffuse'><rgb name='reflectance' value='.1 .2 .3'/></bsdf>");
  CHECK(m.kind == MaterialKind::diffuse);
  CHECK(m.base_color.value == Rgb{0.1f, 0.2f, 0.3f});
  m = material_of(
      "<bsdf type='roughdielectric'><float name='alpha' value='.3'/><string "
      "name='distribution' value='ggx'/><string name='int_ior' value='water'/></bsdf>");
  CHECK(m.kind == MaterialKind::dielectric);
  CHECK(m.roughness.value == 0.3f);
  CHECK(m.ior == doctest::Approx(1.333 / 1.000277));
  m = material_of("<bsdf type='thindielectric'/>");
  CHECK(m.is_thin);
  CHECK(m.ior == doctest::Approx(1.5046 / 1.000277));
  m = material_of("<bsdf type='conductor'><string name='material' value='Au'/></bsdf>");
  CHECK(m.kind == MaterialKind::conductor);
  CHECK_FALSE(m.is_reflectance);
  CHECK(m.eta.r < m.eta.b);
  m = material_of("<bsdf type='conductor'/>");
  CHECK(m.is_reflectance);
  CHECK(m.base_color.value == Rgb{1});
  m = material_of("<bsdf type='conductor'/>", "0.6.0");
  CHECK_FALSE(m.is_reflectance);  // copper
  m = material_of(
      "<bsdf type='twosided'><bsdf type='roughconductor'><rgb name='eta' value='.2 .9 "
      "1'/><rgb name='k' value='3 2 1'/><float name='alpha_u' value='.1'/><float "
      "name='alpha_v' value='.4'/></bsdf></bsdf>");
  CHECK(m.eta == Rgb{0.2f, 0.9f, 1});
  CHECK(m.roughness.value == doctest::Approx(0.1));
  CHECK(0.1f + 0.9f * sqr(m.anisotropy.value) == doctest::Approx(0.4));
}

// Reflectance of the base alone, seen and lit along the normal, times pi. Mitsuba has T² ρ / (η² (1
// - ρ F)), with ρ = 1 in the denominator unless nonlinear.
TEST_CASE("plastic has the same base as in Mitsuba") {
  const auto base = [](bool is_nonlinear, float rho) {
    return material_of("<bsdf type='plastic'><boolean name='nonlinear' value='" +
                       std::string(is_nonlinear ? "true" : "false") +
                       "'/><float name='int_ior' value='1.5'/><float name='ext_ior' value='1'/>"
                       "<rgb name='diffuse_reflectance' value='" +
                       std::to_string(rho) + "'/></bsdf>")
        .base_color.value.r;
  };
  // Mean internal reflectance at index 1.5, from tables.
  const double f = 0.5963;
  CHECK(base(true, 0.5f) == 0.5f);
  for (const float rho : {0.1f, 0.5f, 1.0f}) {
    const auto ours = double(base(false, rho));
    CHECK(ours / (1 - ours * f) == doctest::Approx(double(rho) / (1 - f)).epsilon(0.002));
  }
}

TEST_CASE("combined materials") {
  Material m = material_of(
      "<bsdf type='blendbsdf'><float name='weight' value='.25'/><bsdf type='diffuse'><rgb "
      "name='reflectance' value='0'/></bsdf><bsdf type='diffuse'><rgb name='reflectance' "
      "value='.8'/></bsdf></bsdf>");
  CHECK(m.base_color.value.r == doctest::Approx(0.2));
  const Scene masked = import_bsdf(
      "<bsdf type='mask'><texture type='checkerboard' name='opacity'><rgb name='color0' value='1'/>"
      "<rgb name='color1' value='0'/></texture><bsdf type='diffuse'/></bsdf>");
  REQUIRE(masked.materials.at(0).is_alpha_masked);
  CHECK(masked.spheres.empty());  // tessellated, because (u,v) are needed
  const Material& holes = masked.materials[0];
  CHECK(is_cut_out(masked.textures, holes, Vec2{0.2f, 0.2f}));
  CHECK_FALSE(is_cut_out(masked.textures, holes, Vec2{0.7f, 0.2f}));
  const std::string veil =
      "<bsdf type='mask'><float name='opacity' value='.3'/><bsdf type='diffuse'/></bsdf>";
  CHECK(coverage({}, material_of(veil), Vec2{0, 0}) == 0.3f);
  CHECK(import_bsdf(veil).warnings.total() == 0);
  CHECK(import_bsdf(veil).spheres.empty());  // exact spheres cannot have holes
  CHECK(import_bsdf("<bsdf type='mask'><float name='opacity' value='0'/><bsdf type='diffuse'/>"
                    "</bsdf>")
            .materials.empty());
  CHECK(import_bsdf("<bsdf type='null'/>").spheres.empty());
  m = material_of(
      "<bsdf type='principled'><rgb name='base_color' value='.3'/><float "
      "name='metallic' value='.7'/><float name='specular' value='.5'/><float name='clearcoat' "
      "value='.8'/><float name='clearcoat_gloss' value='1'/></bsdf>");
  CHECK(m.coat.value == doctest::Approx(0.2));
  CHECK(m.coat_roughness.value == doctest::Approx(std::sqrt(0.001)));
  const Scene varnished = import_bsdf(
      "<bsdf type='principled'><float name='spec_trans' value='1'/><float name='clearcoat' "
      "value='1'/></bsdf>");
  CHECK(varnished.materials.at(0).coat.value == 0.25f);
  CHECK_FALSE(has_warning(varnished, "without clearcoat"));
  CHECK(m.kind == MaterialKind::metallic_roughness);
  CHECK(m.metallic.value == 0.7f);
  CHECK(m.ior == doctest::Approx(1.5));
  // A factor on the reflectance, known and unknown metals, and an emitter on an invisible surface.
  const Scene factors = import_bsdf(
      "<bsdf type='conductor'><string name='material' value='Cr'/><rgb name='specular_reflectance' "
      "value='.9,.6,.3'/></bsdf>");
  CHECK(factors.warnings.total() == 0);
  CHECK_FALSE(factors.materials.at(0).is_reflectance);
  CHECK(factors.materials.at(0).specular_color.value == Rgb{0.9f, 0.6f, 0.3f});
  CHECK(factors.materials.at(0).eta.g == doctest::Approx(2.9165).epsilon(1e-4));
  for (const std::string type : {"dielectric", "thindielectric", "plastic"}) {
    const Scene less = import_bsdf("<bsdf type='" + type +
                                   "'><float name='specular_reflectance' value='.5'/></bsdf>");
    CHECK_FALSE(has_warning(less, "specular_reflectance"));
    CHECK(less.materials.at(0).specular_color.value == Rgb{0.5f});
  }
  CHECK(
      has_warning(import_bsdf("<bsdf type='conductor'><string name='material' value='Xx'/></bsdf>"),
                  "not known"));
  const TempFolder folder;
  const Scene glow = import_mitsuba(folder.write(
      "s.xml",
      "<scene version='3.0.0'><shape type='rectangle'><bsdf type='null'/><emitter type='area'><rgb "
      "name='radiance' value='2'/></emitter></shape></scene>"));
  CHECK(glow.warnings.total() == 0);
  REQUIRE(glow.lights.size() == 1);
  CHECK(glow.materials.at(glow.meshes.at(0).material).is_thin);
  CHECK(glow.materials[glow.meshes[0].material].ior == 1);
  m = material_of(
      "<bsdf type='roughcoating'><float name='alpha' value='.05'/><float name='int_ior' "
      "value='1.7'/><string name='distribution' value='ggx'/><bsdf type='roughconductor'>"
      "<float name='alpha' value='.2'/><string name='distribution' value='ggx'/></bsdf></bsdf>");
  CHECK(m.kind == MaterialKind::conductor);
  CHECK(m.roughness.value == 0.2f);
  CHECK(m.coat.value == 1);
  CHECK(m.coat_roughness.value == 0.05f);
  CHECK(m.coat_ior == doctest::Approx(1.7).epsilon(1e-3));
}

TEST_CASE("a bitmap's (0,0) is its upper left corner; OBJ files count from the lower one") {
  const TempFolder folder;
  std::string pfm = "Pf\n1 2\n-1.0\n";  // from the bottom up: 1, then 0 on top
  for (const float v : {1.0f, 0.0f}) pfm.append(reinterpret_cast<const char*>(&v), sizeof v);
  folder.write("t.pfm", pfm);
  folder.write("q.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3\n");
  const Scene scene = import_mitsuba(folder.write(
      "s.xml",
      "<scene version='3.0.0'><shape type='obj'><string name='filename' value='q.obj'/>"
      "<bsdf type='diffuse'><texture name='reflectance' type='bitmap'><string "
      "name='filename' value='t.pfm'/><string name='filter_type' value='nearest'/>"
      "</texture></bsdf></shape></scene>"));
  const Mesh& mesh = scene.meshes.at(0);
  REQUIRE(mesh.uvs.size() == 3);
  CHECK(mesh.normals.empty());  // flat
  const ColorInput& c = scene.materials.at(mesh.material).base_color;
  const Vec2 up = mesh.positions[2].y > 0.5f ? mesh.uvs[2] : mesh.uvs[0];
  CHECK(evaluate(scene.textures, c, Vec2{0.5f, up.y + 0.1f}).r == 0);
  CHECK(evaluate(scene.textures, c, Vec2{0.5f, up.y + 0.9f}).r == 1);
}

TEST_CASE("serialized meshes of either precision") {
  for (const bool is_double : {false, true}) {
    const std::string file = serialized({3, 5}, is_double, true);
    const SerializedMesh mesh = read(file, 1);
    CHECK(mesh.mesh.mesh.name == "name");
    REQUIRE(mesh.mesh.mesh.triangles.size() == 1);
    CHECK(mesh.mesh.mesh.positions.at(2).z == 5);
    CHECK(mesh.mesh.mesh.normals.at(0).x == 0.6f);
    CHECK_THROWS_AS(read(file, 2), InputError);
  }
}

TEST_CASE("serialized meshes that are broken are refused") {
  const std::string file = serialized({1, 2, 3}, false, false);
  for (size_t size = 0; size < file.size(); size += 3)
    CHECK_THROWS_AS(read(file.substr(0, size), 0), InputError);
  test::check_mutations(file, 3000, [](const std::string& changed) {
    for (const size_t index : {0, 1, 2}) read(changed, index);
  });
}

}  // namespace test_mitsuba_data
