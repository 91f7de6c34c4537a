#include "import/gltf/gltf_texture.h"

#include <optional>

#include "import/file.h"
#include "import/gltf/gltf_uri.h"
#include "import/uri.h"

namespace troffer {

namespace {

WrapMode wrap_mode(const JsonNode& sampler, const char* key) {
  const auto node = sampler.find(key);
  const uint64_t value = node ? node->as_integer(~uint64_t(0)) : 10497;
  switch (value) {
    case 10497:
      return WrapMode::repeat;
    case 33071:
      return WrapMode::clamp;
    case 33648:
      return WrapMode::mirror;
    default:
      node->fail(std::to_string(value) + " is not a wrapping mode");
  }
}

void read_sampler(const JsonNode& sampler, Texture& look) {
  look.wrap_u = wrap_mode(sampler, "wrapS");
  look.wrap_v = wrap_mode(sampler, "wrapT");
  constexpr uint64_t nearest = 9728, linear = 9729;
  if (const auto filter = sampler.find("magFilter")) {
    const uint64_t value = filter->as_integer(~uint64_t(0));
    if (value != nearest && value != linear)
      filter->fail(std::to_string(value) + " is not a magnification filter");
    look.is_filtered = value == linear;
  }
}

void read_transform(const JsonNode& transform, Texture& look) {
  const auto offset = transform.numbers_or("offset", {0, 0});
  const auto scale = transform.numbers_or("scale", {1, 1});
  look.uv_offset = {float(offset[0]), float(offset[1])};
  look.uv_scale = {float(scale[0]), float(scale[1])};
  look.uv_rotation_rad = float(transform.number_or("rotation", 0));
}

// Loads an image file. If its path leads out of the scene's folder, tries a file of the same name
// beside the scene; otherwise reports the image as missing.
int32_t load_file(const JsonNode& uri, const std::string& folder, const Texture& look,
                  TextureLoader& loader) {
  const std::string name = percent_decoded(uri.as_string()).value_or(uri.as_string());
  const bool has_drive = name.size() > 1 && name[1] == ':';  // drive letter of a Windows path
  const bool is_elsewhere = has_uri_scheme(uri.as_string()) && !has_drive;
  const ConfinedPath path = confined_path(folder, name);
  if (!is_elsewhere && path.is_fine()) return loader.from_file(path.path, look);
  const std::string beside = path_beside(folder, name);
  if (!beside.empty()) return loader.from_file(beside, look);
  return loader.missing(printable(uri.as_string()),
                        is_elsewhere ? "only files in the scene's folder are read" : path.problem,
                        look);
}

int32_t load_image(const JsonNode& image, const Texture& look, const GltfBuffers& buffers,
                   TextureLoader& loader) {
  const std::string key = gltf_image_key(image);
  if (const auto view = image.find("bufferView"))
    return loader.from_memory(buffers.buffer_view(*view), key, look);
  const auto uri = image.find("uri");
  if (!uri) return loader.missing(key, "has neither a uri nor a buffer view", look);
  if (!is_data_uri(uri->as_string())) return load_file(*uri, folder_of(image.file()), look, loader);
  // Decoding base64 again for a second use is cheaper than keeping the bytes.
  const auto data = parse_data_uri(uri->as_string());
  if (!data) uri->fail("is a malformed data URI");
  return loader.from_memory(data->bytes, key, look);
}

// Asks the loader to decode an image in advance. Skips data URIs, whose decoded bytes would have to
// be kept.
void expect_image(const JsonNode& image, const GltfBuffers& buffers, TextureLoader& loader) {
  if (const auto view = image.find("bufferView")) {
    loader.expect_memory(buffers.buffer_view(*view), gltf_image_key(image));
    return;
  }
  const auto uri = image.find("uri");
  if (!uri || has_uri_scheme(uri->as_string())) return;
  const std::string name = percent_decoded(uri->as_string()).value_or(uri->as_string());
  const ConfinedPath path = confined_path(folder_of(image.file()), name);
  if (path.is_fine()) loader.expect_file(path.path);
}

// Returns the WebP image if there is one, else the plain image. The latter may accompany a format
// that is not read (KHR_texture_basisu).
std::optional<JsonNode> source_of(const JsonNode& texture) {
  if (const auto webp = texture.extension("EXT_texture_webp"))
    if (auto source = webp->find("source")) return source;
  return texture.find("source");
}

}  // namespace

std::string gltf_image_key(const JsonNode& image) {
  return image.file() + "#" + image.pointer();
}

void expect_gltf_images(const JsonNode& root, const JsonNode& node, const GltfBuffers& buffers,
                        TextureLoader& loader) {
  for (const std::string& key : node.keys()) {
    const JsonNode below = node.member(key);
    if (!below.is_object() || key == "occlusionTexture" || key == "extras") continue;
    if (!key.ends_with("Texture")) {
      expect_gltf_images(root, below, buffers, loader);
      continue;
    }
    const JsonNode textures = root.member("textures"), images = root.member("images");
    const JsonNode texture =
        textures.element(below.member("index").as_index(textures.size(), "textures"));
    if (const auto source = source_of(texture))
      expect_image(images.element(source->as_index(images.size(), "images")), buffers, loader);
  }
}

GltfTextureUse gltf_texture(const JsonNode& root, const JsonNode& info, bool is_srgb,
                            const GltfUvSets& sets, const GltfBuffers& buffers,
                            TextureLoader& loader, Scene& scene) {
  GltfTextureUse use;
  Texture look;
  if (gltf_uv_set(info) == sets.second) look.mapping = TextureMapping::second_uv;
  look.is_srgb = is_srgb;
  if (const auto transform = info.extension("KHR_texture_transform"))
    read_transform(*transform, look);
  const JsonNode textures = root.member("textures");
  const JsonNode texture =
      textures.element(info.member("index").as_index(textures.size(), "textures"));
  if (const auto sampler = texture.find("sampler")) {
    const JsonNode samplers = root.member("samplers");
    read_sampler(samplers.element(sampler->as_index(samplers.size(), "samplers")), look);
  }
  const auto source = source_of(texture);
  if (!source) {
    // The only image may be in an extension's format.
    scene.warnings.add(printable(texture.pointer()) +
                       ": has no image of a supported format; grey replaces it");
    use.stand_in = stand_in_for_missing(is_srgb);
    return use;
  }
  const JsonNode images = root.member("images");
  const JsonNode image = images.element(source->as_index(images.size(), "images"));
  const int32_t loaded = load_image(image, look, buffers, loader);
  const Texture& made = scene.textures[size_t(loaded)];
  if (made.kind == TextureKind::image)
    use.texture = loaded;
  else
    use.stand_in = made.value;
  return use;
}

}  // namespace troffer
