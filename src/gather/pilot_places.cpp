#include "gather/pilot_places.h"

#include <string>

#include "base/error.h"

namespace troffer {

std::vector<PilotPlace> places_of(const CellPilot& pilot, const GatherWalks& walks,
                                  Counters& counters) {
  std::vector<PilotPlace> places;
  for (const CellHit& p : pilot.places) places.push_back({p, 1, 0, false});
  GatherScratch s;
  start_walks(pilot.viewing, s.walks);
  const CheckContext context(&s, pilot.viewing.size(), [](const void*, size_t i) {
    return "pilot ray " + std::to_string(i);
  });
  walks.follow(pilot.viewing.size(), Coherence::none, s, counters);
  for (const GatherArrival& a : s.arrivals)
    places.push_back({a.hit, luminance(a.walk.throughput), a.distance, a.walk.scatterings > 0});
  return places;
}

}  // namespace troffer
