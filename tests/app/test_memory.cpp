// Memory use by number of triangles.
#include <doctest/doctest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>

#include "program.h"

using namespace troffer;
using namespace troffer::test;

namespace test_memory {

namespace {

// A bent and rough surface of 2 n² triangles, none of them coplanar with a neighbour.
std::string rough_ply(int n) {
  std::string text =
      "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string((n + 1) * (n + 1)) +
      "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
      std::to_string(2 * n * n) + "\nproperty list uchar int vertex_indices\nend_header\n";
  const auto add = [&](const auto& value) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    text.append(bytes, sizeof value);
  };
  uint32_t random = 1;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      random = random * 1664525 + 1013904223;
      const float x = 8.0f * float(i) / float(n) - 4, y = 8.0f * float(j) / float(n) - 4;
      add(x);
      add(y);
      add(0.2f * std::sin(3 * x) * std::cos(2 * y) + 0.001f * float(random >> 16) / 65536.0f);
    }
  const auto face = [&](int a, int b, int c) {
    add(uint8_t{3});
    add(int32_t{a});
    add(int32_t{b});
    add(int32_t{c});
  };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i;
      face(a, a + 1, a + n + 2);
      face(a, a + n + 2, a + n + 1);
    }
  return text;
}

std::string scene_with(const std::string& lights) {
  return "LookAt 3.5 3.5 2  0 0 0  0 0 1\nCamera \"perspective\"\n"
         "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 12\nWorldBegin\n"
         "Shape \"plymesh\" \"string filename\" \"rough.ply\"\n" +
         lights;
}

double peak_mb(const Folder& folder, const std::string& scene,
               const std::vector<std::string>& options = {"--error", ".1"}) {
  std::vector<std::string> words{"render",    scene,
                                 "-o",        folder.path("o.exr"),
                                 "--stats",   folder.path("s.json"),
                                 "--spp",     "1",
                                 "--threads", "2",
                                 "--quiet"};
  words.insert(words.end(), options.begin(), options.end());
  const Finished f = run_program(folder, words);
  CHECK(f.status == 0);
  return nlohmann::json::parse(read_file(folder.path("s.json")))["peak_memory_mb"];
}

}  // namespace

TEST_CASE(
    "the default method takes less than 200 bytes per triangle under area lights, 145 under a "
    "point light") {
  constexpr int n = 600, few = 4;
  const std::string lamps =
      "AttributeBegin\nTranslate 0 0 2.5\nAreaLightSource \"diffuse\" \"rgb L\" [12 11 10]\n"
      "Shape \"disk\" \"float radius\" .3\nAttributeEnd\n";
  const std::string point = "LightSource \"point\" \"point3 from\" [0 0 2]\n";
  for (const bool is_asked : {true, false}) {
    const Folder folder;
    const std::string scene = folder.write("s.pbrt", scene_with(is_asked ? lamps : point));
    folder.write("rough.ply", rough_ply(few));
    const double least = peak_mb(folder, scene);
    folder.write("rough.ply", rough_ply(n));
    // Two threads' peak memory depends on timing: take the least of three runs.
    double peak = peak_mb(folder, scene);
    for (int i = 0; i < 2; ++i) peak = std::min(peak, peak_mb(folder, scene));
    const double per_triangle = (peak - least) * (1 << 20) / (2 * n * n);
    CAPTURE(is_asked);
    MESSAGE(per_triangle << " bytes for a triangle");
    CHECK(per_triangle < (is_asked ? 200 : 145));
  }
}

TEST_CASE("instances take no memory for their triangles, neither for rays nor for certificates") {
  constexpr int n = 370, many = 100;  // enough triangles for the file's objects to be shared
  const Folder folder;
  folder.write("rough.ply", rough_ply(n));
  const auto scene_of = [&](int count) {
    std::string text = scene_with(
        "ObjectBegin \"o\"\nShape \"plymesh\" \"string filename\" \"rough.ply\"\nObjectEnd\n"
        "AttributeBegin\nTranslate 0 0 2.5\nAreaLightSource \"diffuse\" \"rgb L\" [12 11 10]\n"
        "Shape \"disk\" \"float radius\" .3\nAttributeEnd\n");
    for (int i = 0; i < count; ++i)
      text += "AttributeBegin\nTranslate " + std::to_string(-4 + 0.8 * (i % 10)) + " " +
              std::to_string(-4 + 0.8 * (i / 10)) +
              " .3\nScale .1 .1 .3\nObjectInstance \"o\"\nAttributeEnd\n";
    return folder.write("s" + std::to_string(count) + ".pbrt", text);
  };
  // These options use no cells, whose number grows with the surfaces.
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{"--error", ".1", "--indirect", "none"}, {"--method", "path"}}) {
    const double few = peak_mb(folder, scene_of(2), options);
    const double all = peak_mb(folder, scene_of(many), options);
    CAPTURE(options[1]);
    MESSAGE(few << " MB with 2, " << all << " MB with " << many);
    const double per_triangle = (all - few) * (1 << 20) / (2.0 * n * n * (many - 2));
    CHECK(per_triangle < 2);
  }
}

// Large pages reserve addresses.
TEST_CASE("a small address space is enough") {
#if !defined(__SANITIZE_ADDRESS__)
  const Folder folder;
  folder.write("rough.ply", rough_ply(20));
  const std::string scene =
      folder.write("s.pbrt", scene_with("LightSource \"point\" \"point3 from\" [0 0 2]\n"));
  for (const rlim_t megabytes : {400, 1100, 2000}) {
    CAPTURE(megabytes);
    Running run(folder, {"render", scene, "-o", folder.path("o.exr"), "--threads", "2", "--quiet"},
                [&] {
                  const rlimit limit{megabytes << 20, megabytes << 20};
                  setrlimit(RLIMIT_AS, &limit);
                });
    const Finished f = run.wait();
    CAPTURE(f.err);
    CHECK(f.status == 0);
  }
#endif
}

TEST_CASE("memory does not grow with the number of rays that are asked for") {
#if !defined(__SANITIZE_ADDRESS__)
  const Folder folder;
  folder.write("rough.ply", rough_ply(20));
  const std::string scene =
      folder.write("s.pbrt", scene_with("AttributeBegin\nTranslate 0 0 2.5\nAreaLightSource "
                                        "\"diffuse\" \"rgb L\" [12 11 10]\nShape \"disk\" "
                                        "\"float radius\" .3\nAttributeEnd\n"));
  const std::string points = folder.write("p.csv", "x,y,z,nx,ny,nz\n0,0,1,0,0,1\n");
  using Words = std::vector<std::string>;
  const Words render{"render", scene,   "-o",      folder.path("o.exr"), "--size",
                     "48x32",  "--spp", "1000000", "--time-limit",       "0.5"},
      measure{"measure", scene, "--points", points, "-o", folder.path("o.csv"), "--spp", "100000"};
  for (const std::string method : {"certified", "cached-path", "path", "fixed", "kj92"})
    for (Words words : {render, measure}) {
      words.insert(words.end(), {"--method", method, "--threads", "1", "--quiet"});
      Running run(folder, words, [] {
        const rlimit limit{rlim_t{1} << 30, rlim_t{1} << 30};
        setrlimit(RLIMIT_AS, &limit);
      });
      const Finished f = run.wait();
      CAPTURE(words[0]);
      CAPTURE(method);
      CAPTURE(f.err);
      CHECK(f.status == 0);
      CHECK(f.processor_seconds < 20);
    }
#endif
}

}  // namespace test_memory
