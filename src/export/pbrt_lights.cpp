#include "export/pbrt_lights.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "base/units.h"
#include "export/baked_image.h"
#include "image/encode.h"
#include "light/sky_light.h"

namespace troffer {

namespace {

constexpr int sky_width = 1024, sky_height = 512;

class Writer {
 public:
  Writer(const Scene& scene, double unit, OutputFolder& files, WarningLog& warnings)
      : scene_(scene), unit_(unit), files_(files), warnings_(warnings) {}
  std::string text(const Light& e);

 private:
  const Scene& scene_;
  double unit_;
  OutputFolder& files_;
  WarningLog& warnings_;
  size_t images_ = 0;

  std::string rgb(const char* name, const Light& e, double factor = 1) const {
    return fmt::format(" \"rgb {}\" [ {} {} {} ]", name, double(e.radiance.r) * unit_ * factor,
                       double(e.radiance.g) * unit_ * factor,
                       double(e.radiance.b) * unit_ * factor);
  }
  std::string point(const char* name, const Vec3d& p) const {
    return fmt::format(" \"point3 {}\" [ {} {} {} ]", name, p.x, p.y, p.z);
  }
  std::string spot(const Light& e);
  std::string image(const Light& e, const Image& picture);
  std::string environment(const Light& e);
  std::string point_light(const Light& e);
  std::string goniometric(const Light& e);
  std::string projection(const Light& e);
  std::string placed(const std::array<Vec3, 3>& axes, const Light& e, const std::string& light);
  std::string sky(const Light& e);
};

std::string Writer::spot(const Light& e) {
  const double outer = deg_from_rad(std::acos(double(e.cos_outer)));
  const double inner = deg_from_rad(std::acos(std::min(1.0, double(e.cos_inner))));
  if (e.falloff == SpotFalloff::square)
    warnings_.add("pbrt spots fade smoothly between their angles, not quadratically");
  if (e.falloff == SpotFalloff::linear)
    warnings_.add("pbrt spots fade smoothly between their angles, not linearly");
  const Vec3d from = Vec3d(e.position) + scene_.origin;
  return "\"spot\"" + rgb("I", e) + point("from", from) + point("to", from + Vec3d(e.direction)) +
         fmt::format(" \"float coneangle\" {} \"float conedeltaangle\" {}", outer, outer - inner);
}

std::string Writer::image(const Light& e, const Image& picture) {
  const std::string file =
      files_.write(fmt::format("surroundings{}.pfm", images_++), encode_pfm(picture));
  const Rgb c = e.radiance;
  if (c.r != c.g || c.g != c.b) warnings_.add("tints of environment images are averaged");
  return fmt::format("\"infinite\" \"string filename\" \"{}\" \"float scale\" {}", file,
                     double(average(c)) * unit_);
}

std::string Writer::environment(const Light& e) {
  if (e.environment < 0) return "\"infinite\"" + rgb("L", e);
  const EnvironmentMap& map = scene_.environments[size_t(e.environment)];
  Image picture(map.width, map.height);
  picture.pixels = map.texels;
  if (map.projection == SphereMap::lat_long)
    warnings_.add(
        "an environment image is written in latitude-longitude layout: troffer reads it, pbrt-v4 "
        "needs a square equal-area image");
  return image(e, picture);
}

// Returns the light in a coordinate system at the light with these axes.
std::string Writer::placed(const std::array<Vec3, 3>& a, const Light& e, const std::string& light) {
  const Vec3d at = Vec3d(e.position) + scene_.origin;
  return fmt::format(
      "# {}\nAttributeBegin\n  Transform [ {} {} {} 0 {} {} {} 0 {} {} {} 0 {} {} {} 1 ]\n  "
      "LightSource {}\nAttributeEnd\n",
      printable_comment(e.name), a[0].x, a[0].y, a[0].z, a[1].x, a[1].y, a[1].z, a[2].x, a[2].y,
      a[2].z, at.x, at.y, at.z, light);
}

// pbrt's image uses the light's y as its z.
std::string Writer::goniometric(const Light& e) {
  const EnvironmentMap& map = scene_.environments[size_t(e.environment)];
  Image picture(map.width, map.height);
  picture.pixels = map.texels;
  const std::string file =
      files_.write(fmt::format("intensity{}.pfm", images_++), encode_pfm(picture));
  return placed({e.axes[0], e.axes[2], e.axes[1]}, e,
                "\"goniometric\"" + rgb("I", e) + fmt::format(" \"string filename\" \"{}\"", file));
}

// `fov` is that of the shorter side. The picture's top points along the light's y.
std::string Writer::projection(const Light& e) {
  const Texture& t = scene_.textures[size_t(e.texture)];
  if (e.has_uniform_plane)
    warnings_.add("pbrt's projected pictures are darker towards their edges than Mitsuba's");
  const std::string file =
      files_.write(fmt::format("slide{}.png", images_++),
                   png_of(baked_color(scene_, {Rgb{1}, e.texture}, look_of(t), nullptr)));
  const double aspect = double(t.width) / t.height;
  const double half_x = 1 / (double(length(e.axes[0])) * std::max(aspect, 1.0)),
               half_y = 1 / (double(length(e.axes[1])) * std::max(1 / aspect, 1.0));
  if (std::abs(half_x - half_y) > 0.01 * half_x)
    warnings_.add("a projected picture keeps its own proportions in pbrt: only its width is kept");
  return placed({normalize(e.axes[0]), -normalize(e.axes[1]), normalize(e.axes[2])}, e,
                "\"projection\"" + rgb("I", e) +
                    fmt::format(" \"float fov\" {} \"string filename\" \"{}\"",
                                deg_from_rad(2 * std::atan(half_x)), file));
}

// Returns a complete directive for a light with an image, else the text after LightSource.
std::string Writer::point_light(const Light& e) {
  if (e.environment >= 0 &&
      scene_.environments[size_t(e.environment)].projection == SphereMap::equal_area)
    return goniometric(e);
  if (e.texture >= 0 && scene_.textures[size_t(e.texture)].kind == TextureKind::image)
    return projection(e);
  if (e.environment >= 0 || e.texture >= 0)
    warnings_.add("the image that shapes a light is left out");
  return "\"point\"" + rgb("I", e) + point("from", Vec3d(e.position) + scene_.origin);
}

// Writes a sky as an image, white.
std::string Writer::sky(const Light& e) {
  warnings_.add("skies are written as images of 1024 x 512");
  Image picture(sky_width, sky_height);
  for (int y = 0; y < sky_height; ++y) {
    for (int x = 0; x < sky_width; ++x) {
      const Vec3 w = lat_long_direction(
          {(float(x) + 0.5f) / float(sky_width), (float(y) + 0.5f) / float(sky_height)});
      const Vec3 wi = e.axes[0] * w.x + e.axes[1] * w.y + e.axes[2] * w.z;
      picture.pixels[size_t(y) * size_t(sky_width) + size_t(x)] =
          SkyLight::radiance_at_infinity(scene_, e, wi);
    }
  }
  Light even = e;
  even.radiance = Rgb{1};
  return image(even, picture);
}

std::string Writer::text(const Light& e) {
  std::string out;
  if (e.kind == LightKind::spot && e.texture >= 0)
    warnings_.add("pictures that spots project are left out: they shine uniformly");
  switch (e.kind) {
    case LightKind::point:
      out = point_light(e);
      if (out.starts_with("#")) return out;
      break;
    case LightKind::spot:
      out = spot(e);
      break;
    case LightKind::distant:
      out = "\"distant\"" + rgb("L", e) + point("from", {}) + point("to", Vec3d(e.direction));
      break;
    case LightKind::sun: {
      warnings_.add("the sun's disc is written as a distant light of the same illuminance");
      const double solid_angle = pi * sqr(std::sin(double(e.angular_radius)));
      out = "\"distant\"" + rgb("L", e, solid_angle) + point("from", {}) +
            point("to", Vec3d(e.direction));
      break;
    }
    case LightKind::environment:
      out = environment(e);
      break;
    case LightKind::sky:
      out = sky(e);
      break;
    case LightKind::polygon:
    case LightKind::disk:
    case LightKind::sphere:
    case LightKind::mesh:
      return "";  // written with its surface
  }
  for (size_t i = 0; i < e.portal.size(); ++i) {
    const Vec3d p = Vec3d(e.portal[i]) + scene_.origin;
    out += fmt::format("{} {} {} {}{}", i == 0 ? " \"point3 portal\" [" : "", p.x, p.y, p.z,
                       i + 1 == e.portal.size() ? " ]" : "");
  }
  if (e.range > 0) warnings_.add("the range of lights is left out: pbrt has none");
  if (e.focal_distance > 0)
    warnings_.add("the focal distance of spotlights is left out: pbrt has none");
  // Axes of the image, if there is one.
  const bool has_axes =
      (e.kind == LightKind::environment && e.environment >= 0) || e.kind == LightKind::sky;
  if (!has_axes) return fmt::format("# {}\nLightSource {}\n", printable_comment(e.name), out);
  const auto& a = e.axes;
  return fmt::format(
      "# {}\nAttributeBegin\n  Transform [ {} {} {} 0 {} {} {} 0 {} {} {} 0 0 0 0 1 ]\n  "
      "LightSource {}\nAttributeEnd\n",
      printable_comment(e.name), a[0].x, a[0].y, a[0].z, a[1].x, a[1].y, a[1].z, a[2].x, a[2].y,
      a[2].z, out);
}

}  // namespace

std::string pbrt_lights(const Scene& scene, double unit, OutputFolder& files,
                        WarningLog& warnings) {
  Writer writer(scene, unit, files, warnings);
  std::string text;
  for (const Light& e : scene.lights) text += writer.text(e);
  return text;
}

}  // namespace troffer
