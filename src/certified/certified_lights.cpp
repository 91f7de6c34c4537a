#include "certified/certified_lights.h"

#include "certified/cluster_lighting.h"

namespace troffer {

void CertifiedLights::illuminate(CertifiedLightsScratch& s, RadianceBatch& out,
                                 Counters& counters) const {
  if (s.hits.size() == 0) return;
  const CertifiedEnvironment& environment = sources_.environment();
  if (!find_closed_off(s))
    s.far = estimate_environment_share(environment_inputs(scene_, sources_, s.hits),
                                       environment.seems_shut_out);
  cluster_receivers(s.hits.positions, s.hits.horizons, sources_.reach(), s.clusters);
  ClusterLighting lighting(scene_, sources_, budget_, s, out, counters);
  for (size_t c = 0; c < s.clusters.size(); ++c) lighting.add(s.clusters.members(c));
  resolve_draws(scene_, s.hits, s.drawn, out, counters);
  s.hits.clear();
}

bool CertifiedLights::find_closed_off(CertifiedLightsScratch& s) const {
  const CertifiedEnvironment& environment = sources_.environment();
  s.is_closed_off.assign(s.hits.size(), environment.points.is_empty() ? 1 : 0);
  if (environment.points.is_empty()) return true;
  if (environment.shells.is_empty()) return false;
  bool are_all = true;
  for (size_t i = 0; i < s.hits.size(); ++i) {
    s.is_closed_off[i] = environment.shells.hold(s.hits.receivers[i].origin) ? 1 : 0;
    are_all = are_all && s.is_closed_off[i] != 0;
  }
  return are_all;
}

}  // namespace troffer
