// The registry of random streams (src/base/streams.h) against the code: purposes are distinct, each
// has one user, and there is no purpose outside the registry.
#include <doctest/doctest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace fs = std::filesystem;

namespace {

const fs::path source_folder = fs::path(TROFFER_SOURCE_DIR) / "src";

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

struct Purpose {
  std::string name;
  uint64_t first = 0, last = 0;  // values that it may take
};

std::vector<Purpose> registry() {
  const std::string text = text_of(source_folder / "base" / "streams.h");
  const std::regex line(R"(constexpr uint64_t (\w+) = 0x([0-9a-f']+);([^\n]*))");
  std::vector<Purpose> all;
  for (std::sregex_iterator i(text.begin(), text.end(), line), end; i != end; ++i) {
    std::string digits;
    for (const char c : (*i)[2].str())
      if (c != '\'') digits += c;
    const uint64_t value = std::stoull(digits, nullptr, 16);
    const bool is_range = (*i)[3].str().find("+ an index under 2^16") != std::string::npos;
    all.push_back({(*i)[1].str(), value, is_range ? value + 0xffff : value});
  }
  return all;
}

}  // namespace

TEST_CASE("purposes of random streams are distinct") {
  const std::vector<Purpose> all = registry();
  REQUIRE(all.size() > 30);
  for (size_t i = 0; i < all.size(); ++i)
    for (size_t k = i + 1; k < all.size(); ++k)
      CHECK_MESSAGE((all[i].last < all[k].first || all[k].last < all[i].first), all[i].name,
                    " meets ", all[k].name);
}

TEST_CASE("each purpose of the registry has one user, and there is none outside it") {
  std::map<std::string, std::set<std::string>> users;
  for (const Purpose& p : registry()) users[p.name];
  const std::regex use(R"(stream::(\w+))"), tag(R"(0x[0-9a-f]{4}'[0-9a-f]{4})");
  for (const auto& entry : fs::recursive_directory_iterator(source_folder)) {
    const std::string extension = entry.path().extension().string();
    if ((extension != ".cpp" && extension != ".h") || entry.path().filename() == "streams.h")
      continue;
    const std::string text = text_of(entry.path());
    const std::string file = fs::relative(entry.path(), source_folder).string();
    for (std::sregex_iterator i(text.begin(), text.end(), use), end; i != end; ++i) {
      CHECK_MESSAGE(users.count((*i)[1].str()) == 1, file, " uses ", (*i)[0].str(),
                    ", which is not registered");
      users[(*i)[1].str()].insert(file);
    }
    if (file.rfind("import/", 0) == 0 || file == "transport/purposes.h") continue;
    std::smatch found;
    CHECK_MESSAGE(!std::regex_search(text, found, tag), file,
                  " has a purpose that is not registered: ", found.str());
  }
  for (const auto& [name, files] : users)
    CHECK_MESSAGE(files.size() == 1, name, " has ", files.size(), " users");
}
