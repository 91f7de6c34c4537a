// Energy balance of a solution compared with photons traced from the source.
#include <doctest/doctest.h>

#include <cmath>

#include "base/frame.h"
#include "base/random.h"
#include "base/warp.h"
#include "radiosity/rooms.h"
#include "trace/surface.h"

using namespace troffer;
using namespace troffer::test;

namespace {

struct Fate {
  double absorbed = 0, specular = 0, escaped = 0;
};

// Traces photons from the 1 m² source of lit_room, which emits downwards. `rho` is the diffuse
// reflectance by mesh; `specular` is the share by mesh that ends as specular light.
Fate trace_photons(const Ready& ready, const std::vector<float>& rho,
                   const std::vector<float>& specular, int count) {
  Fate fate;
  Random r(4);
  for (int i = 0; i < count; ++i) {
    Vec3 at{1.5f + r.next_float(), 1 + r.next_float(), 2.3999f}, n{0, 0, -1};
    double weight = 1.0 / count;
    while (weight > 1e-4 / count) {
      Ray ray;
      ray.origin = at;
      ray.direction = Frame(n).to_world(cosine_hemisphere_from_square(r.next_vec2()));
      Hit hit;
      ready.tracer.closest({&ray, 1}, {&hit, 1});
      if (!hit.is_valid()) {
        fate.escaped += weight;
        break;
      }
      const Surface s = surface_at(ready.scene, ray, hit);
      const double d = double(rho[s.geometry]), o = double(specular[s.geometry]);
      fate.specular += weight * o;
      fate.absorbed += weight * (1 - d - o);
      weight *= d;
      n = dot(s.geometric_normal, ray.direction) < 0 ? s.geometric_normal : -s.geometric_normal;
      at = offset_origin(s, n);
    }
  }
  return fate;
}

}  // namespace

TEST_CASE("light agrees with photon tracing in an open room with a block and a pane of glass") {
  Scene s = lit_room(0.7f);
  std::vector<float> rho(6, 0.7f), specular(6, 0.0f);
  rho.push_back(0);  // the source
  const uint32_t dark = add_diffuse(s, Rgb{0.2f});
  for (const uint32_t q : add_box_inside(s, dark, {1.2f, 0.8f, 0.6f}, {2.2f, 1.6f, 1.1f}))
    std::swap(s.meshes[q].positions[1], s.meshes[q].positions[3]);
  rho.resize(s.meshes.size(), 0.2f);
  Material glass;
  glass.kind = MaterialKind::dielectric;
  glass.base_color.value = Rgb{1};
  s.meshes[2].material = add_material(s, glass);
  rho[2] = 0;
  specular.resize(s.meshes.size(), 0.0f);
  specular[2] = 1;
  s.meshes[4].positions = {
      Vec3{9, 9, 9}, {9, 9, 9.1f}, {9, 9.1f, 9}, {9, 9.1f, 9.1f}};  // one wall removed
  const Ready ready(std::move(s));
  RadiosityOptions o;
  o.meshing = sizes(0.3f, 0.9f);
  o.unshot_fraction = 0.001f;
  const EnergyBalance b = ready.solve(o).balance;
  const Fate fate = trace_photons(ready, rho, specular, 200000);
  MESSAGE("photons (radiosity): absorbed "
          << fate.absorbed << " (" << b.absorbed / b.emitted << "), specular " << fate.specular
          << " (" << b.lost_to_specular / b.emitted << "), escaped " << fate.escaped << " ("
          << b.escaped / b.emitted << ")");
  CHECK(fate.escaped > 0.05);
  CHECK(fate.specular > 0.05);
  CHECK(std::abs(b.absorbed / b.emitted - fate.absorbed) < 0.01);
  CHECK(std::abs(b.lost_to_specular / b.emitted - fate.specular) < 0.01);
  CHECK(std::abs(b.escaped / b.emitted - fate.escaped) < 0.01);
}
