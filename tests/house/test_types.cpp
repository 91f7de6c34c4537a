// Checks the one-definition rule across rooms. The linker treats two types of one name in one
// namespace as one type, whichever room defines them. Compilers see one file at a time and do not
// complain. The program may then run one type's functions on the other's objects.
#include <doctest/doctest.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace fs = std::filesystem;

namespace {

const fs::path root = TROFFER_SOURCE_DIR;

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Length of a literal that begins at text[i], or 0. Raw literals are read as ordinary ones, so they
// must contain no quotation marks.
size_t literal_length(const std::string& text, size_t i) {
  const char quote = text[i];
  if (quote != '"' && quote != '\'') return 0;
  const bool is_separator = quote == '\'' && i > 0 && std::isxdigit(uint8_t(text[i - 1])) != 0;
  if (is_separator) return 0;
  size_t k = i + 1;
  while (k < text.size() && text[k] != quote) k += text[k] == '\\' ? 2 : 1;
  return k + 1 - i;
}

// The code without comments, literals and preprocessor lines.
std::string code_of(const std::string& text) {
  std::string code;
  bool is_at_start = true;  // of a line
  const auto find_end = [&](const char* mark, size_t from) {
    return std::min(text.find(mark, from), text.size());
  };
  for (size_t i = 0; i < text.size();) {
    const size_t literal = literal_length(text, i);
    if (text.compare(i, 2, "//") == 0) {
      i = find_end("\n", i);
    } else if (text.compare(i, 2, "/*") == 0) {
      i = find_end("*/", i) + 2;
    } else if (is_at_start && text[i] == '#') {
      size_t end = find_end("\n", i);
      while (end < text.size() && text[end - 1] == '\\') end = find_end("\n", end + 1);
      i = end;
    } else if (literal > 0) {
      code += "0";
      i += literal;
      is_at_start = false;
    } else {
      if (text[i] == '\n') is_at_start = true;
      if (std::isspace(uint8_t(text[i])) == 0) is_at_start = false;
      code += text[i++];
    }
  }
  return code;
}

std::string with_single_spaces(const std::string& text) {
  static const std::regex spaces("\\s+"), edges("^ | $");
  return std::regex_replace(std::regex_replace(text, spaces, " "), edges, "");
}

// Externally visible definitions of a file: types, and inline functions by their whole heads.
struct Definitions {
  std::vector<std::string> types, functions;
};

Definitions definitions_in(const std::string& code) {
  static const std::regex space("(?:inline )?namespace ?([\\w:]*)");
  static const std::regex type(
      "(?:template ?<.*> ?)?(?:struct|class|union|enum|enum class|enum struct)"
      "(?: alignas\\(\\w+\\))? ([\\w:]+)(?: final)?(?: ?: ?[^:(].*)?");
  static const std::regex function("(?:.* )?(?:inline|constexpr) .*\\(.*");
  Definitions found;
  // namespace or type of each open brace; "" if invisible to other files
  std::vector<std::string> open;
  size_t start = 0;
  for (size_t i = 0; i < code.size(); ++i) {
    if (code[i] == ';') start = i + 1;
    if (code[i] == '{') {
      const std::string head = with_single_spaces(code.substr(start, i - start));
      std::smatch match;
      std::string inside;
      if (std::regex_match(head, match, space)) {
        inside = match[1];
      } else if (std::find(open.begin(), open.end(), "") == open.end()) {
        std::string within;
        for (const std::string& name : open) within += name + "::";
        if (std::regex_match(head, match, type))
          found.types.push_back(within + match[1].str());
        else if (std::regex_match(head, function))
          found.functions.push_back(within + head);
      }
      open.push_back(inside);
      start = i + 1;
    }
    if (code[i] == '}') {
      if (!open.empty()) open.pop_back();
      start = i + 1;
    }
  }
  return found;
}

using FilesOf = std::map<std::string, std::set<std::string>>;

void check_that_each_has_one_file(const FilesOf& files_of) {
  for (const auto& [name, files] : files_of) {
    std::string list;
    for (const std::string& file : files) list += file + " ";
    INFO(name, " is defined in ", list);
    CHECK(files.size() == 1);
  }
}

}  // namespace

TEST_CASE("definitions are found only where other files can see them") {
  const Definitions d = definitions_in(code_of(
      "// struct Comment {\n#define S struct Macro {\n"
      "namespace a {\nnamespace {\nstruct Hidden { int x; };\n}\n"
      "struct Seen final : Base { struct Nested { char c = '{'; }; };\n"
      "template <class T>\nclass Box {};\nenum class Kind : unsigned char { one };\n"
      "struct Seen::Own { int x = 1'000; };\nclass Declared;\nstruct Seen make();\n"
      "inline int twice(int x) { return 2 * x; }\nconst char* text = \"struct Text {\";\n}\n"));
  CHECK(d.types == std::vector<std::string>{"a::Seen", "a::Box", "a::Kind", "a::Seen::Own"});
  CHECK(d.functions == std::vector<std::string>{"a::inline int twice(int x)"});
}

TEST_CASE("no two types share a name, and no two inline functions a signature") {
  FilesOf types, functions;
  for (const auto& entry : fs::recursive_directory_iterator(root / "src")) {
    const std::string ending = entry.path().extension().string();
    if (ending != ".h" && ending != ".cpp") continue;
    const std::string name = fs::relative(entry.path(), root).generic_string();
    const Definitions d = definitions_in(code_of(text_of(entry.path())));
    for (const std::string& t : d.types) types[t].insert(name);
    for (const std::string& f : d.functions) functions[f].insert(name);
  }
  CHECK(types.size() > 500);
  CHECK(functions.size() > 100);
  check_that_each_has_one_file(types);
  check_that_each_has_one_file(functions);
}
