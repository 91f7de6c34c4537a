// Parser of function files (part of CalProgram).
#include <charconv>

#include "import/radiance/radiance_cal.h"

namespace troffer {

namespace {

constexpr int max_nesting = 200;
constexpr size_t most_program_nodes = 2'000'000;

bool is_name_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '`';
}
bool is_name_digit(char c) {
  return c >= '0' && c <= '9';
}
bool is_of_name(char c) {
  return is_name_letter(c) || is_name_digit(c) || c == '_' || c == '.';
}

}  // namespace

// Recursive-descent parser of the grammar in [1]: sums of products of powers. A sign binds tighter
// than a power.
class CalParser {
 public:
  CalParser(CalProgram& program, std::string_view text, std::shared_ptr<const std::string> file,
            const SourcePlace* fixed)
      : program_(program), text_(text), file_(std::move(file)), fixed_(fixed) {}

  void definitions();
  int32_t whole_expression();

 private:
  CalProgram& program_;
  std::string_view text_;
  std::shared_ptr<const std::string> file_;
  const SourcePlace* fixed_;  // place of the whole text; null if the text is a file
  size_t at_ = 0;
  int nesting_ = 0;
  std::vector<std::string> parameters_;

  [[noreturn]] void fail(const std::string& what) const;
  char peek();
  bool take(char c);
  void expect(char c);
  std::string name();
  void definition();
  int32_t add(CalNode node);
  int32_t two(CalOp op, int32_t a, int32_t b) { return add({op, 0, 0, {a, b}}); }
  int32_t sum();
  int32_t product();
  int32_t power();
  int32_t signed_value();
  int32_t single();
  int32_t number();
  int32_t named();
};

void CalParser::fail(const std::string& what) const {
  if (fixed_ != nullptr) fixed_->fail("'" + shortened(std::string(text_)) + "': " + what);
  SourcePlace place{file_, 1, 1};
  for (size_t i = 0; i < at_ && i < text_.size(); ++i) {
    ++place.column;
    if (text_[i] != '\n') continue;
    ++place.line;
    place.column = 1;
  }
  place.fail(what);
}

// Next character outside blanks and comments; '\0' at the end.
char CalParser::peek() {
  for (int open = 0; at_ < text_.size(); ++at_) {
    const char c = text_[at_];
    if (c == '{') {
      ++open;
    } else if (open > 0) {
      open -= c == '}' ? 1 : 0;
    } else if (c != ' ' && c != '\t' && c != '\n' && c != '\r' && c != '\f') {
      return c;
    }
  }
  return '\0';
}

bool CalParser::take(char c) {
  if (peek() != c) return false;
  ++at_;
  return true;
}

void CalParser::expect(char c) {
  if (!take(c)) fail(std::string("'") + c + "' expected");
}

std::string CalParser::name() {
  if (!is_name_letter(peek())) fail("a name expected");
  const size_t begin = at_;
  while (at_ < text_.size() && is_of_name(text_[at_])) ++at_;
  return std::string(text_.substr(begin, at_ - begin));
}

int32_t CalParser::add(CalNode node) {
  if (program_.nodes_.size() >= most_program_nodes) fail("the function files are too large");
  program_.nodes_.push_back(std::move(node));
  return int32_t(program_.nodes_.size()) - 1;
}

int32_t CalParser::sum() {
  if (++nesting_ > max_nesting) fail("parentheses are nested too deeply");
  int32_t left = product();
  while (peek() == '+' || peek() == '-') {
    const CalOp op = text_[at_++] == '+' ? CalOp::add : CalOp::subtract;
    left = two(op, left, product());
  }
  --nesting_;
  return left;
}

int32_t CalParser::product() {
  int32_t left = power();
  while (peek() == '*' || peek() == '/') {
    const CalOp op = text_[at_++] == '*' ? CalOp::multiply : CalOp::divide;
    left = two(op, left, power());
  }
  return left;
}

int32_t CalParser::power() {
  const int32_t base = signed_value();
  if (!take('^')) return base;
  if (++nesting_ > max_nesting) fail("powers are nested too deeply");
  const int32_t exponent = power();
  --nesting_;
  return two(CalOp::power, base, exponent);
}

int32_t CalParser::signed_value() {
  if (take('-')) return add({CalOp::negate, 0, 0, {single()}});
  take('+');
  return single();
}

int32_t CalParser::single() {
  const char c = peek();
  if (take('(')) {
    const int32_t inside = sum();
    expect(')');
    return inside;
  }
  if (is_name_digit(c) || c == '.') return number();
  if (is_name_letter(c)) return named();
  fail(c == '\0' ? "an expression ends early" : "a number, a name or '(' expected");
}

int32_t CalParser::number() {
  double value = 0;
  const auto r = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
  if (r.ec != std::errc()) fail("this is not a number");
  at_ = size_t(r.ptr - text_.data());
  return add({CalOp::number, value, 0, {}});
}

int32_t CalParser::named() {
  const std::string word = name();
  int32_t parameter = -1;
  for (size_t i = 0; i < parameters_.size(); ++i)
    if (parameters_[i] == word) parameter = int32_t(i);
  if (!take('(')) {
    if (parameter >= 0) return add({CalOp::parameter, 0, parameter, {}});
    return add({CalOp::name, 0, program_.name_index(word), {}});
  }
  CalNode call{CalOp::call, 0, parameter >= 0 ? ~parameter : program_.name_index(word), {}};
  do call.children.push_back(sum());
  while (take(','));
  expect(')');
  return add(std::move(call));
}

// Parses NAME = expression or NAME(a,b) : expression. Outputs ($1 = expression) are parsed and
// dropped.
void CalParser::definition() {
  parameters_.clear();
  const bool is_output = take('$');
  if (is_output) {
    while (at_ < text_.size() && is_name_digit(text_[at_])) ++at_;
    expect('=');
    sum();
    return;
  }
  const std::string defined = name();
  const bool is_function = take('(');
  if (is_function) {
    do parameters_.push_back(name());
    while (take(','));
    expect(')');
  }
  if (!take('=')) expect(':');
  const int32_t body = sum();
  CalProgram::Definition& d = program_.names_[size_t(program_.name_index(defined))];
  d.parameters = parameters_;
  d.body = body;
  d.is_function = is_function;
  d.clock = 0;
}

void CalParser::definitions() {
  while (peek() != '\0') {
    if (take(';')) continue;
    definition();
    if (peek() != '\0') expect(';');
  }
}

int32_t CalParser::whole_expression() {
  const int32_t e = sum();
  if (peek() != '\0') fail("unexpected text after the expression");
  return e;
}

int32_t CalProgram::name_index(std::string_view name) {
  const auto found = index_of_name_.find(name);
  if (found != index_of_name_.end()) return found->second;
  const auto index = int32_t(names_.size());
  names_.emplace_back().name = std::string(name);
  index_of_name_.emplace(std::string(name), index);
  return index;
}

void CalProgram::read(std::shared_ptr<const std::string> file, std::string_view text) {
  CalParser(*this, text, std::move(file), nullptr).definitions();
}

int32_t CalProgram::expression(std::string_view text, const SourcePlace& place) {
  return CalParser(*this, text, place.file, &place).whole_expression();
}

}  // namespace troffer
