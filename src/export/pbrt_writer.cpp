#include "export/pbrt_writer.h"

#include <fmt/format.h>

#include <cmath>

#include "base/frame.h"
#include "base/units.h"
#include "export/output_folder.h"
#include "export/pbrt_lights.h"
#include "export/pbrt_materials.h"
#include "export/ply_writer.h"
#include "export/scene_parts.h"
#include "image/atomic_file.h"

namespace troffer {

namespace {

std::string numbers(const Vec3d& v) {
  return fmt::format("{} {} {}", v.x, v.y, v.z);
}

class PbrtWriter {
 public:
  PbrtWriter(const Scene& scene, const std::string& path)
      : scene_(scene),
        files_(path),
        materials_(scene, files_, warnings_),
        unit_(scene.is_photometric ? 1 / luminous_efficacy : 1) {}
  std::vector<Warning> write(const std::string& path);

 private:
  const Scene& scene_;
  WarningLog warnings_;
  OutputFolder files_;
  PbrtMaterialWriter materials_;
  double unit_;  // radiance in W/(m² sr) per the scene's unit
  std::string text_;
  size_t meshes_ = 0;

  void add_camera();
  void add_part(const ScenePart& part, Rgb radiance);
  void add_instances();
  void add_emission(int32_t light, Rgb radiance);
  void add_round();
};

// camera_from_world, column after column.
void PbrtWriter::add_camera() {
  if (scene_.cameras.empty()) return;
  const Camera& c = scene_.cameras[0];
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

void PbrtWriter::add_emission(int32_t light, Rgb radiance) {
  const Light& e = scene_.lights[size_t(light)];
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

void PbrtWriter::add_part(const ScenePart& part, Rgb radiance) {
  const std::string name = fmt::format("mesh{}.ply", meshes_++);
  files_.write(name, ply_of(part.mesh, scene_.origin));
  const std::string use = materials_.use(part.mesh.material);
  text_ += "AttributeBegin\n  " + use + "\n";
  if (part.light >= 0) add_emission(part.light, radiance);
  text_ += fmt::format("  Shape \"plymesh\" \"string filename\" \"{}\"{}\nAttributeEnd\n",
                       files_.relative(name), materials_.alpha_of(part.mesh.material));
}

// Objects, and where they stand.
void PbrtWriter::add_instances() {
  for (size_t i = 0; i < scene_.instanced_meshes.size(); ++i) {
    const Mesh& mesh = scene_.instanced_meshes[i];
    const std::string name = fmt::format("mesh{}.ply", meshes_++);
    files_.write(name, ply_of(mesh, {}));
    const std::string use = materials_.use(mesh.material);
    text_ += fmt::format(
        "ObjectBegin \"object{}\"\n  {}\n  Shape \"plymesh\" \"string filename\" \"{}\"{}\n"
        "ObjectEnd\n",
        i, use, files_.relative(name), materials_.alpha_of(mesh.material));
  }
  for (const Instance& i : scene_.instances) {
    const Affine& m = i.world_from_mesh;
    text_ += fmt::format(
        "AttributeBegin\n  ConcatTransform [ {} 0 {} 0 {} 0 {} 1 ]\n  ObjectInstance \"object{}\"\n"
        "AttributeEnd\n",
        numbers(m.columns[0]), numbers(m.columns[1]), numbers(m.columns[2]),
        numbers(m.translation + scene_.origin), i.mesh);
  }
}

void PbrtWriter::add_round() {
  const auto begin = [&](uint32_t material, int32_t light) {
    text_ += "AttributeBegin\n  " + materials_.use(material) + "\n";
    if (light >= 0) add_emission(light, scene_.lights[size_t(light)].radiance);
  };
  for (const Sphere& s : scene_.spheres) {
    begin(s.material, s.light);
    text_ += fmt::format("  Translate {}\n{}  Shape \"sphere\" \"float radius\" {}\nAttributeEnd\n",
                         numbers(Vec3d(s.centre) + scene_.origin),
                         s.is_inside_out ? "  ReverseOrientation\n" : "", s.radius);
  }
  for (const Disk& d : scene_.disks) {
    begin(d.material, d.light);
    const Framed f{Vec3d(d.normal)};
    const Vec3d at = Vec3d(d.centre) + scene_.origin;
    text_ += fmt::format(
        "  ConcatTransform [ {} 0 {} 0 {} 0 {} 1 ]\n  Shape \"disk\" \"float radius\" "
        "{}\nAttributeEnd\n",
        numbers(f.tangent), numbers(f.bitangent), numbers(f.normal), numbers(at), d.radius);
  }
}

std::vector<Warning> PbrtWriter::write(const std::string& path) {
  text_ = "# written by troffer\n";
  add_camera();
  text_ += "WorldBegin\n";
  text_ += pbrt_lights(scene_, unit_, files_, warnings_);
  const SceneParts parts = parts_of(scene_, false);
  for (const ScenePart& part : parts.parts)
    add_part(part, part.light >= 0 ? parts.radiances[size_t(part.light)] : Rgb{});
  add_instances();
  add_round();
  write_file(path, text_);
  return warnings_.entries();
}

}  // namespace

std::vector<Warning> write_pbrt(const Scene& scene, const std::string& path) {
  return PbrtWriter(scene, path).write(path);
}

}  // namespace troffer
