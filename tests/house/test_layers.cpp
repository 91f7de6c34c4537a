// Checks layers.txt against the #includes, in both directions. A room may include only the rooms in
// its row, which must stand above it, and must include all of them. Each external library has one
// room that may include it, with few exceptions.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace fs = std::filesystem;

namespace {

const fs::path root = TROFFER_SOURCE_DIR;

struct Layers {
  std::vector<std::string> order;
  std::map<std::string, std::set<std::string>> uses;
};

Layers read_layers() {
  Layers layers;
  std::ifstream in(root / "layers.txt");
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    const size_t colon = line.find(':');
    REQUIRE(colon != std::string::npos);
    const std::string room = line.substr(0, colon);
    layers.order.push_back(room);
    std::istringstream rest(line.substr(colon + 1));
    layers.uses[room];
    for (std::string use; rest >> use;) layers.uses[room].insert(use);
  }
  return layers;
}

// Included names of a file, such as "base/vec.h", quoted and angled alike.
std::vector<std::string> includes_of(const fs::path& file) {
  std::vector<std::string> names;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("#include", 0) != 0) continue;
    const size_t open = line.find_first_of("\"<");
    const size_t close = line.find_first_of("\">", open + 1);
    if (open != std::string::npos && close != std::string::npos)
      names.push_back(line.substr(open + 1, close - open - 1));
  }
  return names;
}

std::vector<fs::path> files_of(const std::string& room) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(root / "src" / room))
    if (entry.path().extension() == ".h" || entry.path().extension() == ".cpp")
      files.push_back(entry.path());
  return files;
}

// The room that an included name belongs to. The public headers of include/troffer are api's, but
// for the types of failures, which base implements and all rooms may throw.
std::string room_of(const std::string& name) {
  if (name == "troffer/error.h") return "";
  const std::string folder = name.substr(0, name.find('/'));
  return folder == "troffer" ? "api" : folder;
}

// From room to room, with a file that includes: what layers.txt should say.
using Arrows = std::map<std::pair<std::string, std::string>, std::string>;

Arrows arrows_of(const Layers& layers) {
  Arrows arrows;
  for (const std::string& room : layers.order)
    for (const fs::path& file : files_of(room))
      for (const std::string& name : includes_of(file)) {
        if (name.find('/') == std::string::npos) continue;
        const std::string other = room_of(name);
        if (other != room && layers.uses.count(other) == 1)
          arrows.emplace(std::pair(room, other), file.string());
      }
  return arrows;
}

}  // namespace

TEST_CASE("every room of src/ has a row in layers.txt, and every row a room") {
  const Layers layers = read_layers();
  std::set<std::string> rooms;
  for (const auto& entry : fs::directory_iterator(root / "src"))
    if (entry.is_directory()) rooms.insert(entry.path().filename().string());
  CHECK(rooms == std::set<std::string>(layers.order.begin(), layers.order.end()));
}

TEST_CASE("rooms use only rooms listed before them") {
  const Layers layers = read_layers();
  std::set<std::string> below;
  for (const std::string& room : layers.order) {
    for (const std::string& use : layers.uses.at(room))
      CHECK_MESSAGE(below.count(use) == 1, room, " uses ", use, ", which does not stand below it");
    below.insert(room);
  }
}

TEST_CASE("rooms include only what their rows name, and all of that") {
  const Layers layers = read_layers();
  const Arrows arrows = arrows_of(layers);
  CHECK(arrows.size() > 30);
  for (const auto& [arrow, file] : arrows)
    CHECK_MESSAGE(layers.uses.at(arrow.first).count(arrow.second) == 1, file,
                  " includes a file of ", arrow.second, ", which the row of ", arrow.first,
                  " does not name");
  for (const auto& [room, uses] : layers.uses)
    for (const std::string& use : uses)
      CHECK_MESSAGE(arrows.count({room, use}) == 1, "the row of ", room, " names ", use,
                    ", which no file of it includes");
}

TEST_CASE("public headers include the standard library and each other alone") {
  size_t files = 0;
  for (const auto& entry : fs::directory_iterator(root / "include/troffer")) {
    ++files;
    for (const std::string& name : includes_of(entry.path()))
      CHECK_MESSAGE(
          (name.rfind("troffer/", 0) == 0 || name.find_first_of("./") == std::string::npos),
          entry.path().string(), " includes ", name);
  }
  CHECK(files > 5);
}

TEST_CASE("each external library is included only in its own rooms") {
  const std::map<std::string, std::set<std::string>> doors{
      {"embree3/", {"trace"}},
      {"tbb/", {"base"}},
      {"OpenEXR/", {"image"}},
      {"Imf", {"image"}},
      {"png.h", {"image"}},
      {"jpeglib.h", {"image"}},
      {"CLI/", {"app"}},
      {"nlohmann/", {"import", "export", "report", "annual", "view", "app"}},
      {"pugixml", {"import"}},
      {"zlib.h", {"import"}},
      {"microhttpd", {"view"}},
      {"pybind11/", {"python"}},
      {"mpi.h", {"mpi"}}};
  const Layers layers = read_layers();
  for (const std::string& room : layers.order)
    for (const fs::path& file : files_of(room))
      for (const std::string& name : includes_of(file))
        for (const auto& [prefix, rooms] : doors)
          if (name.rfind(prefix, 0) == 0)
            CHECK_MESSAGE(rooms.count(room) == 1, file.string(), " includes ", name);
}
