// What one source sends on to the eye by way of each hit of a cluster: radiance × BRDF, for
// surfaces that are not matte and for sources whose radiance varies.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "certified/lobe_competition.h"
#include "light/far_cells.h"
#include "light/web.h"
#include "shadow/source_task.h"
#include "transport/prepared_scene.h"
#include "transport/surface_scattering.h"
#include "transport/vertex.h"

namespace troffer {

// A source as certified visibility treats it whole: a flat piece of a light, several of them
// merged, or a sphere.
struct CertifiedSource {
  bool is_round = false;
  FlatSource flat;
  SphereSource sphere;
  Rgb radiance;  // mean, where it varies
  // A triangle with texture coordinates, a web's opening, or a far cell that is not even
  bool is_textured = false;
  bool is_by_web = false;  // varies by direction alone
  bool is_back = false;    // the light is seen from its back
  uint32_t primitive = 0;  // (one) of LightPrimitives
  uint64_t stream = 0;
  const FarCell* far = nullptr;  // of a light at infinity; it has `radiance`, or varies
  Vec3 towards;                  // … its middle, and how large it is, sr
  float solid_angle = 0;

  Box bounds() const;
  // Projected solid angle from x with unit normal n, nothing hidden, sr.
  double unoccluded(const Vec3d& x, const Vec3d& n) const;
};

// A hit on a surface that is not matte.
struct GlossyHit {
  Frame frame;
  Vec3 wo;
  LobePlace place;
  Bsdf diffuse, rough;  // the second competes with spawned rays
  bool has_diffuse = false, has_rough = false;
  bool is_low_variance = false;  // SurfaceScattering; not rough
  // What a lobe's rays bring otherwise is gathered: they look for sources alone.
  bool is_gathered = false;
};

// BRDF × cosine towards the unit direction wi in the world: the diffuse part, and the share of the
// rough one that is left to points of a source, `density` being LobeCompetition::density().
Rgb glossy_value(const GlossyHit& hit, const Vec3& wi, float density);

// BRDF at x for light from a source, the mean over four points of it or, of a sphere, at its
// middle: for hits that are gentle.
Rgb low_variance_value(const GlossyHit& hit, const CertifiedSource& source, const Vec3& x);

// Hits of the cluster as the integrand sees them.
struct IntegrandHit {
  Vec3 position;
  const GlossyHit* glossy = nullptr;  // null: matte, and the value is the radiance alone
};

// Memory for many directions at a glossy hit.
struct GlossyLanes {
  std::vector<float> x, y, z;       // local, unit
  std::vector<float> above;         // cosine with the geometric normal
  std::vector<float> r, g, b, pdf;  // of the rough part
  void resize(size_t n) {
    for (auto* a : {&x, &y, &z, &above, &r, &g, &b, &pdf}) a->resize(n);
  }
};

class SourceIntegrand final : public ShadowIntegrand {
 public:
  // points: at how many points a source is looked at.
  SourceIntegrand(const PreparedScene& scene, uint32_t points, const LobeCompetition& competition)
      : scene_(scene), points_(points), competition_(competition) {}

  // The cluster at hand: its hits, and its requests' sources, which must stay where they are.
  std::vector<IntegrandHit>& hits() { return hits_; }
  std::vector<const CertifiedSource*>& sources() { return sources_; }
  // Per source: panes that may lie between it and the hits. Empty: the scene has none.
  std::vector<PanesBetween>& behind_panes() { return behind_panes_; }
  // Per request: what its light comes through alone, of which not all hits may see all of the
  // source; mostly null.
  std::vector<const Portal*>& portals() { return portals_; }

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
  // By panes and portals.
  bool is_taken_on_the_way(uint32_t request) const {
    return is_behind_panes(request) || portals_[request] != nullptr;
  }
  // To the receiver, from so far away.
  Rgb left_on_the_way(uint32_t request, const Vec3& receiver, const Vec3& way) const;

  const PreparedScene& scene_;
  uint32_t points_;
  LobeCompetition competition_;
  std::vector<IntegrandHit> hits_;
  std::vector<const CertifiedSource*> sources_;
  std::vector<PanesBetween> behind_panes_;
  std::vector<const Portal*> portals_;
  GlossyLanes lanes_;
  std::vector<float> far_values_;
  WebLanes web_lanes_;
};

}  // namespace troffer
