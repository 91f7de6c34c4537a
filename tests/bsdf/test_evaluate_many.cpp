// Evaluation of many directions at once equals evaluation one by one.
#include <doctest/doctest.h>

#include <cmath>

#include "base/random.h"
#include "bsdf/evaluate_many.h"
#include "bsdf/samples.h"

using namespace troffer;
using namespace troffer::test;

TEST_CASE("a Bsdf evaluated for many directions at once equals single evaluations") {
  std::vector<Material> m{material_of(MaterialKind::diffuse, 0, {0.7f, 0.5f, 0.3f})};
  for (const float alpha : {0.0f, 0.002f, 0.05f, 0.3f, 1.0f}) {
    m.push_back(mirror_metal(alpha, {0.9f, 0.6f, 0.2f}));
    m.push_back(copper(alpha));
    m.push_back(coated(alpha, {0.6f, 0.7f, 0.1f}));
    m.push_back(coated(alpha, Rgb{1}, 2.2f));
    m.push_back(glass(alpha));
    for (const float metallic : {0.0f, 0.4f, 1.0f})
      m.push_back(gltf(alpha, metallic, {0.8f, 0.5f, 0.9f}, 0, false));
  }
  m.push_back(clear_coated(gltf(0.3f, 0.4f, {0.8f, 0.5f, 0.9f}), 0.1f));
  m.push_back(tinted(0.3f));
  m.push_back(reflecting(coated(0.3f, Rgb{0.8f}), {0.9f, 0.5f, 0}));
  m.push_back(sheened(gltf(0.5f, 0.7f, {0.3f, 0.7f, 0.9f}), 0.6f));
  m.push_back(filmed(gltf(0.3f, 0.4f, {0.8f, 0.5f, 0.9f}), 450));
  const Specimens s(m);
  Random random(11);
  constexpr size_t n = 150;
  std::vector<float> x(n), y(n), z(n), r(n), g(n), b(n), pdf(n);
  int bright = 0;
  for (size_t i = 0; i < s.size(); ++i)
    for (const Bsdf& bsdf : {s.at(i), diffuse_part(s.at(i)), specular_part(s.at(i))}) {
      for (const float cosine : {1.0f, 0.6f, 0.05f, -0.1f}) {
        const Vec3 wo = direction(cosine, 6 * random.next_float());
        for (size_t k = 0; k < n; ++k) {
          // every second direction lies near the mirror direction
          Vec3 wi = direction(2 * random.next_float() - 1, 6 * random.next_float());
          if (k % 2 == 1)
            wi = normalize(Vec3{-wo.x, -wo.y, wo.z} + wi * (0.3f * random.next_float()));
          x[k] = wi.x;
          y[k] = wi.y;
          z[k] = wi.z;
        }
        evaluate_many(bsdf, wo, n,
                      {x.data(), y.data(), z.data(), r.data(), g.data(), b.data(), pdf.data()});
        CAPTURE(i);
        CAPTURE(cosine);
        for (size_t k = 0; k < n; ++k) {
          const BsdfValue one =
              z[k] > 0 ? evaluate_with_pdf(bsdf, wo, {x[k], y[k], z[k]}) : BsdfValue{};
          // narrow lobes amplify rounding of the half vector
          const auto is_near = [](float a, float expected) {
            return std::abs(a - expected) <= 2e-3f * std::abs(expected) + 1e-6f;
          };
          CHECK(is_near(r[k], one.f_cos.r));
          CHECK(is_near(g[k], one.f_cos.g));
          CHECK(is_near(b[k], one.f_cos.b));
          CHECK(is_near(pdf[k], one.pdf));
          bright += one.f_cos.g > 0.01f ? 1 : 0;
        }
      }
    }
  CHECK(bright > 5000);
}
