// Tests of measured reflection: the approximation of tensor files, and invalid files.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "base/random.h"
#include "base/units.h"
#include "import/measured_bsdf.h"
#include "import/mitsuba/mitsuba.h"
#include "import/pbrt/pbrt.h"
#include "import/scene_checks.h"
#include "import/temp_folder.h"

using namespace troffer;

namespace test_measured {

namespace {

template <class T>
void append(std::string& to, T value) {
  to.append(reinterpret_cast<const char*>(&value), sizeof value);
}

struct Field {
  std::string name;
  std::vector<uint64_t> shape;
  std::vector<float> values;
};

std::string tensor_file(const std::vector<Field>& fields) {
  size_t head = 18;
  for (const Field& f : fields) head += 2 + f.name.size() + 2 + 1 + 8 + 8 * f.shape.size();
  std::string out("tensor_file\0", 12), data;
  out += '\1';
  out += '\0';
  append(out, uint32_t(fields.size()));
  for (const Field& f : fields) {
    append(out, uint16_t(f.name.size()));
    out += f.name;
    append(out, uint16_t(f.shape.size()));
    append(out, uint8_t(10));
    append(out, uint64_t(head + data.size()));
    for (const uint64_t n : f.shape) append(out, n);
    for (const float v : f.values) append(data, v);
  }
  return out + data;
}

// Returns a tensor file with a GGX density of normals of width alpha, plus a uniform share `even`.
// Every channel reflects `low` at normal incidence and `high` at 60 degrees, half of that at one
// edge of the square.
std::string measured(float alpha, float even, float low, float high, size_t normals = 200) {
  std::vector<float> ndf(normals);
  for (size_t i = 0; i < normals; ++i) {
    const double theta = pi / 2 * sqr(double(i) / double(normals - 1)), c = std::cos(theta);
    const double t2 = sqr(std::tan(theta)) / sqr(double(alpha));
    ndf[i] = float((1 - double(even)) / (pi * sqr(double(alpha) * c * c * (1 + t2))) +
                   double(even) / pi);
  }
  std::vector<float> spectra;
  for (const float value : {low, low, low, high, high, high})
    spectra.insert(spectra.end(), {value, value, value, value});
  return tensor_file({{"theta_i", {2}, {0, float(pi / 3)}},
                      {"phi_i", {1}, {0}},
                      {"ndf", {1, normals}, ndf},
                      {"wavelengths", {3}, {300, 550, 1100}},
                      {"spectra", {1, 2, 3, 2, 2}, spectra}});
}

struct Read {
  Material material;
  WarningLog warnings;
};
Read read(const std::string& bytes) {
  const TempFolder folder;
  folder.write("m.bsdf", bytes);
  Read r;
  r.material = measured_material(folder.path(""), "m.bsdf", r.warnings);
  return r;
}

}  // namespace

TEST_CASE("a measured metal keeps its width and colour; the uniform part becomes diffuse") {
  for (const float alpha : {0.05f, 0.2f, 0.5f}) {
    const Read r = read(measured(alpha, 0, 0.4f, 0.4f));
    CAPTURE(alpha);
    CHECK(r.warnings.total() == 1);
    CHECK(r.material.kind == MaterialKind::metallic_roughness);
    CHECK(r.material.roughness.value == doctest::Approx(double(alpha)).epsilon(0.05));
    CHECK(r.material.metallic.value > 0.93f);
    for (size_t c = 0; c < 3; ++c)
      CHECK(r.material.base_color.value[c] == doctest::Approx(0.4).epsilon(0.01));
  }
  CHECK(read(measured(0.1f, 0.6f, 0.4f, 0.4f)).material.metallic.value ==
        doctest::Approx(0.4).epsilon(0.1));
  // Normal incidence has no weight under uniform light.
  CHECK(read(measured(0.2f, 0, 0.1f, 0.6f)).material.base_color.value.g ==
        doctest::Approx(0.6).epsilon(0.01));
}

TEST_CASE("measured materials of pbrt and Mitsuba") {
  const TempFolder folder;
  folder.write("m.bsdf", measured(0.2f, 0, 0.3f, 0.3f));
  const Scene a =
      import_pbrt(folder.write("s.pbrt",
                               "WorldBegin\nMaterial \"measured\" \"string filename\" \"m.bsdf\"\n"
                               "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]\n"));
  const Scene b = import_mitsuba(
      folder.write("s.xml",
                   "<scene version='3.0.0'><shape type='rectangle'><bsdf type='measured'><string "
                   "name='filename' value='m.bsdf'/></bsdf></shape></scene>"));
  for (const Scene* s : {&a, &b}) {
    const Material& m = s->materials[s->meshes[0].material];
    CHECK(m.roughness.value == doctest::Approx(0.2).epsilon(0.05));
    CHECK(m.base_color.value.g == doctest::Approx(0.3).epsilon(0.01));
    CHECK(has_warning(*s, "measured 'm.bsdf'"));
  }
}

TEST_CASE("missing or invalid measured files are shown grey, with one warning") {
  const auto check_grey = [](const Read& r, const char* what) {
    CAPTURE(what);
    REQUIRE(r.warnings.entries().size() == 1);
    CHECK(r.warnings.entries()[0].text.find(what) != std::string::npos);
    CHECK(r.material.kind == MaterialKind::diffuse);
    CHECK(r.material.base_color.value == Rgb{0.5f});
  };
  const std::string good = measured(0.2f, 0, 0.3f, 0.3f, 20);
  check_grey(read("PF"), "is not a tensor file");
  check_grey(read(good.substr(0, 40)), "ends too early");
  check_grey(read(good.substr(0, good.size() - 4)), "outside the file");
  Read r;
  const TempFolder folder;
  for (const char* name : {"none.bsdf", "../up.bsdf", "/etc/passwd", ""}) {
    r = {};
    r.material = measured_material(folder.path(""), name, r.warnings);
    check_grey(r, "grey");
  }
  // An extent beyond all memory.
  std::string huge = good;
  const uint64_t most = ~uint64_t(0) / 2;
  std::memcpy(huge.data() + huge.find("theta_i") + 7 + 2 + 1 + 8, &most, sizeof most);
  check_grey(read(huge), "theta_i");
  Random random(7);
  for (int i = 0; i < 1000; ++i) {
    std::string bytes = good;
    for (uint32_t k = 0; k < 1 + random.next_u32() % 6; ++k)
      bytes[random.next_u32() % (i % 2 ? 200 : bytes.size())] = char(random.next_u32());
    const Read any = read(bytes);
    CHECK(any.warnings.entries().size() == 1);
    CHECK(is_finite(any.material.base_color.value));
    CHECK(any.material.roughness.value >= 0);
    CHECK(any.material.roughness.value <= 1);
  }
}

}  // namespace test_measured
