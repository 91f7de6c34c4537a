// Tests of decoding images in advance, and of importing scenes without their images.
#include <doctest/doctest.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "image/write_image.h"
#include "import/images_ahead.h"
#include "import/import.h"
#include "temp_folder.h"

using namespace troffer;

namespace test_images_ahead {

namespace {

// A scene of `count` materials with an image each. The fourth image is missing; the sixth is not an
// image.
struct Images {
  TempFolder folder;
  static constexpr int count = 12;
  static std::string name(int i) { return "i" + std::to_string(i) + ".png"; }

  Images() {
    for (int i = 0; i < count; ++i) {
      Image image(48 + i, 32);
      for (size_t p = 0; p < image.pixels.size(); ++p)
        image.pixels[p] = Rgb{float(i + 1) / count, float(p % 7) / 7, 0.5f};
      if (i != 3) write_image(folder.path(name(i)), image);
    }
    folder.write(name(5), "no image at all");
  }
  std::string obj() const {
    std::string mtl, text = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n";
    for (int i = 0; i < count; ++i) {
      mtl +=
          "newmtl m" + std::to_string(i) + "\nmap_Kd " + name(i) + "\nmap_Pr " + name(i / 2) + "\n";
      text += "usemtl m" + std::to_string(i) + "\nf 1/1 2/2 3/3\n";
    }
    folder.write("m.mtl", mtl);
    return folder.write("m.obj", text);
  }
  std::string pbrt() const {
    std::string text = "WorldBegin\n";
    for (int i = 0; i < count; ++i)
      text += "Texture \"t" + std::to_string(i) +
              "\" \"spectrum\" \"imagemap\" \"string filename\" [ \"" + name(i) +
              "\" ]\nMaterial \"diffuse\" \"texture reflectance\" \"t" + std::to_string(i) +
              "\"\nShape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 1 1 0] "
              "\"point2 uv\" [0 0 1 0 1 1] \"integer indices\" [0 1 2]\n";
    return folder.write("m.pbrt", text);
  }
  std::string xml() const {
    std::string text = "<scene version='3.0.0'>\n";
    for (int i = 0; i < count; ++i)
      text +=
          "<shape type='rectangle'><bsdf type='diffuse'><texture type='bitmap' "
          "name='reflectance'><string name='filename' value='" +
          name(i) + "'/></texture></bsdf></shape>\n";
    return folder.write("m.xml", text + "</scene>\n");
  }
  std::string gltf() const {
    std::string materials, textures, images, primitives;
    for (int i = 0; i < count; ++i) {
      const std::string n = std::to_string(i), comma = i > 0 ? "," : "";
      images += comma + "{'uri':'" + name(i) + "'}";
      textures += comma + "{'source':" + n + "}";
      materials += comma + "{'pbrMetallicRoughness':{'baseColorTexture':{'index':" + n + "}}}";
      primitives += comma + "{'attributes':{'POSITION':0,'TEXCOORD_0':1},'material':" + n + "}";
    }
    std::string text =
        "{'asset':{'version':'2.0'},'scene':0,'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0}],"
        "'meshes':[{'primitives':[" +
        primitives + "]}],'materials':[" + materials + "],'textures':[" + textures +
        "],'images':[" + images +
        "],'accessors':[{'componentType':5126,'count':3,'type':'VEC3','bufferView':0},"
        "{'componentType':5126,'count':3,'type':'VEC2','bufferView':0}],"
        "'bufferViews':[{'buffer':0,'byteLength':36}],'buffers':[{'byteLength':36,'uri':"
        "'data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAgD8AAAAA'"
        "}]}";
    for (char& c : text)
      if (c == '\'') c = '"';
    return folder.write("m.gltf", text);
  }
  std::vector<std::string> all() const { return {obj(), pbrt(), xml(), gltf()}; }
};

Scene import_on(int threads, const std::string& path) {
  const ThreadLimit limit(threads);
  return import_scene(path);
}

}  // namespace

TEST_CASE("images ahead: each is decoded at most once, with the same result, or not at all") {
  constexpr int count = 60;
  const auto key = [](int i) { return "k" + std::to_string(i); };
  for (const int threads : {0, 1, 3})
    for (const uint64_t most_bytes : {uint64_t(0), uint64_t(1) << 30}) {
      CAPTURE(threads);
      std::vector<std::atomic<int>> decoded(count);
      std::atomic<int> taken = 0;
      {
        ImagesAhead ahead(threads, most_bytes);
        for (int i = 0; i < count; ++i)
          ahead.expect(key(i), [&decoded, i] {
            ++decoded[size_t(i)];
            if (i % 10 == 7) throw InputError("f", 0, 0, "broken " + std::to_string(i));
            Raster raster;
            raster.width = i;
            raster.texels8.assign(size_t(100 * i), uint8_t(i));
            return raster;
          });
        CHECK(!ahead.take("another"));
        for (int n = 0; n < count; ++n) {
          const int i = n * 7 % count;  // another order
          if (const auto raster = ahead.take(key(i))) {
            ++taken;
            CHECK(i % 10 != 7);  // those fail to decode
            CHECK(raster->width == i);
            CHECK(raster->texels8 == std::vector<uint8_t>(size_t(100 * i), uint8_t(i)));
          }
          CHECK(!ahead.take(key(i)));
          ahead.expect(key(i), [] { return Raster(); });  // repeated keys have no effect
          CHECK(!ahead.take(key(i)));
        }
      }
      int all = 0;
      for (size_t i = 0; i < count; ++i) {
        CHECK(decoded[i] <= 1);
        if (i % 10 != 7) all += decoded[i];
      }
      CHECK(all == taken);
      if (threads == 0) CHECK(taken == 0);
    }
}

TEST_CASE("images ahead: an early exit waits only for images that were begun") {
  std::atomic<int> decoded = 0;
  {
    ImagesAhead ahead(2);
    for (int i = 0; i < 10000; ++i)
      ahead.expect(std::to_string(i), [&] {
        ++decoded;
        Raster raster;
        std::this_thread::sleep_for(std::chrono::microseconds(200));
        return raster;
      });
  }
  CHECK(decoded < 1000);  // only the end stops the threads; decoding all would take a second
}

TEST_CASE("images read on many threads give the same scene as on one thread") {
  const Images images;
  for (const std::string& path : images.all()) {
    CAPTURE(path);
    const Scene one = import_on(1, path), many = import_on(4, path);
    CHECK(!one.skipped_image_bytes);
    REQUIRE(one.textures.size() == many.textures.size());
    CHECK(one.textures.size() >= Images::count - 2);
    for (size_t i = 0; i < one.textures.size(); ++i) {
      CHECK(one.textures[i].name == many.textures[i].name);
      CHECK(one.textures[i].kind == many.textures[i].kind);
      CHECK(one.textures[i].width == many.textures[i].width);
      CHECK(one.textures[i].is_srgb == many.textures[i].is_srgb);
      CHECK(one.textures[i].texels8 == many.textures[i].texels8);
      CHECK(one.textures[i].texels_float == many.textures[i].texels_float);
    }
    REQUIRE(one.warnings.entries().size() == many.warnings.entries().size());
    CHECK(one.warnings.total() >= 2);  // for the missing and the broken image
    for (size_t i = 0; i < one.warnings.entries().size(); ++i)
      CHECK(one.warnings.entries()[i].text == many.warnings.entries()[i].text);
  }
}

TEST_CASE("a scene without its images has its shapes, and says how much it lacks") {
  const Images images;
  uint64_t bytes = 1;  // for the missing image
  for (int i = 0; i < Images::count; ++i)
    if (i != 3) bytes += std::filesystem::file_size(images.folder.path(Images::name(i)));
  ImportOptions options;
  options.images = ImageUse::left_out;
  for (const std::string& path : images.all()) {
    CAPTURE(path);
    const Scene shapes = import_scene(path, options), whole = import_scene(path);
    REQUIRE(shapes.skipped_image_bytes);
    CHECK(*shapes.skipped_image_bytes == bytes);
    CHECK(triangle_count(shapes) == triangle_count(whole));
    CHECK(shapes.meshes.size() == whole.meshes.size());
    CHECK(shapes.warnings.total() == 0);
    for (const Texture& t : shapes.textures) CHECK(t.kind == TextureKind::constant);
  }
  // A scene without images leaves nothing out.
  const std::string plain = images.folder.write("p.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
  const Scene scene = import_scene(plain, options);
  REQUIRE(scene.skipped_image_bytes);
  CHECK(*scene.skipped_image_bytes == 0);
}

TEST_CASE("image lights are left out with the other images") {
  const TempFolder folder;
  write_image(folder.path("sky.pfm"), Image(8, 4, Rgb{1}));
  const std::vector<std::string> scenes{
      folder.write("s.pbrt",
                   "WorldBegin\nLightSource \"infinite\" \"string filename\" \"sky.pfm\"\n"
                   "Shape \"sphere\"\n"),
      folder.write("s.xml",
                   "<scene version='3.0.0'><emitter type='envmap'><string name='filename' "
                   "value='sky.pfm'/></emitter><shape type='sphere'/></scene>")};
  for (const std::string& path : scenes) {
    CAPTURE(path);
    ImportOptions options;
    options.images = ImageUse::left_out;
    const Scene shapes = import_scene(path, options);
    CHECK(*shapes.skipped_image_bytes == std::filesystem::file_size(folder.path("sky.pfm")));
    CHECK(shapes.lights.empty());
    CHECK(shapes.warnings.total() == 0);
    CHECK(import_scene(path).lights.size() == 1);
  }
}

}  // namespace test_images_ahead
