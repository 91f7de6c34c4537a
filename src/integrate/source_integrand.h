// What one source sends on to the eye by way of each hit of a cluster: radiance × BRDF, for
// surfaces that are not matte and for sources whose radiance varies.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "integrate/prepared_scene.h"
#include "integrate/surface_scattering.h"
#include "integrate/vertex.h"
#include "shadow/source_task.h"

namespace troffer {

// A source as certified visibility treats it whole: a flat piece of a light, several of them
// merged, or a sphere.
struct CertifiedSource {
  bool is_round = false;
  FlatSource flat;
  SphereSource sphere;
  Rgb radiance;              // mean, where it varies
  bool is_textured = false;  // a triangle with texture coordinates
  bool is_back = false;      // the light is seen from its back
  uint32_t primitive = 0;    // (one) of LightPrimitives
  uint64_t stream = 0;

  // Projected solid angle from x with unit normal n, nothing hidden, sr.
  double unoccluded(const Vec3d& x, const Vec3d& n) const;
};

// A density of directions, per sr, in which points on the source are chosen for a surface at x with
// unit geometric normal n: close to what is done, and the same whoever asks, which is all that
// multiple importance sampling needs.
float nominal_density(const CertifiedSource& source, const Vec3& x, const Vec3& n, const Vec3& wi);

// A hit on a surface that is not matte.
struct GlossyHit {
  Frame frame;
  Vec3 geometric_normal, wo;
  Bsdf diffuse, rough;  // the second competes with spawned rays
  bool has_diffuse = false, has_rough = false;
};

// Hits of the cluster as the integrand sees them.
struct IntegrandHit {
  Vec3 position;
  const GlossyHit* glossy = nullptr;  // null: matte, and the value is the radiance alone
};

class SourceIntegrand final : public ShadowIntegrand {
 public:
  // points: at how many points a source is looked at.
  SourceIntegrand(const PreparedScene& scene, uint32_t points) : scene_(scene), points_(points) {}

  // The cluster at hand: its hits, and its requests' sources, which must stay where they are.
  std::vector<IntegrandHit>& hits() { return hits_; }
  std::vector<const CertifiedSource*>& sources() { return sources_; }

  bool is_wanted(uint32_t request, uint32_t member) const {
    return sources_[request]->is_textured || hits_[member].glossy != nullptr;
  }
  uint32_t points(uint32_t request, uint32_t member) override {
    return is_wanted(request, member) ? points_ : 0;
  }
  void evaluate(uint32_t request, uint32_t member, std::span<const Vec3> points,
                std::span<Rgb> values) override;

 private:
  Rgb radiance_at(const CertifiedSource& source, const Vec3& point, const Vec3& receiver) const;

  const PreparedScene& scene_;
  uint32_t points_;
  std::vector<IntegrandHit> hits_;
  std::vector<const CertifiedSource*> sources_;
};

}  // namespace troffer
