// Size limits of the code: functions have at most 60 lines and files at most 400. Classes have at
// most 12 data members, unless the comment directly above has the word "members". Plain data such
// as option rows and file records is exempt. The text is analysed by braces and semicolons, after
// comments, literals and preprocessor lines are blanked.
#include <doctest/doctest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

namespace fs = std::filesystem;

namespace {

const fs::path root = TROFFER_SOURCE_DIR;
constexpr size_t most_function_lines = 60, most_members = 12, most_file_lines = 400;

struct Function {
  std::string head;
  size_t line = 0, lines = 0;
};

struct Class {
  std::string head, comment;  // comment: the comment lines directly above
  size_t line = 0, members = 0;
  bool is_data = true;  // no member name ends in _
};

struct Sizes {
  std::vector<Function> functions;
  std::vector<Class> classes;
  bool is_balanced = false;
};

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

// End of the literal, comment or preprocessor line that begins at i; i if none does.
size_t end_of_blank(std::string_view t, size_t i) {
  const auto after = [&](std::string_view end, size_t from) {
    const size_t at = t.find(end, from);
    return at == std::string_view::npos ? t.size() : at + end.size();
  };
  const bool is_after_word = i > 0 && is_word(t[i - 1]);
  if (t.substr(i, 2) == "//") return std::min(t.find('\n', i), t.size());
  if (t.substr(i, 2) == "/*") return after("*/", i + 2);
  if (t.substr(i, 2) == "R\"" && !is_after_word) {
    const size_t open = t.find('(', i);
    return after(")" + std::string(t.substr(i + 2, open - i - 2)) + "\"", open);
  }
  if (t[i] == '"' || (t[i] == '\'' && !is_after_word)) {  // not the ' in 60'000
    size_t end = i + 1;
    while (end < t.size() && t[end] != t[i]) end += t[end] == '\\' ? 2 : 1;
    return std::min(end + 1, t.size());
  }
  const size_t text = t.find_last_not_of(" \t", i == 0 ? 0 : i - 1);
  if (t[i] == '#' && (i == 0 || text == std::string_view::npos || t[text] == '\n')) {
    size_t end = t.find('\n', i);
    while (end < t.size() && t[end - 1] == '\\') end = t.find('\n', end + 1);
    return std::min(end, t.size());
  }
  return i;
}

// The text with all of these blanked; line breaks stay.
std::string code_of(std::string_view text) {
  std::string code(text);
  for (size_t i = 0; i < text.size();) {
    const size_t end = end_of_blank(text, i);
    for (size_t k = i; k < end; ++k)
      if (code[k] != '\n') code[k] = ' ';
    i = std::max(end, i + 1);
  }
  return code;
}

// Outline of a declaration without parts that could be misread. Drops the content of brackets and
// keeps outer parentheses as "()". Drops attributes with parentheses and access specifiers.
std::string outline(std::string_view head) {
  static const std::regex aside(
      R"(\b(alignas|decltype|__attribute__|noexcept|requires)\s*\([^;{]*?\)+)");
  static const std::regex access(R"(\b(public|protected|private)\s*:(?!:))");
  const std::string text =
      std::regex_replace(std::regex_replace(std::string(head), access, " "), aside, " @ ");
  std::string out, open;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool is_arrow = c == '>' && i > 0 && (text[i - 1] == '-' || text[i - 1] == '=');
    // a comparison has blanks around it
    const bool is_angle =
        c == '<' && i > 0 && i + 1 < text.size() &&
        (out.ends_with("template ") ||
         (is_word(text[i - 1]) && text[i + 1] != ' ' && !out.ends_with("operator")));
    if (std::string_view("([{").find(c) != std::string_view::npos || is_angle) {
      if (open.empty() && c == '(') out += text.compare(i, 2, "(*") == 0 ? "(*)" : "()";
      open += c;
    } else if (!open.empty() && (c == ')' || c == ']' || c == '}' ||
                                 (c == '>' && !is_arrow && open.back() == '<'))) {
      open.pop_back();
    } else if (open.empty()) {
      out += c;
    }
  }
  const size_t from = out.find_first_not_of(" \n\t@");
  return from == std::string::npos ? "" : out.substr(from);
}

bool begins_with_word(const std::string& text, std::initializer_list<std::string_view> words) {
  return std::any_of(words.begin(), words.end(), [&](std::string_view w) {
    return text.compare(0, w.size(), w) == 0 &&
           (text.size() == w.size() || !is_word(text[w.size()]));
  });
}

// Number of data members that a declaration in a class makes. It ends with its semicolon.
// `has_type`: a class or enumeration defined in it has been taken out.
size_t members_of(std::string_view declaration, bool has_type) {
  std::string text = outline(declaration);
  if (begins_with_word(text, {"using", "typedef", "friend", "static", "static_assert", "template",
                              "constexpr", "inline"}))
    return 0;
  if (!has_type && begins_with_word(text, {"struct", "class", "union", "enum"})) return 0;
  const std::string declared = text.substr(0, text.find('='));
  if (declared.find_first_not_of(" \n") == std::string::npos) return 0;
  if (declared.find("(*)") != std::string::npos) return 1;  // a pointer to a function
  if (declared.find("()") != std::string::npos || declared.find("operator") != std::string::npos)
    return 0;
  return 1 + size_t(std::count(text.begin(), text.end(), ','));
}

// True if the declaration has a member whose name ends in _.
bool has_own_member(std::string_view declaration) {
  static const std::regex own(R"(\w_(?!\w))");
  const std::string text = outline(declaration);
  return std::regex_search(text, own);
}

enum class Block { space, type, enumeration, function, other };

// Kind of block that the brace after `head` opens.
Block block_of(std::string_view head, Block around) {
  std::string text = outline(head);
  if (begins_with_word(text, {"template"})) text = outline(std::string_view(text).substr(8));
  if (begins_with_word(text, {"namespace", "extern", "inline namespace"}) &&
      text.find("()") == std::string::npos)
    return Block::space;
  const size_t call = text.find("()");
  if (begins_with_word(text, {"struct", "class", "union"}) && call == std::string::npos &&
      text.find('=') == std::string::npos)
    return Block::type;
  if (begins_with_word(text, {"enum"})) return Block::enumeration;
  const size_t equals = text.find('=');
  const bool is_initialiser = equals < call && text.find("operator") == std::string::npos;
  const bool is_inside = around == Block::space || around == Block::type;
  return is_inside && call != std::string::npos && !is_initialiser ? Block::function : Block::other;
}

class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text), code_(code_of(text)) {}
  Sizes read();

 private:
  struct Open {
    Block block;
    size_t head;   // start of the declaration that the block belongs to
    size_t index;  // index of the function or class
    size_t parentheses;
  };
  std::string_view text_;
  std::string code_;
  Sizes sizes_;
  std::vector<Open> open_;
  size_t head_ = 0;  // start of the current declaration
  size_t parentheses_ = 0;
  bool has_type_ = false;

  Block around() const { return open_.empty() ? Block::space : open_.back().block; }
  size_t line_of(size_t at) const {
    return 1 + size_t(std::count(code_.begin(), code_.begin() + std::ptrdiff_t(at), '\n'));
  }
  std::string_view head(size_t end) const {
    return std::string_view(code_).substr(head_, end - head_);
  }
  void begin_after(size_t at) {
    head_ = std::min(code_.find_first_not_of(" \n", at + 1), code_.size());
    has_type_ = false;
  }
  std::string comment_above(size_t at) const;
  void open(size_t at);
  void close(size_t at);
};

std::string Reader::comment_above(size_t at) const {
  size_t from = text_.rfind('\n', at) + 1;
  const size_t end = from;
  while (from > 1) {
    const size_t above = text_.rfind('\n', from - 2) + 1;
    const size_t first = text_.find_first_not_of(' ', above);
    if (text_.substr(first, 2) != "//") break;
    from = above;
  }
  return std::string(text_.substr(from, end - from));
}

void Reader::open(size_t at) {
  // `public:` is not part of the declaration that follows
  static const std::regex access(R"((public|protected|private)\s*:(?!:)\s*)");
  std::match_results<std::string::const_iterator> found;
  while (std::regex_search(code_.cbegin() + std::ptrdiff_t(head_),
                           code_.cbegin() + std::ptrdiff_t(at), found, access,
                           std::regex_constants::match_continuous))
    head_ += size_t(found.length());
  const Block block = parentheses_ > 0 ? Block::other : block_of(head(at), around());
  Open o{block, head_, 0, parentheses_};
  const std::string name(head(at).substr(0, head(at).find('\n')));
  if (block == Block::type) {
    o.index = sizes_.classes.size();
    sizes_.classes.push_back({name, comment_above(head_), line_of(head_), 0});
  } else if (block == Block::function) {
    o.index = sizes_.functions.size();
    sizes_.functions.push_back({name, line_of(head_), 0});
  }
  open_.push_back(o);
  parentheses_ = 0;
  begin_after(at);
}

void Reader::close(size_t at) {
  const Open o = open_.back();
  open_.pop_back();
  parentheses_ = o.parentheses;
  if (o.block == Block::function) {
    const size_t next = code_.find_first_not_of(" \n", at + 1);
    if (next < code_.size() && (code_[next] == ',' || code_[next] == '{')) {
      // Foo::Foo() : a_{1}, b_{2} {}: the body is still to come
      sizes_.functions.erase(sizes_.functions.begin() + std::ptrdiff_t(o.index));
      head_ = o.head;
      return;
    }
    Function& f = sizes_.functions[o.index];
    f.lines = line_of(at) + 1 - f.line;
  } else if (o.block == Block::other && (around() == Block::space || around() == Block::type)) {
    head_ = o.head;  // an initialiser within a declaration
    return;
  }
  begin_after(at);
  has_type_ = o.block == Block::type || o.block == Block::enumeration;
}

Sizes Reader::read() {
  begin_after(size_t(-1));
  for (size_t i = 0; i < code_.size(); ++i) {
    const char c = code_[i];
    if (c == '(') ++parentheses_;
    if (c == ')' && parentheses_ > 0) --parentheses_;
    if (c == '{') open(i);
    if (c == '}') {
      if (open_.empty()) return sizes_;
      close(i);
    }
    if (c == ';' && parentheses_ == 0) {
      if (around() == Block::type) {
        Class& type = sizes_.classes[open_.back().index];
        const size_t members = members_of(head(i), has_type_);
        type.members += members;
        if (members > 0 && has_own_member(head(i))) type.is_data = false;
      }
      begin_after(i);
    }
  }
  sizes_.is_balanced = open_.empty();
  return sizes_;
}

Sizes sizes_of(std::string_view text) {
  return Reader(text).read();
}

}  // namespace

TEST_CASE("functions, classes and members are counted in a text") {
  const Sizes s = sizes_of(R"text(#define OPEN { \
  {
// A table.
struct Table : Base<int(float)> {
  static constexpr int size = 3;  // }
  using Row = std::array<float, 4>;
  enum class Kind { a, b };
  struct Cell {
    int x = f(1), y[2][3] = {{1, 2}, {3}}, z{};
  } corner;
  alignas(64) std::map<std::string, std::vector<int>> names{{"{", {1}}};
  char c = '{', d = '"';
  std::function<void(int, int)> f;
  decltype(&other) kernel;
  bool (*less)(int, int) = nullptr;
  Table() : names{}, c{'}'} { }
  explicit Table(int a = 60'000);
  bool operator<(const Table&) const { return 1 < 2; }
  Table& operator=(const Table&) = default;
};
const std::map<int, Table> tables = {{1, {}}, {2, {}}};
template <class A, class B = std::less<A>>
inline __attribute__((always_inline)) auto run(const A& a) -> decltype(a.x) {
  const auto inner = [&](int i) { return i; };
  if (a < B{} && a > inner({})) { OPEN }
  return a.x; /* { */
}
namespace {
class Alone {
 public:
  Alone();
 private:
  int a_ = 0, b_ = 0;
};
}
)text");
  CHECK(s.is_balanced);
  REQUIRE(s.classes.size() == 3);
  CHECK(s.classes[0].members == 7);
  CHECK(s.classes[0].line == 4);
  CHECK(s.classes[0].comment == "// A table.\n");
  CHECK(s.classes[1].members == 3);
  CHECK(s.classes[2].members == 2);
  CHECK(s.classes[0].is_data);
  CHECK_FALSE(s.classes[2].is_data);
  REQUIRE(s.functions.size() == 3);
  CHECK(s.functions[0].line == 16);
  CHECK(s.functions[0].lines == 1);
  CHECK(s.functions[2].lines == 6);
}

TEST_CASE("the lines of a long function are counted") {
  for (const size_t lines : {60, 61}) {
    std::string text = "int f(int a) {\n";
    for (size_t i = 2; i < lines; ++i) text += "  a += 1;\n";
    const Sizes s = sizes_of("int g();\n" + text + "}\n");
    REQUIRE(s.functions.size() == 1);
    CHECK(s.functions[0].lines == lines);
    CHECK(s.functions[0].line == 2);
  }
}

TEST_CASE("functions, classes and files of src/ keep the size limits") {
  size_t files = 0, functions = 0, classes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(root / "src")) {
    const fs::path& file = entry.path();
    if (file.extension() != ".h" && file.extension() != ".cpp") continue;
    std::ifstream in(file);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    const Sizes sizes = sizes_of(text);
    const std::string name = fs::relative(file, root).generic_string();
    CHECK_MESSAGE(sizes.is_balanced, name);
    ++files;
    functions += sizes.functions.size();
    classes += sizes.classes.size();
    for (const Function& f : sizes.functions)
      CHECK_MESSAGE(f.lines <= most_function_lines, name, ":", f.line, ": ", f.head);
    CHECK_MESSAGE(std::count(text.begin(), text.end(), '\n') <= most_file_lines, name);
    for (const Class& c : sizes.classes)
      if (!c.is_data && c.comment.find("members") == std::string::npos)
        CHECK_MESSAGE(c.members <= most_members, name, ":", c.line, ": ", c.head);
  }
  CHECK(files > 100);
  CHECK(functions > 1000);
  CHECK(classes > 200);
}
