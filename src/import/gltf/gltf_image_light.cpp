#include "import/gltf/gltf_image_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/sphere_map.h"
#include "image/raster.h"
#include "import/file.h"
#include "import/gltf/gltf_uri.h"
#include "import/uri.h"

namespace troffer {

namespace {

constexpr const char* image_light_extension = "EXT_lights_image_based";
constexpr uint64_t max_image_bytes = uint64_t(1) << 30;
constexpr size_t max_face_pixels = size_t(4096) * 4096;
constexpr int fewest_texels_across = 64, most_texels_across = 2048;

struct Face {
  int size = 0;
  std::vector<Rgb> texels;  // row 0 on top, as seen from inside
};

std::vector<uint8_t> bytes_of(const JsonNode& image, const GltfBuffers& buffers) {
  if (const auto view = image.find("bufferView")) {
    const auto bytes = buffers.buffer_view(*view);
    return {bytes.begin(), bytes.end()};
  }
  const auto uri = image.find("uri");
  if (!uri) image.fail("has neither a uri nor a buffer view");
  if (!is_data_uri(uri->as_string()))
    return read_file(path_of_uri(*uri, folder_of(image.file())), max_image_bytes);
  auto data = parse_data_uri(uri->as_string());
  if (!data) uri->fail("is a malformed data URI");
  return std::move(data->bytes);
}

// Decodes a face to linear light; with an alpha channel, light is colour / alpha (RGBD) [1].
Face read_face(const JsonNode& image, const GltfBuffers& buffers) {
  const std::string name = image.file() + "#" + image.pointer();
  const Raster r = linear_raster(decode_raster(bytes_of(image, buffers), name, max_face_pixels));
  if (r.width != r.height) throw InputError(name, 0, 0, "a cube's face is not square");
  Face face;
  face.size = r.width;
  const auto channels = size_t(r.channels);
  for (size_t i = 0; i < r.texels_float.size(); i += channels) {
    const float* t = &r.texels_float[i];
    const float alpha = channels % 2 == 0 ? std::max(t[channels - 1], 1.0f / 255) : 1;
    const Rgb c = (channels < 3 ? Rgb{t[0]} : Rgb{t[0], t[1], t[2]}) / alpha;
    const bool is_light = is_finite(c) && std::min({c.r, c.g, c.b}) >= 0;
    face.texels.push_back(is_light ? c : Rgb{0});
  }
  return face;
}

// Returns the texel of the cube in direction d. Faces are those of common cube maps, mirrored as
// seen from inside [1].
Rgb texel_towards(const std::array<Face, 6>& cube, const Vec3& d) {
  const Vec3 a = abs(d);
  const size_t axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
  const bool is_negative = d[axis] < 0;
  const float side = is_negative ? -1.0f : 1.0f;
  const Vec2 at = axis == 0   ? Vec2{side * d.z, -d.y}
                  : axis == 1 ? Vec2{-d.x, side * d.z}
                              : Vec2{-side * d.x, -d.y};
  const Face& face = cube[2 * axis + (is_negative ? 1 : 0)];
  const auto index = [&](float x) {
    return std::clamp(int((x / a[axis] + 1) * 0.5f * float(face.size)), 0, face.size - 1);
  };
  return face.texels[size_t(index(at.y)) * size_t(face.size) + size_t(index(at.x))];
}

EnvironmentMap map_of(const std::array<Face, 6>& cube) {
  EnvironmentMap map;
  map.projection = SphereMap::equal_area;
  map.width = map.height = std::clamp(4 * cube[0].size, fewest_texels_across, most_texels_across);
  constexpr int each = 4;
  const float n = float(map.width) * each;
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      Rgb sum;
      for (int k = 0; k < each * each; ++k) {
        const Vec2 uv{(float(x * each + k % each) + 0.5f) / n,
                      (float(y * each + k / each) + 0.5f) / n};
        sum += texel_towards(cube, direction_from_square(map.projection, uv));
      }
      map.texels.push_back(sum / float(each * each));
    }
  return map;
}

std::array<Vec3, 3> axes_of(const JsonNode& light) {
  const std::vector<double> q = light.numbers_or("rotation", {0, 0, 0, 1});
  const double size = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(size > 0) || !std::isfinite(size)) light.fail("its rotation is not a rotation");
  const double x = q[0] / size, y = q[1] / size, z = q[2] / size, w = q[3] / size;
  return {Vec3(Vec3d{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)}),
          Vec3(Vec3d{2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)}),
          Vec3(Vec3d{2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)})};
}

// Returns the light of the shown scene: the document's default scene, or the first.
std::optional<JsonNode> light_of_scene(const JsonNode& root) {
  const auto scenes = root.find("scenes");
  if (!scenes || scenes->size() == 0) return std::nullopt;
  const auto chosen = root.find("scene");
  const uint32_t i = chosen ? chosen->as_index(scenes->size(), "scenes") : 0;
  const auto instance = scenes->element(i).extension(image_light_extension);
  if (!instance) return std::nullopt;
  const auto definition = root.extension(image_light_extension);
  if (!definition) instance->fail("the document has no lights of that kind");
  const JsonNode lights = definition->member("lights");
  return lights.element(instance->member("light").as_index(lights.size(), "lights"));
}

}  // namespace

void add_gltf_image_light(const JsonNode& root, const GltfBuffers& buffers, Scene& scene) {
  const auto light = light_of_scene(root);
  if (!light) return;
  const double intensity = light->number_or("intensity", 1);
  if (!(intensity >= 0 && intensity <= 1e12))
    light->fail("its intensity must lie between 0 and 1e12");
  const JsonNode faces = light->member("specularImages").element(0), images = root.member("images");
  if (faces.size() != 6) faces.fail("a cube has six faces");
  Light e;
  e.kind = LightKind::environment;
  e.name = light->string_or("name", "environment");
  e.radiance = Rgb{float(intensity)};
  e.axes = axes_of(*light);
  e.environment = int32_t(scene.environments.size());
  if (scene.skipped_image_bytes) {
    *scene.skipped_image_bytes += 6;  // only needs to be positive
    return;
  }
  std::array<Face, 6> cube;
  try {
    for (size_t i = 0; i < 6; ++i) {
      const JsonNode image = images.element(faces.element(i).as_index(images.size(), "images"));
      cube[i] = read_face(image, buffers);
    }
  } catch (const InputError& error) {
    scene.warnings.add(std::string(image_light_extension) + ": " + error.reason() + "; left out");
    return;
  }
  EnvironmentMap map = map_of(cube);
  map.name = e.name;
  scene.environments.push_back(std::move(map));
  scene.lights.push_back(std::move(e));
}

}  // namespace troffer
