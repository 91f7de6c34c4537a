// A scene file and its data files are replaced together.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "base/error.h"
#include "export/output_folder.h"
#include "import/temp_folder.h"

using namespace troffer;

namespace {

std::vector<uint8_t> bytes(const std::string& text) {
  return {text.begin(), text.end()};
}

std::string text_of(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

std::set<std::string> names(const TempFolder& folder) {
  std::set<std::string> out;
  for (const auto& e : std::filesystem::directory_iterator(folder.path("s_files")))
    out.insert(e.path().filename().string());
  return out;
}

}  // namespace

TEST_CASE("data of a new file gets names that the previous file does not mention") {
  const TempFolder folder;
  const std::string path = folder.path("s.gltf");
  const auto write = [&](const std::string& data) {
    OutputFolder files(path);
    const std::string name = files.write("data.bin", bytes(data));
    files.finish("uses " + name);
    return name;
  };
  const std::string first = write("one");
  CHECK(first == "s_files/data.bin");
  CHECK(write("one") == first);  // same bytes: nothing to replace
  {
    OutputFolder files(path);
    const std::string other = files.write("data.bin", bytes("two"));
    CHECK(other != first);
    CHECK(text_of(folder.path(first)) == "one");
    CHECK(text_of(path) == "uses " + first);
  }  // not finished: unchanged
  CHECK(names(folder) == std::set<std::string>{"data.bin"});
  const std::string second = write("two");
  CHECK(second != first);
  CHECK(text_of(path) == "uses " + second);
  CHECK(names(folder).size() == 1);  // files that only the old scene used are gone
}

TEST_CASE("data that another file of the same folder uses is kept") {
  const TempFolder folder;
  {
    OutputFolder files(folder.path("s.pbrt"));
    files.finish("uses " + files.write("mesh0.ply", bytes("m")));
  }
  {
    OutputFolder files(folder.path("s.gltf"));
    files.finish("uses " + files.write("mesh0.ply", bytes("other")));
  }
  CHECK(text_of(folder.path("s_files/mesh0.ply")) == "m");
  CHECK(names(folder).size() == 2);
}
