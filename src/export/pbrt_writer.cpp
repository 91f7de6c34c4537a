#include "export/pbrt_writer.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "base/frame.h"
#include "base/units.h"
#include "export/pbrt_lights.h"
#include "export/pbrt_materials.h"
#include "export/ply_writer.h"
#include "export/scene_parts.h"

namespace troffer {

namespace {

std::string numbers(const Vec3d& v) {
  return fmt::format("{} {} {}", v.x, v.y, v.z);
}

class PbrtWriter {
 public:
  PbrtWriter(const Scene& scene, OutputFolder& files)
      : scene_(scene),
        files_(files),
        materials_(scene, files_, warnings_),
        unit_(scene.is_photometric ? 1 / luminous_efficacy : 1) {}
  std::vector<Warning> write();

 private:
  const Scene& scene_;
  WarningLog warnings_;
  OutputFolder& files_;
  PbrtMaterialWriter materials_;
  double unit_;  // radiance in W/(m² sr) per unit of the scene
  std::string text_;
  size_t meshes_ = 0;

  void add_camera();
  void add_part(const ScenePart& part, Rgb radiance);
  void add_instances();
  void add_emission(const Light& light, Rgb radiance);
  std::vector<std::pair<Mesh, bool>> sides_of(const Mesh& mesh, const PbrtUvs& uvs);
  std::string shape_of(const Mesh& mesh, const PbrtUvs& uvs, const Vec3d& origin);
  void add_round();
};

// Writes camera_from_world, column by column.
void PbrtWriter::add_camera() {
  if (scene_.cameras.empty()) return;
  if (scene_.cameras[0].kind == CameraKind::fisheye)
    warnings_.add("fisheye cameras are written as perspectives");
  const Camera c = without_fisheye(scene_.cameras[0]);
  if (scene_.cameras.size() > 1) warnings_.add("pbrt has one camera: the first one is written");
  const int height = c.height > 0 ? c.height : 768;
  const double aspect = c.aspect > 0 ? double(c.aspect) : 4.0 / 3;
  const int width = c.width > 0 ? c.width : std::max(1, int(std::lround(height * aspect)));
  const Vec3d at = Vec3d(c.position) + scene_.origin;
  const Vec3d r(c.right), u(c.up), f(c.forward);
  text_ += fmt::format("Transform [ {} {} {} 0 {} {} {} 0 {} {} {} 0 {} {} {} 1 ]\n", r.x, u.x, f.x,
                       r.y, u.y, f.y, r.z, u.z, f.z, -dot(r, at), -dot(u, at), -dot(f, at));
  text_ += fmt::format(
      "Film \"rgb\" \"integer xresolution\" {} \"integer yresolution\" {} \"string filename\" "
      "\"picture.exr\"\n",
      width, height);
  const bool is_perspective = c.kind == CameraKind::perspective;
  const double shown = double(width) / height;
  // The format's angle is that of the shorter axis.
  double half = double(c.half_extent);
  if (c.fov_is_vertical && shown < 1 && !c.has_screen_window) half *= shown;
  text_ += fmt::format("Camera \"{}\"", is_perspective ? "perspective" : "orthographic");
  if (is_perspective) text_ += fmt::format(" \"float fov\" {}", 2 * deg_from_rad(std::atan(half)));
  if (c.has_screen_window || !is_perspective) {
    const double wide = std::max(shown, 1.0), high = std::max(1 / shown, 1.0);
    const double scale = is_perspective ? 1 : half;
    const auto& w = c.screen_window;
    text_ += c.has_screen_window
                 ? fmt::format(" \"float screenwindow\" [ {} {} {} {} ]", scale * double(w[0]),
                               scale * double(w[1]), scale * double(w[2]), scale * double(w[3]))
                 : fmt::format(" \"float screenwindow\" [ {} {} {} {} ]", -scale * wide,
                               scale * wide, -scale * high, scale * high);
  }
  if (c.lens_radius > 0)
    text_ += fmt::format(" \"float lensradius\" {} \"float focaldistance\" {}", c.lens_radius,
                         c.focal_distance);
  text_ += "\n";
}

void PbrtWriter::add_emission(const Light& e, Rgb radiance) {
  text_ += fmt::format("  # {}\n  AreaLightSource \"diffuse\"", printable_comment(e.name));
  if (e.texture >= 0) {
    const auto [file, scale] = materials_.emission_image({radiance, e.texture});
    text_ +=
        fmt::format(" \"string filename\" \"{}\" \"float scale\" {}", file, double(scale) * unit_);
  } else {
    text_ += fmt::format(" \"rgb L\" [ {} {} {} ]", double(radiance.r) * unit_,
                         double(radiance.g) * unit_, double(radiance.b) * unit_);
  }
  text_ += e.is_two_sided ? " \"bool twosided\" true\n" : "\n";
}

// Separates triangles whose (u,v) run clockwise: pbrt's normal maps do not support mirrored
// coordinates.
std::vector<std::pair<Mesh, bool>> PbrtWriter::sides_of(const Mesh& mesh, const PbrtUvs& uvs) {
  std::array<std::vector<Triangle>, 2> triangles;
  if (uvs.has_normals())
    for (const Triangle& t : mesh.triangles) triangles[uvs.is_turned(mesh, t)].push_back(t);
  std::vector<std::pair<Mesh, bool>> out;
  if (triangles[0].empty() || triangles[1].empty())
    out.emplace_back(mesh, !triangles[1].empty());
  else
    for (const bool is_turned : {false, true})
      out.emplace_back(extracted(mesh, triangles[is_turned]), is_turned);
  return out;
}

std::string PbrtWriter::shape_of(const Mesh& mesh, const PbrtUvs& uvs, const Vec3d& origin) {
  const std::string file =
      files_.write(fmt::format("mesh{}.ply", meshes_++), ply_of(mesh, uvs.of(mesh), origin));
  return fmt::format("  Shape \"plymesh\" \"string filename\" \"{}\"{}\n", file,
                     materials_.alpha());
}

void PbrtWriter::add_part(const ScenePart& part, Rgb radiance) {
  const Light* light = part.light >= 0 ? &scene_.lights[size_t(part.light)] : nullptr;
  const PbrtUvs& uvs = materials_.begin(part.mesh.material, light);
  if (materials_.is_nothing()) return;
  for (const auto& [mesh, is_turned] : sides_of(part.mesh, uvs)) {
    text_ += "AttributeBegin\n  " + materials_.use(is_turned) + "\n";
    if (light) add_emission(*light, radiance);
    text_ += shape_of(mesh, uvs, scene_.origin) + "AttributeEnd\n";
  }
}

// Writes objects and their instances.
void PbrtWriter::add_instances() {
  for (size_t i = 0; i < scene_.instanced_meshes.size(); ++i) {
    const Mesh& whole = scene_.instanced_meshes[i];
    const PbrtUvs& uvs = materials_.begin(whole.material, nullptr);
    if (materials_.is_nothing()) continue;
    std::string shapes;
    for (const auto& [mesh, is_turned] : sides_of(whole, uvs))
      shapes += "  " + materials_.use(is_turned) + "\n" + shape_of(mesh, uvs, {});
    text_ += fmt::format("ObjectBegin \"object{}\"\n{}ObjectEnd\n", i, shapes);
  }
  for (const Instance& i : scene_.instances) {
    materials_.begin(scene_.instanced_meshes[i.mesh].material, nullptr);
    if (materials_.is_nothing()) continue;
    const Affine& m = i.world_from_mesh;
    text_ += fmt::format(
        "AttributeBegin\n  ConcatTransform [ {} 0 {} 0 {} 0 {} 1 ]\n  ObjectInstance \"object{}\"\n"
        "AttributeEnd\n",
        numbers(m.columns[0]), numbers(m.columns[1]), numbers(m.columns[2]),
        numbers(m.translation + scene_.origin), i.mesh);
  }
}

void PbrtWriter::add_round() {
  const auto begins = [&](uint32_t material, int32_t light) {
    const Light* e = light >= 0 ? &scene_.lights[size_t(light)] : nullptr;
    materials_.begin(material, e);
    if (materials_.is_nothing()) return false;
    text_ += "AttributeBegin\n  " + materials_.use(false) + "\n";
    if (e) add_emission(*e, e->radiance);
    return true;
  };
  for (const Sphere& s : scene_.spheres) {
    if (!begins(s.material, s.light)) continue;
    text_ +=
        fmt::format("  Translate {}\n{}  Shape \"sphere\" \"float radius\" {}{}\nAttributeEnd\n",
                    numbers(Vec3d(s.centre) + scene_.origin),
                    s.is_inside_out ? "  ReverseOrientation\n" : "", s.radius, materials_.alpha());
  }
  for (const Disk& d : scene_.disks) {
    if (!begins(d.material, d.light)) continue;
    const Framed f{Vec3d(d.normal)};
    const Vec3d at = Vec3d(d.centre) + scene_.origin;
    text_ += fmt::format(
        "  ConcatTransform [ {} 0 {} 0 {} 0 {} 1 ]\n  Shape \"disk\" \"float radius\" "
        "{}{}\nAttributeEnd\n",
        numbers(f.tangent), numbers(f.bitangent), numbers(f.normal), numbers(at), d.radius,
        materials_.alpha());
  }
}

std::vector<Warning> PbrtWriter::write() {
  text_ = "# written by troffer\n";
  add_camera();
  text_ += "WorldBegin\n";
  text_ += pbrt_lights(scene_, unit_, files_, warnings_);
  const SceneParts parts = parts_of(scene_, false);
  for (const ScenePart& part : parts.parts)
    add_part(part, part.light >= 0 ? parts.radiances[size_t(part.light)] : Rgb{});
  add_instances();
  add_round();
  files_.finish(text_);
  return warnings_.entries();
}

}  // namespace

std::vector<Warning> write_pbrt(const Scene& scene, OutputFolder& files) {
  return PbrtWriter(scene, files).write();
}

}  // namespace troffer
