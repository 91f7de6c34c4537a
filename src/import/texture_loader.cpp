#include "import/texture_loader.h"

#include <algorithm>
#include <array>
#include <bit>

#include "base/error.h"
#include "base/parallel.h"
#include "image/raster.h"
#include "import/file.h"
#include "import/halve_texture.h"

namespace troffer {

namespace {

constexpr uint64_t max_image_file_bytes = uint64_t(1) << 30;

// Returns a key that is equal for requests with equal textures. It contains the exact bits of all
// numbers.
std::string request_key(const std::string& image, const Texture& look) {
  std::string key = image;
  key += '\0';
  key += look.name;
  key += '\0';
  const std::array<float, 8> numbers{look.value.r,     look.value.g,        look.value.b,
                                     look.uv_scale.x,  look.uv_scale.y,     look.uv_offset.x,
                                     look.uv_offset.y, look.uv_rotation_rad};
  for (const float f : numbers) key += std::to_string(std::bit_cast<uint32_t>(f)) + ' ';
  for (const int flag : {int(look.is_srgb), int(look.is_inverted), int(look.is_filtered),
                         int(look.wrap_u), int(look.wrap_v), int(look.mapping)})
    key += std::to_string(flag);
  return key;
}

// Linearises a 16-bit image, whose floats still carry the sRGB transfer function.
void linearize(Texture& t) {
  const auto n = size_t(t.channels);
  const bool has_alpha = n == 2 || n == 4;
  for (size_t i = 0; i < t.texels_float.size(); ++i)
    if (!has_alpha || i % n != n - 1) t.texels_float[i] = linear_from_srgb(t.texels_float[i]);
}

uint64_t texel_bytes(const Texture& t) {
  return t.texels8.size() + t.texels_float.size() * sizeof(float);
}

}  // namespace

uint64_t size_of_left_out(const std::string& path) {
  try {
    return std::max(size_of_file(path), uint64_t(1));
  } catch (const InputError&) {
    return 1;
  }
}

// Converts colours to sRGB's primaries and clips negative values.
Raster TextureLoader::color_raster(const std::string& key, Raster raster) {
  if (obeys_own_colours_ && troffer::convert_to_srgb(raster) == ColoursFound::broken)
    scene_.warnings.add(key + broken_colours);
  if (!raster.primaries) return raster;
  raster = rec709_raster(std::move(raster), true);
  for (float& v : raster.texels_float)
    if (v < 0) v = 0;
  return raster;
}

int32_t TextureLoader::remember(const std::string& key, const Texture& look, Texture texture) {
  const auto index = int32_t(scene_.textures.size());
  scene_.textures.push_back(std::move(texture));
  by_request_[request_key(key, look)] = index;
  return index;
}

bool TextureLoader::was_asked_for(const std::string& image) const {
  const std::string beginning = image + '\0';  // first part of request_key()
  const auto it = by_request_.lower_bound(beginning);
  return it != by_request_.end() && it->first.starts_with(beginning);
}

int32_t TextureLoader::missing(const std::string& key, const std::string& problem,
                               const Texture& look) {
  scene_.warnings.add(key + ": " + problem + (look.is_srgb ? "; grey replaces it" : "; left out"));
  return constant(key, look);
}

int32_t TextureLoader::constant(const std::string& key, const Texture& look) {
  Texture constant;
  constant.name = look.name.empty() ? key : look.name;
  constant.value = look.value * stand_in_for_missing(look.is_srgb);
  return remember(key, look, std::move(constant));
}

bool TextureLoader::decodes_ahead() const {
  return !scene_.skipped_image_bytes && thread_count(0) > 1;
}

void TextureLoader::expect(const std::string& key, ImagesAhead::Decode decode) {
  constexpr int most_threads = 8;  // each may need as much memory as an image
  if (!decodes_ahead()) return;
  if (!ahead_) ahead_ = std::make_unique<ImagesAhead>(std::min(thread_count(0), most_threads) - 1);
  ahead_->expect(key, std::move(decode));
}

void TextureLoader::expect_file(const std::string& path) {
  expect(path, [path] {
    return decode_raster(read_file(path, max_image_file_bytes, ReadFor::guess), path);
  });
}

void TextureLoader::expect_memory(std::span<const uint8_t> bytes, const std::string& key) {
  expect(key, [bytes, key] { return decode_raster(bytes, key); });
}

// Returns a texture of the same image with the texels that `look` requires, if there is one. 8-bit
// texels stay encoded and serve both readings, unless colours were converted. Float texels exist
// either linearised or not.
const Texture* TextureLoader::decoded(const std::string& key, const Texture& look) const {
  for (const bool is_srgb : {look.is_srgb, !look.is_srgb}) {
    const auto it = by_image_.find({key, is_srgb});
    if (it == by_image_.end()) continue;
    const Texture& texture = scene_.textures[size_t(it->second)];
    if (is_srgb == look.is_srgb || (!texture.texels8.empty() && !obeys_own_colours_))
      return &texture;
  }
  return nullptr;
}

// Halves a texture until it fits. A single texel, the image's mean, is always accepted.
Texture TextureLoader::reduced(Texture texture) {
  const uint64_t left = max_texel_bytes_ - std::min(max_texel_bytes_, texel_bytes_);
  if (texel_bytes(texture) <= left) return texture;
  scene_.warnings.add(
      "images are reduced to half their size or less: together they need too much memory");
  while (texel_bytes(texture) > left && (texture.width > 1 || texture.height > 1))
    texture = halved(std::move(texture));
  return texture;
}

int32_t TextureLoader::add(const std::string& key, const Texture& look, const Source& source) {
  const auto same = by_request_.find(request_key(key, look));
  if (same != by_request_.end()) return same->second;
  if (scene_.skipped_image_bytes) {
    if (!was_asked_for(key)) *scene_.skipped_image_bytes += source.size();
    if (!source.file.empty()) FilesRead::note(source.file);
    return constant(key, look);
  }

  Texture texture = look;
  if (texture.name.empty()) texture.name = key;
  texture.kind = TextureKind::image;
  try {
    if (const Texture* other = decoded(key, look)) {
      texture.width = other->width;
      texture.height = other->height;
      texture.channels = other->channels;
      if (obeys_own_colours_ && look.is_srgb) texture.is_srgb = other->is_srgb;
      texture.texels8 = other->texels8;
      texture.texels_float = other->texels_float;
    } else {
      std::optional<Raster> ready = ahead_ ? ahead_->take(key) : std::nullopt;
      if (ready && !source.file.empty()) FilesRead::note(source.file);
      Raster raster = ready ? std::move(*ready) : decode_raster(source.bytes(), key);
      if (look.is_srgb) raster = color_raster(key, std::move(raster));
      texture.width = raster.width;
      texture.height = raster.height;
      texture.channels = raster.channels;
      texture.texels8 = std::move(raster.texels8);
      texture.texels_float = std::move(raster.texels_float);
      if (!raster.is_srgb) texture.is_srgb = false;
      if (texture.is_srgb && !texture.texels_float.empty()) linearize(texture);
    }
  } catch (const InputError& e) {
    return missing(key, e.reason(), look);
  }
  texture = reduced(std::move(texture));
  texel_bytes_ += texel_bytes(texture);
  const int32_t index = remember(key, look, std::move(texture));
  by_image_.emplace(std::pair{key, look.is_srgb}, index);
  return index;
}

int32_t TextureLoader::from_file(const std::string& path, const Texture& look) {
  std::vector<uint8_t> contents;
  const auto bytes = [&]() -> std::span<const uint8_t> {
    contents = read_file(path, max_image_file_bytes);
    return contents;
  };
  return add(path, look, {bytes, [&] { return size_of_left_out(path); }, path});
}

int32_t TextureLoader::from_memory(std::span<const uint8_t> bytes, const std::string& key,
                                   const Texture& look) {
  return add(key, look,
             {[&] { return bytes; }, [&] { return std::max(bytes.size(), size_t(1)); }, ""});
}

}  // namespace troffer
