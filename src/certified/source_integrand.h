// Integrand of certified visibility: radiance of a source × BRDF of a hit, per unit of projected
// solid angle. It is needed for hits that are not matte and for sources whose radiance varies.
// CertifiedLights sets it up for each cluster.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "certified/nominal_source_density.h"
#include "light/sky_patches.h"
#include "light/web.h"
#include "shadow/source_task.h"
#include "transport/prepared_scene.h"
#include "transport/surface_scattering.h"
#include "transport/vertex.h"

namespace troffer {

// One source of certified visibility: a flat piece of a light, several pieces merged, a sphere, or
// a sky patch.
struct CertifiedSource {
  bool is_round = false;
  FlatSource flat;
  SphereSource sphere;
  Rgb radiance;  // mean radiance where it varies
  // True for a textured triangle, the opening of a photometric web, or a non-uniform sky patch.
  bool is_textured = false;
  bool is_by_web = false;  // radiance varies by direction only
  bool is_back = false;    // the back of a two-sided light
  uint32_t primitive = 0;  // index in LightPrimitives; the first of several
  uint64_t stream = 0;
  const SkyPatch* far = nullptr;  // sky patch of an environment light; else null
  Vec3 towards;                   // unit direction from the scene's centre to the patch's
  float solid_angle = 0;          // solid angle of the sky patch, sr

  Box bounds() const;
  // Projected solid angle at x with unit normal n, unoccluded, sr.
  double unoccluded(const Vec3d& x, const Vec3d& n) const;
};

// A hit on a surface that is not matte.
struct GlossyHit {
  Frame frame;
  Vec3 wo;
  SurfacePlace place;
  Bsdf diffuse, rough;  // `rough` competes with spawned rays (MIS)
  bool has_diffuse = false, has_rough = false;
  bool is_low_variance = false;  // SurfaceScattering::is_low_variance; not rough
  // Gathered gloss (SurfaceScattering::is_gathered): spawned rays look for sources only.
  bool is_gathered = false;
};

// Returns BRDF × cosine towards the unit world direction wi: the diffuse part, plus the rough part
// times its MIS weight. density: NominalSourceDensity::density() at wi.
Rgb glossy_value(const GlossyHit& hit, const Vec3& wi, float density);

// Returns the mean BRDF at x for light from a source, over four of its points, or at a sphere's
// centre. For hits with is_low_variance.
Rgb low_variance_value(const GlossyHit& hit, const CertifiedSource& source, const Vec3& x);

// A hit of the cluster as the integrand uses it.
struct IntegrandHit {
  Vec3 position;
  const GlossyHit* glossy = nullptr;  // null: matte, and the value is the radiance
};

// Scratch memory for many directions at a glossy hit.
struct GlossyLanes {
  std::vector<float> x, y, z;       // local unit directions
  std::vector<float> above;         // cosine with the geometric normal
  std::vector<float> r, g, b, pdf;  // rough part only
  void resize(size_t n) {
    for (auto* a : {&x, &y, &z, &above, &r, &g, &b, &pdf}) a->resize(n);
  }
};

// Evaluates the integrand for one cluster at a time. Set hits(), sources(), behind_panes() and
// portals() before each cluster. One object per thread, because it holds scratch memory.
class SourceIntegrand final : public ShadowIntegrand {
 public:
  // points: number of points per source at which gloss and textures are evaluated.
  SourceIntegrand(const PreparedScene& scene, uint32_t points,
                  const NominalSourceDensity& competition)
      : scene_(scene), points_(points), competition_(competition) {}

  // The current cluster's hits, and the sources of its requests, which must not move.
  std::vector<IntegrandHit>& hits() { return hits_; }
  std::vector<const CertifiedSource*>& sources() { return sources_; }
  // Per request: panes that may lie between the source and the hits. Empty if the scene has no
  // panes.
  std::vector<PanesBetween>& behind_panes() { return behind_panes_; }
  // Per request: the portal that hides part of the source from some hits; mostly null.
  std::vector<const Portal*>& portals() { return portals_; }

  // True if the member needs a value from this source, not visibility alone.
  bool is_wanted(uint32_t request, uint32_t member) const {
    return varies(request) || hits_[member].glossy != nullptr;
  }
  uint32_t points(uint32_t request, uint32_t member) override {
    return is_wanted(request, member) ? points_ : 0;
  }
  void evaluate(uint32_t request, uint32_t member, std::span<const Vec3> points,
                std::span<Rgb> values) override;
  bool is_smooth(uint32_t request, uint32_t member) const override {
    return sources_[request]->far != nullptr || sources_[request]->is_by_web ||
           (hits_[member].glossy != nullptr && !varies(request));
  }
  void evaluate_many(uint32_t request, uint32_t member, PointArrays& points) override;
  bool is_low_variance(uint32_t request, uint32_t member) const override;

 private:
  bool is_behind_panes(uint32_t request) const {
    return !behind_panes_.empty() && behind_panes_[request].are_any;
  }
  bool varies(uint32_t request) const {
    return sources_[request]->is_textured || is_behind_panes(request) ||
           portals_[request] != nullptr;
  }
  Rgb radiance_at(const CertifiedSource& source, const Vec3& point, const Vec3& receiver) const;
  void evaluate_gloss(const CertifiedSource& source, const IntegrandHit& hit, PointArrays& points);
  void multiply_by_radiance(const CertifiedSource& source, const IntegrandHit& hit,
                            PointArrays& points);
  void multiply_by_web(const CertifiedSource& source, const IntegrandHit& hit, PointArrays& points);
  void take_on_the_way(uint32_t request, const Vec3& receiver, std::span<const Vec3> points,
                       std::span<Rgb> values) const;
  // True if panes or a portal reduce the light on its way.
  bool is_taken_on_the_way(uint32_t request) const {
    return is_behind_panes(request) || portals_[request] != nullptr;
  }
  // Share of the light that panes and portals leave on the way from the receiver along the vector
  // `way`.
  Rgb left_on_the_way(uint32_t request, const Vec3& receiver, const Vec3& way) const;

  const PreparedScene& scene_;
  uint32_t points_;
  NominalSourceDensity competition_;
  std::vector<IntegrandHit> hits_;
  std::vector<const CertifiedSource*> sources_;
  std::vector<PanesBetween> behind_panes_;
  std::vector<const Portal*> portals_;
  GlossyLanes lanes_;
  std::vector<float> far_values_;
  WebLanes web_lanes_;
};

}  // namespace troffer
