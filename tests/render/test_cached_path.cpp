// Path tracing that ends at cells (`--method cached-path`) against path tracing.
#include <doctest/doctest.h>

#include <cmath>

#include "render/furnace.h"
#include "render/pictures.h"

using namespace troffer;
using namespace troffer::test;

TEST_CASE("cached paths: a furnace has the same radiance everywhere") {
  const PreparedScene scene(uneven_furnace());
  RenderOptions o = furnace_options();
  o.method = Method::cached_path;
  o.spp = 64;
  const Image picture = render_now(scene, furnace_camera(), o).layers[0].image;
  CHECK(mean_green(picture) == doctest::Approx(double(L0)).epsilon(0.004));
}

TEST_CASE("cached paths: matte and coated surfaces agree with path tracing, at less noise") {
  Scene s;
  Material coated;
  coated.kind = MaterialKind::coated_diffuse;
  coated.base_color.value = Rgb{0.6f};
  coated.roughness.value = 0.3f;
  const uint32_t floor = add_material(s, coated), matte = add_diffuse(s, Rgb{0.7f});
  add_box_inside(s, matte, {-2, -2, 0}, {2, 2, 2.5f});
  add_quad(s, floor, {Vec3{-2, -2, 0.01f}, {2, -2, 0.01f}, {2, 2, 0.01f}, {-2, 2, 0.01f}});
  add_ceiling_light(s, 0.5f, 2.4f, Rgb{20});
  const PreparedScene scene(std::move(s));
  const Camera camera = look_at({-1.6f, -1.6f, 1.4f}, {0.5f, 0.5f, 0.6f}, {0, 0, 1}, 70);
  RenderOptions o;
  o.width = 48;
  o.height = 36;
  o.threads = 2;
  o.spp = o.max_spp = 64;
  const auto pictures = [&](Method method) {
    RenderOptions chosen = o;
    chosen.method = method;
    return render_ensemble(scene, camera, chosen, 4);
  };
  const Ensemble cached = pictures(Method::cached_path), paths = pictures(Method::path);
  CHECK(cached.mean.mean() == doctest::Approx(paths.mean.mean()).epsilon(0.01));
  const auto variance = [](const Ensemble& e) {
    double sum = 0;
    for (const auto& p : e.pixels) sum += p.standard_error() * p.standard_error();
    return sum;
  };
  CHECK(variance(cached) < 0.9 * variance(paths));
}
