#include "radiosity/solution.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace troffer {

size_t RadiositySolution::memory_bytes() const {
  return mesh.memory_bytes() +
         (general.capacity() + general_direct.capacity() + shot_radiance.capacity()) * sizeof(Rgb) +
         stored.capacity() * sizeof(StoredContribution);
}

namespace {

// Adds warnings for accuracy or surfaces that the mesh gave up to keep its bounds.
void add_mesh_warnings(const RadiositySolution& s, std::vector<std::string>& out) {
  const RadiosityMesh& mesh = s.mesh;
  const MeshingOptions& wanted = s.options.meshing;
  if (mesh.left_out > 0)
    out.push_back(fmt::format(
        "radiosity: {} surface{} beyond {:g} m from the origin left out: they reflect nothing",
        mesh.left_out, mesh.left_out == 1 ? " is" : "s are", double(farthest_surface)));
  if (mesh.coarsened > 1.01f || mesh.join_angle_deg > 1.01f * wanted.join_angle_deg)
    out.push_back(fmt::format(
        "radiosity: with at most {} elements and {} sheets, elements are {:.2g} times as long as "
        "requested, and small triangles whose directions differ by up to {:.0f} degrees are joined",
        wanted.max_elements, wanted.max_sheets, double(mesh.coarsened),
        double(mesh.join_angle_deg)));
}

}  // namespace

std::vector<std::string> radiosity_warnings(const RadiositySolution& s) {
  constexpr double allowed = 0.01;  // share of the emitted power
  const EnergyBalance& b = s.balance;
  std::vector<std::string> out;
  const auto percent = [&](double part) { return 100 * part / b.emitted; };
  if (b.emitted > 0 && !(std::abs(b.unaccounted) <= allowed * b.emitted))
    out.push_back(fmt::format(
        "radiosity: {:.1f} % of the emitted power reached no sample point and did not leave the "
        "scene (absorbed {:.1f} %, specular {:.1f} %, escaped {:.1f} %, not shot {:.1f} %): "
        "elements of {:.3g} m are too coarse for this scene; --element-size makes them smaller",
        percent(b.unaccounted), percent(b.absorbed), percent(b.lost_to_specular),
        percent(b.escaped), percent(b.unshot), s.mesh.element_size));
  add_mesh_warnings(s, out);
  if (s.end == RadiosityEnd::out_of_shots || s.end == RadiosityEnd::out_of_rays)
    out.push_back(
        fmt::format("radiosity: ended after {} shots and {:.0f} million rays with {:.1f} % of the "
                    "emitted power unshot; this share is distributed evenly as an estimate",
                    s.shots, double(s.rays) * 1e-6, b.emitted > 0 ? percent(b.unshot) : 0.0));
  return out;
}

Rgb interpolated_irradiance(const RadiositySolution& solution, const Interpolation& at) {
  Rgb sum;
  for (const PointWeight& w : at.weights()) sum += solution.irradiance(w.point) * w.weight;
  return sum;
}

}  // namespace troffer
