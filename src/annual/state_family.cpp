#include "annual/state_family.h"

#include <algorithm>
#include <map>

namespace troffer {

namespace {

// Boxes of one region. More of them follow the surfaces more closely, but cost time per ray.
constexpr size_t most_boxes = 4;

bool are_same_places(std::span<const CellHit> a, std::span<const CellHit> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const CellHit& x, const CellHit& y) {
    return x.position == y.position && x.normal == y.normal && x.horizon == y.horizon &&
           x.offset == y.offset;
  });
}

// A family that is being formed.
struct FamilyDraft {
  StateFamily family;
  SceneSurfaces surfaces;                    // of its first state
  std::map<size_t, std::vector<Box>> boxes;  // by path

  // Adds the state if it can be compared with the first one.
  bool takes(const SceneOfState& state, size_t number) {
    if (!are_same_places(state.sensors, family.sensors)) return false;
    const auto changed = surfaces.boxes_of_change(SceneSurfaces(state.scene->scene));
    if (!changed) return false;
    std::vector<Box>& of_path = boxes[state.path];
    of_path.insert(of_path.end(), changed->begin(), changed->end());
    // The region is the path's number until all paths are known.
    family.states.push_back({number, state.scene, state.path});
    return true;
  }
};

}  // namespace

std::vector<StateFamily> state_families(std::span<const SceneOfState> states) {
  std::vector<FamilyDraft> drafts;
  for (size_t k = 0; k < states.size(); ++k) {
    const auto takes = [&](FamilyDraft& d) { return d.takes(states[k], k); };
    if (std::any_of(drafts.begin(), drafts.end(), takes)) continue;
    FamilyDraft& draft =
        drafts.emplace_back(FamilyDraft{{}, SceneSurfaces(states[k].scene->scene), {}});
    draft.family.states.push_back({k, states[k].scene, states[k].path});
    draft.family.sensors.assign(states[k].sensors.begin(), states[k].sensors.end());
  }
  std::vector<StateFamily> families;
  for (FamilyDraft& d : drafts) {
    std::map<size_t, size_t> region_of;
    for (const auto& [path, boxes] : d.boxes) {
      region_of[path] = d.family.regions.size();
      d.family.regions.add(few_boxes(boxes, most_boxes));
    }
    for (StateOfFamily& s : d.family.states) s.region = region_of[s.region];
    families.push_back(std::move(d.family));
  }
  return families;
}

}  // namespace troffer
