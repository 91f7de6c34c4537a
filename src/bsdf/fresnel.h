// Fresnel reflectance of unpolarised light.
// References: [1] Born & Wolf, "Principles of Optics", 7th ed., §1.5 (dielectrics), §14.2 (metals).
//   [2] Schlick, "An Inexpensive BRDF Model for Physically-based Rendering", CGF 13(3), 1994.
//   [3] Stokes, "On the Intensity of the Light Reflected from or Transmitted through a Pile of
//       Plates", Proc. Royal Society 11, 1862.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/rgb.h"
#include "base/units.h"

namespace troffer {

// Cosine of the refracted angle for an incident cosine in [0,1] and eta = n_transmitted /
// n_incident; negative on total internal reflection.
inline float refracted_cosine(float cos_i, float eta) {
  const float cos2_t = 1 - (1 - cos_i * cos_i) / (eta * eta);
  return cos2_t > 0 ? std::sqrt(cos2_t) : -1.0f;
}

// Returns the reflectance between two dielectrics [1]; 1 on total internal reflection. Branch-free:
// a refracted cosine of 0 gives total reflection.
inline float fresnel_dielectric(float cos_i, float eta) {
  const float c = std::max(cos_i, 1e-9f);
  const float cos_t = std::sqrt(std::max(0.0f, 1 - (1 - c * c) / (eta * eta)));
  const float parallel = (eta * c - cos_t) / (eta * c + cos_t);
  const float perpendicular = (c - eta * cos_t) / (c + eta * cos_t);
  return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

// Returns the reflectance of a plate with two parallel interfaces, all inter-reflections summed
// [3]: 2 r / (1 + r) for each polarisation, r being the reflectance of one interface. Averaging the
// polarisations first would be wrong: at 60 degrees glass transmits 0.848, not 0.836.
inline float plate_reflectance(float cos_i, float eta) {
  const float c = std::max(cos_i, 1e-9f);
  const float cos_t = std::sqrt(std::max(0.0f, 1 - (1 - c * c) / (eta * eta)));
  const float parallel = sqr((eta * c - cos_t) / (eta * c + cos_t));
  const float perpendicular = sqr((c - eta * cos_t) / (c + eta * cos_t));
  return parallel / (1 + parallel) + perpendicular / (1 + perpendicular);
}

// Shares of light that a plate with an absorbing inside reflects and transmits. The share `a` of
// light is left after each passage through the inside.
struct PlateShares {
  float reflected, transmitted;
};
// Plate whose faces each reflect r of either polarisation.
inline PlateShares absorbing_plate_of(float r, float a) {
  const float through = (1 - r) * (1 - r) * a / std::max(1 - r * r * a * a, 1e-6f);
  return {r + r * a * through, through};
}
inline PlateShares absorbing_plate(float cos_i, float eta, float a) {
  const float c = std::max(cos_i, 1e-9f);
  const float cos_t = std::sqrt(std::max(0.0f, 1 - (1 - c * c) / (eta * eta)));
  PlateShares sum{0, 0};
  for (const float amplitude :
       {(eta * c - cos_t) / (eta * c + cos_t), (c - eta * cos_t) / (c + eta * cos_t)}) {
    const float r = amplitude * amplitude;
    // At grazing incidence r rounds to 1; without absorption numerator and denominator are then 0,
    // and the limit is 0.
    const float through = (1 - r) * (1 - r) * a / std::max(1 - r * r * a * a, 1e-12f);
    sum.transmitted += 0.5f * through;
    sum.reflected += 0.5f * (r + r * a * through);
  }
  return sum;
}

// Reflectance of a conductor of complex index eta + i k seen from vacuum [1].
inline float fresnel_conductor(float cos_i, float eta, float k) {
  const float c2 = cos_i * cos_i, s2 = 1 - c2;
  const float eta2 = eta * eta, k2 = k * k;
  const float t0 = eta2 - k2 - s2;
  const float a2_plus_b2 = std::sqrt(t0 * t0 + 4 * eta2 * k2);
  const float a = std::sqrt(std::max(0.0f, 0.5f * (a2_plus_b2 + t0)));
  const float t1 = a2_plus_b2 + c2, t2 = 2 * cos_i * a;
  const float perpendicular = (t1 - t2) / (t1 + t2);
  const float t3 = c2 * a2_plus_b2 + s2 * s2, t4 = t2 * s2;
  const float parallel = perpendicular * (t3 - t4) / (t3 + t4);
  return std::clamp(0.5f * (parallel + perpendicular), 0.0f, 1.0f);
}

// Clamps an index or extinction from a texture or file. Above 1e4 the surface is a mirror to float
// precision. NaN becomes 0.
inline Rgb safe_index(Rgb v) {
  const auto safe = [](float x) { return x > 0 ? std::min(x, 1e4f) : 0.0f; };
  return {safe(v.r), safe(v.g), safe(v.b)};
}

inline Rgb fresnel_conductor(float cos_i, Rgb eta, Rgb k) {
  return {fresnel_conductor(cos_i, eta.r, k.r), fresnel_conductor(cos_i, eta.g, k.g),
          fresnel_conductor(cos_i, eta.b, k.b)};
}

// Returns the k for which a conductor with eta = 1 has reflectance r at normal incidence. r is
// clamped to 0.9999.
inline float k_from_reflectance(float r) {
  const float c = std::clamp(r, 0.0f, 0.9999f);
  return 2 * std::sqrt(c / (1 - c));
}

inline float pow5(float x) {
  const float x2 = x * x;
  return x2 * x2 * x;
}
// Schlick's reflectance: f0 at normal, f90 at grazing incidence [2]. Its cosine-weighted mean is f0
// + (f90 - f0) / 21.
inline Rgb fresnel_schlick(float cos_i, Rgb f0, Rgb f90) {
  return f0 + (f90 - f0) * pow5(std::max(0.0f, 1 - cos_i));
}

// Reflectance at normal incidence.
inline float normal_reflectance(float eta) {
  return sqr((eta - 1) / (eta + 1));
}

}  // namespace troffer
