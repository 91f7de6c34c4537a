#include "bake/sides.h"

#include "bake/atlas.h"
#include "base/random.h"
#include "base/streams.h"

namespace troffer {

namespace {

constexpr int samples_of_side = 32;
constexpr float least_lit = 0.002f;  // relative to the other side's light: dark below
constexpr float least_room = 0.5f;   // share of rays that must hit fronts

// Charts that are visible from both sides. Site 2 i is the front of chart i, the next site its
// back.
class SideSites final : public SiteList {
 public:
  struct ChartAt {
    uint32_t stand, chart;
  };
  explicit SideSites(const BakedSurfaces& surfaces) : surfaces_(surfaces) {
    for (uint32_t s = 0; s < surfaces.stands.size(); ++s) {
      const uint32_t material = surfaces.charted[surfaces.stands[s].charted].mesh.material;
      if (surfaces.scene.materials[material].back_faces != BackFaces::shown) continue;
      const auto charts = uint32_t(surfaces.charts_of(surfaces.stands[s]).size());
      for (uint32_t c = 0; c < charts; ++c) charts_.push_back({s, c});
    }
  }
  const std::vector<ChartAt>& charts() const { return charts_; }
  size_t size() const override { return 2 * charts_.size(); }
  void pieces(size_t site, std::vector<Piece>& out) const override {
    const Stand& stand = surfaces_.stands[charts_[site / 2].stand];
    const MeshInWorld mesh = surfaces_.mesh(stand);
    for (const uint32_t t : surfaces_.charts_of(stand)[charts_[site / 2].chart].triangles) {
      Piece piece = piece_of(mesh, t);
      const auto& p = piece.positions;
      piece.weight = length(cross(Vec3d(p[1]) - Vec3d(p[0]), Vec3d(p[2]) - Vec3d(p[0])));
      if (site % 2 == 1) {
        piece.geometric_normal = -piece.geometric_normal;
        for (Vec3& n : piece.normals) n = -n;
      }
      out.push_back(piece);
    }
  }

 private:
  const BakedSurfaces& surfaces_;
  std::vector<ChartAt> charts_;
};

struct SidesOfChart {
  bool is_front_lit = false, is_back_lit = false;
  bool is_front_in_room = false, is_back_in_room = false;

  LitSides sides() const {
    if (is_front_lit == is_back_lit) return is_front_lit ? LitSides::both : LitSides::front;
    if (is_front_lit) return is_back_in_room ? LitSides::front_more : LitSides::front;
    return is_front_in_room ? LitSides::back_more : LitSides::back;
  }
};

}  // namespace

std::vector<std::vector<LitSides>> lit_sides(const PreparedScene& scene,
                                             const Integrator& integrator,
                                             const BakedSurfaces& surfaces,
                                             const SiteSettings& settings, const StopFlag& stop) {
  const SideSites sites(surfaces);
  SiteSettings few = settings;
  few.samples = samples_of_side;
  few.seed = hash_of(settings.seed, stream::bake_sides);
  Counters counters;
  const std::vector<SiteLight> light =
      light_sites(scene, integrator, sites, few, {}, stop, counters);
  if (light.size() < sites.size()) return {};
  std::vector<std::vector<SidesOfChart>> found(surfaces.charted.size());
  for (size_t i = 0; i < sites.charts().size(); ++i) {
    const Stand& stand = surfaces.stands[sites.charts()[i].stand];
    std::vector<SidesOfChart>& charts = found[stand.charted];
    charts.resize(surfaces.charts_of(stand).size());
    SidesOfChart& chart = charts[sites.charts()[i].chart];
    const float front = luminance(light[2 * i].irradiance);
    const float back = luminance(light[2 * i + 1].irradiance);
    const bool is_front_lit = front > least_lit * back, is_back_lit = back > least_lit * front;
    chart.is_front_lit = chart.is_front_lit || is_front_lit;
    chart.is_back_lit = chart.is_back_lit || is_back_lit;
    const auto is_in_room = [&](size_t site) {
      return share_of_fronts(scene, sites, site, few.seed) > least_room;
    };
    if (is_front_lit && !is_back_lit && !chart.is_back_in_room)
      chart.is_back_in_room = is_in_room(2 * i + 1);
    if (is_back_lit && !is_front_lit && !chart.is_front_in_room)
      chart.is_front_in_room = is_in_room(2 * i);
  }
  std::vector<std::vector<LitSides>> out(found.size());
  for (size_t i = 0; i < found.size(); ++i)
    for (const SidesOfChart& c : found[i]) out[i].push_back(c.sides());
  return out;
}

}  // namespace troffer
