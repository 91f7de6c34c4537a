#include "render/picture_key.h"

#include "base/hasher.h"
#include "base/own_file.h"
#include "radiosity/solution.h"

namespace troffer {

namespace {

// Adds to the radiosity key what only pictures depend on.
uint64_t hash_of_scene(const Scene& scene) {
  Hasher h(1);
  h.add(radiosity_scene_key(scene));
  h.add_all(scene.origin.x, scene.origin.y, scene.origin.z, scene.is_photometric);
  for (const Mesh& m : scene.meshes) {
    h.add(m.normals.size());
    for (const Vec3& n : m.normals) h.add(n);
  }
  for (const EnvironmentMap& e : scene.environments) {
    h.add_all(int(e.projection), e.width, e.height);
    for (const Rgb& c : e.texels) h.add(c);
  }
  return h.value();
}

void add_camera(Hasher& h, const Camera& c) {
  h.add_all(int(c.kind), c.position, c.right, c.up, c.forward, c.half_extent, c.fov_is_vertical,
            c.has_screen_window, c.lens_radius, c.focal_distance, c.near_clip, c.far_clip, c.width,
            c.height, c.aspect);
  for (const float v : c.screen_window) h.add(v);
}

void add_trees(Hasher& h, const TreeSamplingOptions& s) {
  const BintreeOptions& t = s.tree;
  h.add_all(t.initial_rays, t.allowed_variance, t.level_difference, t.mean_change,
            t.mean_change_iterations, t.enough_rays, t.most_rays, t.renews_jitter, s.probe_rays,
            s.has_coherence, s.uses_ratio);
}

void add_selection(Hasher& h, const SelectionOptions& s) {
  const SelectionThresholds& t = s.thresholds;
  h.add_all(s.is_enabled, t.occluded_below, t.visible_above, t.major_share, t.shadow_edge,
            t.probe_share, t.least_share, s.uses_patches, s.is_restricted, s.only.size());
  for (const uint32_t light : s.only) h.add(light);
}

void add_radiosity(Hasher& h, const RadiosityOptions& r) {
  const MeshingOptions& m = r.meshing;
  h.add_all(m.element_size, m.patch_size, m.join_angle_deg, m.max_elements, m.max_sheets,
            m.prune_hidden_sides, r.stored_per_point, r.unshot_fraction, r.max_shots,
            r.max_million_rays, r.max_rays, r.tolerance, r.light_rays, r.light_share, r.seed);
}

uint64_t hash_of_settings(const Camera& camera, const RenderOptions& o) {
  Hasher h(1);
  const MostViewingRays most = most_viewing_rays(o);
  add_camera(h, camera);
  h.add(std::string(o.method.row().name));
  h.add_all(needs_radiosity(o.method, o.indirect), needs_cells(o.method, o.indirect),
            o.indirect == Indirect::none, o.spp, most.in_pixel, most.in_mean, most.usual,
            o.shadow_rays, o.error, o.depth, o.width, o.height, o.has_crop, o.seed, o.aovs.size());
  for (const int edge : o.crop) h.add(edge);
  for (const Aov a : o.aovs) h.add(int(a));
  add_trees(h, o.kj92.sampling);
  add_selection(h, o.kj92.selection);
  add_radiosity(h, o.kj92.radiosity);
  return h.value();
}

}  // namespace

PictureKey picture_key(const std::string& program, const Scene& scene, const Camera& camera,
                       const RenderOptions& options, const std::vector<uint8_t>& preparation) {
  constexpr size_t longest_version = 15;
  return {program.substr(0, longest_version), hash_of_settings(camera, options),
          hash_of_scene(scene), preparation.empty() ? 0 : hash_of_parts({}, preparation)};
}

}  // namespace troffer
