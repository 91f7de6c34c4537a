// Tests of vertex alpha with materials that blend: it multiplies the material's own alpha, which
// may be 1 (glTF 2.0 §3.9.2 and §3.9.4: COLOR_0 multiplies the base colour, alpha included).
#include <doctest/doctest.h>

#include <fmt/format.h>

#include "import/gltf_builder.h"

using namespace troffer;

namespace test_vertex_alpha {

namespace {

// Returns a sheet of four vertices with these alphas; the material's own alpha is `factor`.
Scene sheet(const std::vector<float>& alphas, const std::string& mode, double factor) {
  const std::vector<float> places{-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
  std::vector<float> colors;
  for (const float a : alphas) colors.insert(colors.end(), {1, 1, 1, a});
  const std::vector<uint32_t> corners{0, 1, 2, 0, 2, 3};
  return import_text(gltf_text(fmt::format(
      "'scene':0,'scenes':[{{'nodes':[0]}}],'nodes':[{{'mesh':0}}],"
      "'meshes':[{{'primitives':[{{'attributes':{{'POSITION':0,'COLOR_0':1}},'indices':2,"
      "'material':0}}]}}],"
      "'accessors':[{{'bufferView':0,'componentType':5126,'count':4,'type':'VEC3',"
      "'min':[-1,-1,0],'max':[1,1,0]}},"
      "{{'bufferView':1,'componentType':5126,'count':4,'type':'VEC4'}},"
      "{{'bufferView':2,'componentType':5125,'count':6,'type':'SCALAR'}}],"
      "'bufferViews':[{{'buffer':0,'byteLength':48}},{{'buffer':1,'byteLength':64}},"
      "{{'buffer':2,'byteLength':24}}],"
      "'materials':[{{'pbrMetallicRoughness':{{'baseColorFactor':[1,1,1,{}]}},"
      "'alphaMode':'{}'}}],'buffers':[{},{},{}]",
      factor, mode, data_buffer(bytes_of(places)), data_buffer(bytes_of(colors)),
      data_buffer(bytes_of(corners)))));
}

// Returns the coverage at a corner of the sheet's first triangle.
float coverage_at_corner(const Scene& s, size_t corner) {
  const Mesh& mesh = s.meshes.at(0);
  const Material& m = s.materials[mesh.material];
  if (!m.is_alpha_masked) return 1;
  const Vec2 uv = mesh.uvs.empty() ? Vec2{} : mesh.uvs[mesh.triangles[0][corner]];
  return coverage(s.textures, m, uv);
}

}  // namespace

TEST_CASE("vertex alpha multiplies the alpha of blended materials") {
  for (const double factor : {1.0, 0.5}) {
    CAPTURE(factor);
    const Scene even = sheet({.25f, .25f, .25f, .25f}, "BLEND", factor);
    CHECK(coverage_at_corner(even, 0) == doctest::Approx(0.25 * factor));
    const Scene varied = sheet({.25f, .75f, 1, .5f}, "BLEND", factor);
    CHECK(coverage_at_corner(varied, 0) == doctest::Approx(0.25 * factor));
    CHECK(coverage_at_corner(varied, 1) == doctest::Approx(0.75 * factor));
    CHECK(coverage_at_corner(varied, 2) == doctest::Approx(factor));
  }
}

TEST_CASE("vertex alpha is ignored by opaque materials and cuts holes in masked ones") {
  CHECK(coverage_at_corner(sheet({.25f, .25f, .25f, .25f}, "OPAQUE", 1), 0) == 1);
  CHECK(coverage_at_corner(sheet({.25f, .25f, .25f, .25f}, "MASK", 1), 0) == 0);
  CHECK(coverage_at_corner(sheet({.75f, .75f, .75f, .75f}, "MASK", 1), 0) == 1);
  CHECK_FALSE(sheet({1, 1, 1, 1}, "BLEND", 1).materials[0].is_alpha_masked);
}

}  // namespace test_vertex_alpha
