// Computes the key of a scene (solution.h).
#include "base/hasher.h"
#include "radiosity/solution.h"

namespace troffer {

namespace {

template <class T>
void add_value(Hasher& h, const T& v) {
  h.add(v);
}
void add_value(Hasher& h, const ColorInput& c) {
  h.add_all(c.value, c.texture);
}
void add_value(Hasher& h, const FloatInput& c) {
  h.add_all(c.value, c.texture, c.channel);
}

void add_meshes(Hasher& h, const std::vector<Mesh>& meshes) {
  h.add(meshes.size());
  for (const Mesh& m : meshes) {
    h.add(m.positions.size());
    for (const Vec3& p : m.positions) h.add(p);
    h.add(m.uvs.size());
    for (const Vec2& p : m.uvs) h.add(p);
    for (const Vec2& p : m.uvs_2) h.add(p);
    h.add(m.triangles.size());
    for (const Triangle& t : m.triangles)
      for (const uint32_t v : t) h.add(uint64_t(v));
    h.add(m.lights.size());
    for (const int32_t e : m.lights) h.add(uint64_t(e));
    h.add(uint64_t(m.material));
  }
}

void add_instances(Hasher& h, const Scene& scene) {
  if (scene.instances.empty()) return;
  add_meshes(h, scene.instanced_meshes);
  h.add(scene.instances.size());
  for (const Instance& i : scene.instances) {
    h.add(uint64_t(i.mesh));
    for (const Vec3d& v : i.world_from_mesh.columns) h.add(Vec3(v));
    h.add(Vec3(i.world_from_mesh.translation));
  }
}

void add_geometry(Hasher& h, const Scene& scene) {
  add_meshes(h, scene.meshes);
  h.add(scene.spheres.size());
  for (const Sphere& s : scene.spheres) {
    h.add(s.centre);
    h.add(s.radius);
    h.add(uint64_t(s.is_inside_out));
    h.add(uint64_t(s.material));
    h.add(uint64_t(s.light));
  }
  h.add(scene.disks.size());
  for (const Disk& d : scene.disks) {
    h.add(d.centre);
    h.add(d.normal);
    h.add(d.radius);
    h.add(uint64_t(d.material));
    h.add(uint64_t(d.light));
  }
  add_instances(h, scene);
}

void add_texture(Hasher& h, const Texture& t) {
  h.add(uint64_t(t.kind));
  h.add(t.value);
  h.add(uint64_t(t.factor_a) << 32 | t.factor_b);
  h.add(uint64_t(t.width) << 32 | uint64_t(t.height));
  h.add(uint64_t(t.channels));
  h.add(t.texels8.size());
  for (const uint8_t v : t.texels8) h.add(uint64_t(v));
  h.add(t.texels_float.size());
  for (const float v : t.texels_float) h.add(v);
  h.add(uint64_t(t.is_srgb) | uint64_t(t.is_inverted) << 1 | uint64_t(t.is_filtered) << 2 |
        uint64_t(t.wrap_u) << 8 | uint64_t(t.wrap_v) << 16);
  h.add(t.uv_scale);
  h.add(t.uv_offset);
  h.add(t.uv_rotation_rad);
  h.add(uint64_t(t.mapping) | uint64_t(t.octaves) << 8);
  for (const Vec3d& v : t.from_scene.columns) h.add(Vec3(v));
  h.add(Vec3(t.from_scene.translation));
  for (const TextureOperand* o : {&t.first, &t.second, &t.amount}) {
    h.add(o->value);
    h.add(uint64_t(o->texture));
  }
  for (const float v : {t.persistence, t.scale, t.variation}) h.add(v);
}

void add_web(Hasher& h, const LightWeb& web) {
  for (const auto* values :
       {&web.vertical_angles_rad, &web.horizontal_angles_rad, &web.intensities}) {
    h.add(values->size());
    for (const float v : *values) h.add(v);
  }
  h.add(uint64_t(web.pole));
  h.add(web.faces.size());
  for (const Vec3& face : web.faces) h.add(face);
  h.add(web.cross_section);
}

}  // namespace

uint64_t radiosity_scene_key(const Scene& scene) {
  Hasher h(2);
  add_geometry(h, scene);
  h.add(scene.materials.size());
  for (const Material& m : scene.materials)
    for_each_value(m, [&](const auto& v) { add_value(h, v); });
  h.add(scene.textures.size());
  for (const Texture& t : scene.textures) add_texture(h, t);
  h.add(scene.lights.size());
  for (const Light& e : scene.lights) {
    for_each_value(e, [&](const auto& v) { add_value(h, v); });
    if (e.web == no_web) continue;
    for (const Vec3& axis : e.axes) h.add(axis);
    add_web(h, scene.webs[size_t(e.web)]);
  }
  for (const LightRelay& r : scene.relays) {
    for (const Vec3& p : r.outline) h.add(p);
    h.add(r.normal);
    h.add(r.reflectance);
  }
  return h.value();
}

}  // namespace troffer
