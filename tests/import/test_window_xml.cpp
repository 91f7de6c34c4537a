// LBNL WINDOW's files: bases, orders of numbers, reciprocity in place of missing data, tensor
// trees, broken files.
#include "import/window_xml.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "base/error.h"
#include "import/import.h"
#include "mutations.h"
#include "support/klems.h"
#include "temp_folder.h"

using namespace troffer;
using namespace troffer::test;

namespace test_window_xml {

namespace {

AngularBsdf read(const std::string& text, WarningLog* log = nullptr) {
  WarningLog own;
  return read_window_xml("w.xml", text, log != nullptr ? *log : own);
}

std::string error_of(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

// Each value tells its pair of patches.
AngleMatrix numbered(const AngleBasis& basis) {
  return matrix_of(basis, [&](size_t o, size_t i) {
    return 1e-6 * (1 + double(o) * double(basis.size()) + double(i));
  });
}

}  // namespace

// [Radiance, doc/notes/BSDFdirections.txt] WINDOW's front is the outside, opposite to the normal.
TEST_CASE("the file's front is the outside, and columns hold incident directions") {
  for (const AngleBasis& basis : {klems_full(), klems_half(), klems_quarter()}) {
    const std::string name = basis.size() == 145  ? "LBNL/Klems Full"
                             : basis.size() == 73 ? "LBNL/Klems Half"
                                                  : "LBNL/Klems Quarter";
    const AngularBsdf b = read(klems_file({{"Transmission Front", numbered(basis)},
                                           {"Transmission Back", peaked_matrix(basis, 0.3, 0)},
                                           {"Reflection Front", peaked_matrix(basis, 0.1, 0)},
                                           {"Reflection Back", peaked_matrix(basis, 0.2, 0)}},
                                          name));
    REQUIRE(b.to_front.in == basis);
    CHECK(double(b.to_front.at(3, 7)) ==
          doctest::Approx(1e-6 * (1 + 3.0 * double(basis.size()) + 7)));
    CHECK(b.to_back.hemispherical(5) == doctest::Approx(0.3));
    CHECK(b.back_reflection.hemispherical(0) == doctest::Approx(0.1));
    CHECK(b.front_reflection.hemispherical(0) == doctest::Approx(0.2));
    CHECK(b.name == "test");
  }
}

TEST_CASE("with rows of incident directions the matrix is transposed") {
  std::string text =
      klems_file({{"Transmission Front", numbered(klems_quarter())}}, "LBNL/Klems Quarter");
  text.replace(text.find("Columns"), 7, "Rows");
  CHECK(double(read(text).to_front.at(7, 3)) == doctest::Approx(1e-6 * (1 + 3 * 41.0 + 7)));
}

TEST_CASE("a basis that the file defines is read") {
  const AngleBasis own({{0, 2}, {45, 4}});
  const AngularBsdf b =
      read(klems_file({{"Transmission Back", peaked_matrix(own, 0.5, 0)}}, "Mine"));
  CHECK(b.to_back.in == own);
}

TEST_CASE("missing or zero transmission is the reverse of the other direction") {
  const AngleMatrix m = numbered(klems_quarter());
  for (const bool has_zeros : {false, true}) {
    std::map<std::string, AngleMatrix> ways{{"Transmission Front", m}};
    if (has_zeros)
      ways["Transmission Back"] = matrix_of(klems_quarter(), [](size_t, size_t) { return 0.0; });
    const AngularBsdf b = read(klems_file(ways, "LBNL/Klems Quarter"));
    REQUIRE_FALSE(b.to_back.is_empty());
    CHECK(reciprocity_error(b.to_front, b.to_back) == doctest::Approx(0).epsilon(1e-9));
    CHECK(b.front_reflection.is_empty());
  }
}

TEST_CASE("matrices that are not reciprocal are named") {
  const auto warnings = [](const AngleMatrix& front, const AngleMatrix& back) {
    WarningLog log;
    read(klems_file({{"Transmission Front", front}, {"Transmission Back", back}},
                    "LBNL/Klems Quarter"),
         &log);
    return log.entries();
  };
  const AngleMatrix even = peaked_matrix(klems_quarter(), 0.3, 0);
  CHECK(warnings(even, even).empty());
  const auto other = warnings(even, peaked_matrix(klems_quarter(), 0.15, 0));
  REQUIRE(other.size() == 1);
  CHECK(other[0].text.find("transmission differs from its reverse by 50 %") != std::string::npos);
}

// The leaves of a tree of one level fill quarters of the square of leaving directions, for 4D and
// 3D: the first has x and y below 0.
TEST_CASE("tensor trees become Klems matrices") {
  const auto tree_file = [](int dimensions, const std::string& data) {
    return window_xml("TensorTree" + std::to_string(dimensions), "",
                      block_xml("Transmission Front", "LBNL/Shirley-Chiu", data));
  };
  WarningLog log;
  const AngularBsdf even = read(tree_file(4, "{ 0.1 }"), &log);
  REQUIRE(even.to_front.in.size() == 145);
  CHECK(log.total() == 1);
  for (size_t i = 0; i < 145; i += 12)
    CHECK(even.to_front.hemispherical(i) == doctest::Approx(0.1 * pi));
  // Grid of 2 x 2 x 2 x 2 numbers, last dimension fastest: bright where the light leaves with x > 0
  // and y < 0.
  std::string grid = "{";
  for (int k = 0; k < 16; ++k) grid += k % 4 == 2 ? " 0.2" : " 0";
  const AngularBsdf quarter = read(tree_file(4, grid + "}"));
  // All four numbers of a branch, with bits for the dimensions: the same function.
  std::string branches = "{";
  for (int k = 0; k < 16; ++k) branches += (k & 4) != 0 && (k & 8) == 0 ? "{.2}" : "{0}";
  const AngularBsdf same = read(tree_file(4, branches + "}"));
  CHECK(same.to_front.values == quarter.to_front.values);
  const AngleBasis full = klems_full();
  for (size_t o = 0; o < 145; ++o) {
    const Vec3 w = full.direction(o, {0.5f, 0.5f});
    if (std::abs(w.x) < 0.2f || std::abs(w.y) < 0.2f) continue;
    CHECK(double(quarter.to_front.at(o, 40)) ==
          doctest::Approx(w.x > 0 && w.y < 0 ? 0.2 : 0.0).epsilon(1e-6));
  }
  // Isotropic: dimensions are the sine and the leaving direction, turned with the incident one.
  std::string turned = "{";
  for (int k = 0; k < 8; ++k) turned += k % 4 == 2 || k % 4 == 3 ? " 0.2" : " 0";
  const AngularBsdf forward = read(tree_file(3, turned + "}"));
  for (const size_t i : {30, 50, 100})
    for (size_t o = 0; o < 145; o += 7) {
      const Vec3 a = full.direction(i, {0.5f, 0.5f}), w = full.direction(o, {0.5f, 0.5f});
      const float along = a.x * w.x + a.y * w.y;  // > 0: goes on as it came
      if (std::abs(along) < 0.3f) continue;
      CHECK(double(forward.to_front.at(o, i)) ==
            doctest::Approx(along > 0 ? 0.2 : 0.0).epsilon(1e-6));
    }
}

TEST_CASE("broken files are refused with their place") {
  const std::string good = klems_file(
      {{"Transmission Front", peaked_matrix(klems_quarter(), 0.3, 0)}}, "LBNL/Klems Quarter");
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    return error_of(text);
  };
  CHECK(error_of(good).empty());
  CHECK(error_of(good.substr(0, good.size() / 2)).find("not valid XML") != std::string::npos);
  CHECK(error_of("<a/>").find("no WindowElement") != std::string::npos);
  CHECK(changed("Columns", "Layers").find("IncidentDataStructure 'Layers'") != std::string::npos);
  CHECK(changed("<ScatteringData>\n", "<ScatteringData>\nzzz").find("has 0 numbers") !=
        std::string::npos);
  CHECK(changed("</ScatteringData>", "1</ScatteringData>").find("more than the 1681") !=
        std::string::npos);
  CHECK(changed("<ColumnAngleBasis>LBNL", "<ColumnAngleBasis>LBL").find("no angle basis") !=
        std::string::npos);
  const std::string too_bright = klems_file(
      {{"Reflection Front", peaked_matrix(klems_quarter(), 1.5, 0)}}, "LBNL/Klems Quarter");
  const std::string bright = error_of(too_bright);
  CHECK(bright.find("scatters 1.5 times") != std::string::npos);
  const auto block = too_bright.begin() + ptrdiff_t(too_bright.find("<WavelengthDataBlock>"));
  CHECK(bright.find(fmt::format("w.xml:{}:", 1 + std::count(too_bright.begin(), block, '\n'))) !=
        std::string::npos);
  const std::string tree = window_xml(
      "TensorTree4", "", block_xml("Transmission Front", "LBNL/Shirley-Chiu", "{ 1 2 3 }"));
  CHECK(error_of(tree).find("3 values") != std::string::npos);
  const std::string deep(5000, '{');
  CHECK(error_of(window_xml("TensorTree4", "",
                            block_xml("Transmission Front", "LBNL/Shirley-Chiu", deep)))
            .find("12 levels") != std::string::npos);
}

TEST_CASE("four hundred mutated files are read or refused") {
  const std::string basis = basis_xml(AngleBasis({{0, 1}, {45, 2}}), "Mine");
  const std::string text =
      window_xml("Columns", basis,
                 block_xml("Transmission Front", "Mine", "0.1,0.1,0.1,0.1,0.1,0.1,0.1,0.1,0.1"));
  check_mutations(text, 400, [](const std::string& changed) { read(changed); });
}

TEST_CASE("Radiance's BSDF and aBSDF materials read a file beside the scene") {
  const TempFolder folder;
  folder.write("w.xml", klems_file({{"Transmission Front", peaked_matrix(klems_full(), 0.2, 0.5)},
                                    {"Reflection Back", peaked_matrix(klems_full(), 0.1, 0)}}));
  const std::string square = " polygon p 0 0 12 0 0 0 0 0 1 1 0 1 1 0 0\n";
  const Scene sharp =
      import_scene(folder.write("a.rad", "void aBSDF b 5 w.xml 0 1 2 . 0 0\nb" + square));
  REQUIRE(sharp.materials.size() == 1);
  const Material& m = sharp.materials[0];
  CHECK(m.kind == MaterialKind::angular);
  CHECK(m.has_sharp_peak);
  CHECK(length(m.angular_up - normalize(Vec3{0, 1, 2})) < 1e-6f);
  REQUIRE(m.angular != nullptr);
  CHECK(m.angular->to_front.hemispherical(0) == doctest::Approx(0.2 + 0.5).epsilon(1e-3));
  // The real arguments are added: .3 at the back, .1 transmitted.
  const Scene wide = import_scene(folder.write(
      "b.rad", "void BSDF b 6 0 w.xml 0 0 1 . 0 9 0 0 0 .3 .3 .3 .1 .1 .1\nb" + square));
  CHECK_FALSE(wide.materials[0].has_sharp_peak);
  CHECK(wide.materials[0].angular->back_reflection.hemispherical(3) == doctest::Approx(0.3));
  CHECK(wide.materials[0].angular->to_back.hemispherical(0) == doctest::Approx(0.8).epsilon(1e-3));
  const Scene missing =
      import_scene(folder.write("c.rad", "void aBSDF b 5 no.xml 0 0 1 . 0 0\nb" + square));
  CHECK(missing.materials[0].kind == MaterialKind::diffuse);
  CHECK(missing.warnings.entries().at(0).text.find("no.xml") != std::string::npos);
  CHECK_THROWS_AS(import_scene(folder.write("d.rad", "void aBSDF b 1 w.xml 0 0\nb" + square)),
                  InputError);
}

}  // namespace test_window_xml
