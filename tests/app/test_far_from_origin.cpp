// A scene, and the same scene kilometres from its file's origin, where floats are spaced half a
// millimetre: the same pictures and figures, in the file's coordinates.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "image/read_image.h"
#include "import/gltf_builder.h"
#include "import/import.h"
#include "program.h"
#include "render/render.h"

using namespace troffer;
using namespace troffer::test;

namespace test_far_from_origin {
using Json = nlohmann::json;

namespace {

// A floor of 6 × 6 m, and a light of 1 × 1 m, 2.5 m up, with a plate 12 mm below that hides its
// middle.
struct Square {
  double half, height;
  bool is_light;
};
constexpr std::array squares{Square{3, 0, false}, Square{0.4, 2.488, false},
                             Square{0.5, 2.5, true}};

std::array<Vec3d, 4> corners(const Square& s, const Vec3d& offset) {
  std::array<Vec3d, 4> c{Vec3d{-s.half, -s.half, s.height}, Vec3d{s.half, -s.half, s.height},
                         Vec3d{s.half, s.half, s.height}, Vec3d{-s.half, s.half, s.height}};
  if (s.is_light) std::swap(c[1], c[3]);
  for (Vec3d& p : c) p += offset;
  return c;
}
std::string text_of(const Vec3d& p, const char* separator) {
  return fmt::format("{:.6f}{}{:.6f}{}{:.6f}", p.x, separator, p.y, separator, p.z);
}

std::string pbrt_scene(const Folder& folder, const Vec3d& offset) {
  std::string text = "LookAt " + text_of(offset + Vec3d{0.25, -1, 2}, " ") + " " +
                     text_of(offset + Vec3d{0.25, 0, 0}, " ") +
                     " 0 1 0\nCamera \"perspective\" \"float fov\" [80]\nWorldBegin\n"
                     "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n";
  for (const Square& s : squares) {
    if (s.is_light) text += "AreaLightSource \"diffuse\" \"rgb L\" [10 10 10]\n";
    text += "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [";
    for (const Vec3d& p : corners(s, offset)) text += text_of(p, " ") + "  ";
    text += "]\n";
  }
  return folder.write("scene.pbrt", text);
}

std::string obj_scene(const Folder& folder, const Vec3d& offset) {
  folder.write("scene.mtl", "newmtl grey\nKd 0.5 0.5 0.5\nnewmtl light\nKe 10 10 10\n");
  std::string text = "mtllib scene.mtl\n";
  for (const Square& s : squares) {
    for (const Vec3d& p : corners(s, offset)) text += "v " + text_of(p, " ") + "\n";
    text += std::string("usemtl ") + (s.is_light ? "light" : "grey") + "\nf -4 -3 -2 -1\n";
  }
  return folder.write("scene.obj", text);
}

// Unit squares, moved and scaled by their nodes; the light is flipped.
std::string gltf_scene(const Folder& folder, const Vec3d& offset) {
  std::string nodes;
  for (const Square& s : squares) {
    const Vec3d corner = offset + Vec3d{-s.half, s.is_light ? s.half : -s.half, s.height};
    nodes += fmt::format("{{'mesh':{},'translation':[{}],'scale':[{},{},1]{}}},", int(s.is_light),
                         text_of(corner, ","), 2 * s.half, 2 * s.half,
                         s.is_light ? ",'rotation':[1,0,0,0]" : "");
  }
  nodes += "{'camera':0,'translation':[" + text_of(offset + Vec3d{0.25, -0.5, 2}, ",") + "]}";
  const std::string primitive = "{'primitives':[{'attributes':{'POSITION':0},'indices':1,";
  return folder.write(
      "scene.gltf",
      gltf_text(square_data() + ",\n'meshes':[" + primitive + "'material':0}]}," + primitive +
                "'material':1}]}],\n'nodes':[" + nodes +
                "],\n'cameras':[{'type':'perspective','perspective':{'yfov':1.2,'znear':0.1}}],\n"
                "'materials':[{},{'emissiveFactor':[1,1,1]}]"));
}

using MakeScene = std::string (*)(const Folder&, const Vec3d&);

Finished run_well(const Folder& folder, const std::vector<std::string>& arguments) {
  Finished f = run_program(folder, arguments);
  CAPTURE(f.err);
  CHECK(f.status == 0);
  return f;
}

// Returns the positions of first hits.
Image positions(const std::string& file) {
  const PreparedScene scene(import_scene(file));
  RenderOptions options;
  options.method = Method::fixed;
  options.spp = 4;
  options.width = 24;
  options.height = 16;
  options.threads = 1;
  options.aovs = {Aov::position};
  const StopFlag never = false;
  return render(scene, scene.scene.cameras.at(0), options, {}, never).layers.at(1).image;
}

// An OBJ has no camera; its view is given on the command line in the file's coordinates.
Image picture(const Folder& folder, MakeScene make, const Vec3d& offset, const std::string& method,
              const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments{"render",
                                     make(folder, offset),
                                     "--method",
                                     method,
                                     "--spp",
                                     "4",
                                     "--size",
                                     "24x16",
                                     "--quiet",
                                     "-o",
                                     folder.path("p.pfm")};
  if (make == obj_scene)
    for (const std::string& a :
         {std::string("--eye=") + text_of(offset + Vec3d{0.25, -1, 2}, ","),
          std::string("--target=") + text_of(offset + Vec3d{0.25, 0, 0}, ",")})
      arguments.push_back(a);
  arguments.insert(arguments.end(), more.begin(), more.end());
  run_well(folder, arguments);
  return read_image(folder.path("p.pfm"));
}

const std::vector<Vec3d> far_offsets{{5000, 5000, 0}, {10000, -10000, 5000}};

}  // namespace

TEST_CASE("a scene moved by kilometres gives the same picture, in every format and method") {
  const Folder folder;
  for (const MakeScene make : {MakeScene(pbrt_scene), MakeScene(gltf_scene), MakeScene(obj_scene)})
    for (const char* method : {"fixed", "path", "certified"}) {
      const Image near = picture(folder, make, {}, method);
      double largest = 0;
      for (const Rgb& p : near.pixels) largest = std::max(largest, double(p.g));
      CHECK(largest > 0.01);
      for (const Vec3d& offset : far_offsets) {
        CAPTURE(method);
        CAPTURE(offset.x);
        CHECK(picture(folder, make, offset, method).pixels == near.pixels);
      }
    }
}

TEST_CASE("a plate 12 mm below a light is opaque 5 km from the origin") {
  const Folder folder;
  const std::string points = folder.write("p.csv", "x,y,z,nx,ny,nz\n5000,5000,2.45,0,0,1\n");
  const std::string scene = pbrt_scene(folder, {5000, 5000, 0});
  for (const char* method : {"fixed", "path", "certified"}) {
    const Finished f = run_well(folder, {"measure", scene, "--points", points, "--method", method,
                                         "--indirect", "none", "--spp", "64"});
    CAPTURE(f.out);
    CHECK(f.out.find("5000,5000,2.45,0,0,1,0,0,0,0,0") != std::string::npos);
  }
}

TEST_CASE("the position AOV and info's bounds are in the file's coordinates") {
  const Folder folder;
  const Vec3d offset{10000, -5000, 5000};
  for (const MakeScene make :
       {MakeScene(pbrt_scene), MakeScene(gltf_scene), MakeScene(obj_scene)}) {
    if (make != obj_scene) {  // an OBJ has no camera
      const Image near = positions(make(folder, {})), far = positions(make(folder, offset));
      size_t off = 0, seen = 0;
      for (size_t i = 0; i < near.pixels.size(); ++i) {
        const Rgb &p = near.pixels[i], &q = far.pixels[i];
        if (p == Rgb{0} && q == Rgb{0}) continue;
        ++seen;
        off += std::abs(double(q.r) - offset.x - double(p.r)) > 1e-3 ||
               std::abs(double(q.g) - offset.y - double(p.g)) > 1e-3 ||
               std::abs(double(q.b) - offset.z - double(p.b)) > 1e-3;
      }
      CHECK(seen > 100);
      CHECK(off == 0);
    }
    const std::string scene = make(folder, offset);
    const Json box = Json::parse(run_well(folder, {"info", scene, "--json"}).out)["bounds"];
    CHECK(box[0][0].get<double>() == 9997);
    CHECK(box[1][1].get<double>() == -4997);
    CHECK(box[1][2].get<double>() == 5002.5);
    CHECK(run_well(folder, {"info", scene}).out.find("9997 -5003 5000  to  10003 -4997 5002.5") !=
          std::string::npos);
  }
}

TEST_CASE("measured points use the file's coordinates and are printed as given") {
  const Folder folder;
  const auto measured = [&](const Vec3d& offset) {
    std::string points = "x,y,z,nx,ny,nz\n";
    for (const Vec3d& p : {Vec3d{0.7, 0.3, 0.001}, Vec3d{-1.1, 0.2, 1.25}, Vec3d{0, 0, 2.495}})
      points += fmt::format("{:.10g},{:.10g},{:.10g},0,0,1\n", p.x + offset.x, p.y + offset.y,
                            p.z + offset.z);
    const std::string file = folder.write("p.csv", points);
    const std::string out = run_well(folder, {"measure", pbrt_scene(folder, offset), "--points",
                                              file, "--method", "fixed", "--spp", "64"})
                                .out;
    // Coordinates appear as given: each line begins with the text of the points file.
    std::vector<std::string> values;
    size_t at = points.find('\n') + 1, line = out.find('\n') + 1;
    for (int i = 0; i < 3; ++i) {
      const std::string given = points.substr(at, points.find('\n', at) - at);
      const std::string found = out.substr(line, out.find('\n', line) - line);
      CHECK(found.substr(0, given.size()) == given);
      values.push_back(found.substr(std::min(given.size(), found.size())));
      at += given.size() + 1;
      line += found.size() + 1;
    }
    return values;
  };
  const std::vector<std::string> near = measured({});
  CHECK(near[0] != near[1]);
  for (const Vec3d& offset : far_offsets) CHECK(measured(offset) == near);
}

TEST_CASE("a radiosity solution and its picture in glTF move with the scene") {
  const Folder folder;
  const auto solve = [&](const Vec3d& offset, const char* name) {
    run_well(folder, {"radiosity", pbrt_scene(folder, offset), "--quiet", "-o", folder.path(name)});
  };
  solve({}, "near.trad");
  solve(far_offsets[0], "far.trad");
  CHECK(read_file(folder.path("near.trad")) == read_file(folder.path("far.trad")));
  solve(far_offsets[0], "far.gltf");
  const std::string drawn = run_well(folder, {"info", folder.path("far.gltf"), "--json"}).out;
  const Json box = Json::parse(drawn)["bounds"];
  CHECK(box[0][0].get<double>() == doctest::Approx(4997).epsilon(1e-7));
  CHECK(box[1][1].get<double>() == doctest::Approx(5003).epsilon(1e-7));
}

}  // namespace test_far_from_origin
