// Property: a scene that converts without a warning looks the same. Random materials, images,
// placements, alpha, normal maps and emission are rendered by paths, directly and after a round
// trip through glTF and pbrt. Means over quarters of the pictures agree within noise.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <random>

#include "base/units.h"
#include "export/export_scene.h"
#include "import/import.h"
#include "program.h"
#include "render/render.h"

using namespace troffer;
using namespace troffer::test;

namespace test_round_trip_light {

namespace {

const StopFlag never_stop = false;

class RandomScene {
 public:
  explicit RandomScene(uint32_t seed) : random_(seed) {}

  Scene make() {
    scene_.is_photometric = true;
    add_material();
    Mesh sheet;
    sheet.name = "sheet";
    sheet.positions = {{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}};
    sheet.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    if (is(0.3)) sheet.uvs = {{-0.5f, 1.2f}, {1.7f, 1.2f}, {1.7f, -0.4f}, {-0.5f, -0.4f}};
    if (is(0.2))
      for (Vec2& uv : sheet.uvs) uv.x = -uv.x;  // mirrored
    sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene_.meshes.push_back(sheet);
    Material grey;
    grey.base_color.value = Rgb{0.5f};
    scene_.materials.push_back(grey);
    Mesh floor = sheet;
    floor.name = "floor";
    floor.material = 1;
    for (Vec3& p : floor.positions) p = p * 3 + Vec3{0, -1, 0};
    scene_.meshes.push_back(floor);
    add_lamp();
    add_camera();
    return std::move(scene_);
  }

 private:
  std::mt19937 random_;
  Scene scene_;

  float number(float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random_);
  }
  bool is(double share) { return number(0, 1) < float(share); }

  int32_t image(int channels, bool is_srgb, uint8_t low, uint8_t high) {
    Texture t;
    t.kind = TextureKind::image;
    t.width = is(0.5) ? 4 : 3;
    t.height = is(0.5) ? 4 : 2;
    t.channels = channels;
    t.is_srgb = is_srgb;
    t.is_filtered = is(0.7);
    for (int i = 0; i < t.width * t.height * channels; ++i)
      t.texels8.push_back(uint8_t(number(float(low), float(high))));
    const std::array<WrapMode, 3> wraps{WrapMode::repeat, WrapMode::clamp, WrapMode::mirror};
    t.wrap_u = wraps[random_() % 3];
    t.wrap_v = is(0.7) ? t.wrap_u : wraps[random_() % 3];
    if (is(0.4)) t.uv_scale = {number(0.5f, 2), number(0.5f, 2)};
    if (is(0.4)) t.uv_offset = {number(-0.5f, 0.5f), number(-0.5f, 0.5f)};
    if (is(0.2)) t.uv_rotation_rad = number(-2, 2);
    scene_.textures.push_back(std::move(t));
    return int32_t(scene_.textures.size() - 1);
  }

  void add_material() {
    Material m;
    m.kind = is(0.6) ? MaterialKind::diffuse : MaterialKind::metallic_roughness;
    m.base_color.value = {number(0.2f, 0.9f), number(0.2f, 0.9f), number(0.2f, 0.9f)};
    const bool has_alpha = is(0.5);
    if (is(0.6)) m.base_color.texture = image(has_alpha ? 4 : 3, true, 40, 255);
    if (has_alpha) {
      m.is_alpha_masked = true;
      m.is_alpha_blended = is(0.5);
      m.alpha.value = number(0.3f, 1);
      m.alpha.texture = m.base_color.texture;
      m.alpha_cutoff = number(0.2f, 0.6f);
      if (is(0.3)) m.alpha = {1, image(1, false, 0, 255), 0};
    }
    if (is(0.4)) {
      m.normal_texture = image(3, false, 90, 165);
      m.normal_scale = is(0.5) ? 1.0f : number(0.5f, 1.5f);
      Texture& t = scene_.textures.back();
      for (size_t i = 2; i < t.texels8.size(); i += 3) t.texels8[i] = 240;
    }
    if (m.kind == MaterialKind::metallic_roughness) {
      m.roughness_meaning = RoughnessMeaning::alpha_is_square;
      m.roughness.value = number(0.4f, 1);
      m.metallic.value = is(0.5) ? 0 : number(0, 1);
      if (is(0.4)) m.roughness = {1, image(3, false, 100, 255), 1};
      if (is(0.3)) m.metallic = {1, image(3, false, 0, 255), 2};
      if (is(0.3)) m.specular_color.texture = image(3, true, 100, 255);
      if (is(0.3)) {
        m.sheen_color = {Rgb{0.5f}, is(0.5) ? image(3, true, 50, 255) : no_texture};
        m.sheen_roughness.value = number(0.3f, 1);
      }
      if (is(0.3)) m.coat.value = number(0.2f, 1);
      m.coat_roughness.value = 0.3f;
    }
    scene_.materials.push_back(std::move(m));
  }

  void add_lamp() {
    Mesh lamp;
    lamp.name = "lamp";
    lamp.positions = {{-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1}};
    lamp.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    lamp.triangles = {{0, 1, 2}, {0, 2, 3}};
    lamp.lights = {0, 0};
    lamp.material = 2;
    Material black;
    black.base_color.value = Rgb{0};
    scene_.materials.push_back(black);
    Light e;
    e.name = "lamp";
    e.kind = LightKind::mesh;
    e.radiance = {100, 90, 80};
    e.geometry = 2;
    e.triangles = {0, 1};
    if (is(0.5)) e.texture = image(3, true, 0, 255);
    scene_.lights.push_back(e);
    scene_.meshes.push_back(lamp);
  }

  void add_camera() {
    Camera c;
    c.position = {0, 1.9f, 0};
    c.forward = {0, -1, 0};
    c.right = {1, 0, 0};
    c.up = {0, 0, -1};
    c.half_extent = 0.55f;
    c.width = c.height = 16;
    scene_.cameras.push_back(c);
  }
};

// Returns the mean luminance of the picture's quarters, cd/m².
std::array<double, 4> quarters(Scene scene) {
  RenderOptions o;
  o.method = Method::path;
  o.depth = 3;
  o.spp = 256;
  o.width = o.height = 16;
  o.threads = 2;
  const Camera camera = scene.cameras.at(0);
  const double unit = scene.is_photometric ? 1 : luminous_efficacy;
  const PreparedScene prepared(std::move(scene));
  const RenderResult r = render(prepared, camera, o, {}, never_stop);
  std::array<double, 4> sum{};
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x)
      sum[size_t(2 * (y / 8) + x / 8)] += double(luminance(r.layers[0].image.at(x, y))) * unit / 64;
  return sum;
}

}  // namespace

TEST_CASE("a scene that is converted without a warning looks the same") {
  size_t compared = 0;
  for (uint32_t seed = 1; seed <= 24; ++seed) {
    const Scene scene = RandomScene(seed).make();
    const std::array<double, 4> wanted = quarters(scene);
    for (const char* name : {"out.gltf", "out.pbrt"}) {
      CAPTURE(seed);
      CAPTURE(name);
      const Folder folder;
      bool is_told = false;
      for (const Warning& w : export_scene(scene, folder.path(name)))
        is_told = is_told || w.text.find("backs") == std::string::npos;
      if (is_told) continue;
      ++compared;
      const std::array<double, 4> is = quarters(import_scene(folder.path(name)));
      for (size_t k = 0; k < 4; ++k) CHECK(std::abs(is[k] - wanted[k]) < 0.05 * wanted[k] + 0.05);
    }
  }
  CHECK(compared >= 16);
}

}  // namespace test_round_trip_light
