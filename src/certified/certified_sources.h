// Sources of certified visibility: the flat pieces, spheres and sky patches of all lights of a
// scene, with their groups and the nominal density of source sampling. Made once per scene and
// settings; used by CertifiedLights and ClusterLighting.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "certified/drawn_lights.h"
#include "certified/environment_sampler.h"
#include "certified/light_groups.h"
#include "certified/nominal_source_density.h"
#include "certified/source_integrand.h"
#include "shadow/source_pieces.h"
#include "trace/closed_shells.h"
#include "trace/occluders.h"
#include "transport/prepared_scene.h"

namespace troffer {

// Environment lights of a scene as sources.
struct CertifiedEnvironment {
  const SkyPatches* cells = nullptr;  // those of the prepared scene
  uint32_t first_source = 0;          // index of the first sky patch; they come last in all()
  const Occluders* occluders = nullptr;
  LargeFacets scene;          // the scene's largest facets
  EnvironmentSampler points;  // sampler of environment lights, used without proofs
  ClosedShells shells;        // closed opaque surfaces, which keep environment light out
  // True if test rays found no environment light on surfaces that other lights reach. Not a proof.
  bool seems_shut_out = false;
  // Per primitive: frame around its portal, which blocks light that passes beside the portal.
  std::vector<std::vector<FacetToAdd>> frames;
  double frame_reach = 0;  // extent of the frames beyond the portals' sides, metres
  Vec3 centre;             // centre of the scene and of the sky cube
  float reach = 0;         // metres from `centre` within which patch directions are exact
};

// Immutable after set_occluders(). Most members are lookup tables, one for each kind of query.
class CertifiedSources {
 public:
  // are_drawn: lights may be sampled even where they are few. gloss_points: points per source at
  // which glossy BRDFs and textured radiance are evaluated. `scene` must outlive this object.
  CertifiedSources(const PreparedScene& scene, bool are_drawn, uint32_t gloss_points);
  CertifiedSources(const CertifiedSources&) = delete;
  CertifiedSources& operator=(const CertifiedSources&) = delete;

  // True if these sources and groups cover all of `light`, certified or sampled.
  bool has(uint32_t light) const { return has_light_[light] || is_drawn_[light]; }
  // True if the light is always sampled: a mesh of too many pieces that lie in no common plane, or
  // a light without a certificate shape (light.h).
  bool is_drawn(uint32_t light) const { return is_drawn_[light]; }
  bool is_empty() const { return groups_.size() == 0 && environment_.cells->all().empty(); }
  // Nominal density of source sampling, for MIS weights of rays that lobes spawn.
  const NominalSourceDensity& competition() const { return competition_; }
  // Returns the source that covers `point` on a light primitive, seen from its front or its back;
  // null if none does.
  const CertifiedSource* source_of(uint32_t primitive, bool is_back, const Vec3& point) const;
  // Returns the sky patch of an environment light in `direction`; null if there is none.
  const CertifiedSource* source_towards(uint32_t primitive, const Vec3& direction) const;

  // Prepares environment lights. Call before the first hits; `occluders` must outlive this object.
  // Does nothing if the scene has no environment lights.
  void set_occluders(const Occluders& occluders);

  const std::vector<CertifiedSource>& all() const { return sources_; }
  const LightGroups& groups() const { return groups_; }
  const CertifiedEnvironment& environment() const { return environment_; }
  // Largest extent of a cluster on a curved surface, metres.
  float reach() const { return reach_; }

 private:
  void add_source(const CertifiedSource& source, std::span<const uint32_t> primitives);
  bool add_light(const PreparedScene& scene, uint32_t light);
  bool add_flat_light(const PreparedScene& scene, uint32_t light,
                      const std::vector<SourcePiece>& pieces);
  void add_drawn_lights(const PreparedScene& scene);
  void add_far_lights(const PreparedScene& scene);

  const PreparedScene& scene_;
  std::vector<CertifiedSource> sources_;
  LightGroups groups_;
  NominalSourceDensity competition_;
  std::vector<bool> has_light_, is_drawn_;
  // Linked lists of the sources on each side of a primitive. source_of_front_ and source_of_back_
  // hold the last source of each primitive, before_ the preceding source of each source. -1 ends a
  // list.
  std::vector<int32_t> source_of_front_, source_of_back_, before_;
  CertifiedEnvironment environment_;
  float reach_ = 1;
};

}  // namespace troffer
