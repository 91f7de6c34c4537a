#include "import/gltf/gltf_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "import/json_location.h"

namespace troffer {

using Json = nlohmann::json;

namespace {

// Extracts REASON from "[json.exception.parse_error.101] parse error at line 1, column 2: REASON".
std::string reason_of(const std::string& what) {
  const size_t column = what.find("column ");
  const size_t colon = what.find(": ", column == std::string::npos ? what.find("] ") : column);
  return colon == std::string::npos ? what : what.substr(colon + 2);
}

std::string without_control_characters(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  return text;
}

// Returns the position of a number that overflows. The parser reports only "number overflow parsing
// '1e999'", so the number is searched for in the text.
TextPosition position_of_overflow(const std::string& text, const std::string& what) {
  const size_t first = what.find('\''), last = what.rfind('\'');
  if (first == std::string::npos || last <= first + 1) return {};
  const size_t at = text.find(what.substr(first + 1, last - first - 1));
  return position_of_offset(text, at == std::string::npos ? 0 : at);
}

const char* type_in_words(const Json& value) {
  switch (value.type()) {
    case Json::value_t::null:
      return "null";
    case Json::value_t::object:
      return "an object";
    case Json::value_t::array:
      return "an array";
    case Json::value_t::string:
      return "a string";
    case Json::value_t::boolean:
      return "a boolean";
    default:
      return "a number";
  }
}

std::string expected(const char* type, const Json& value) {
  return std::string("should be ") + type + ", is " + type_in_words(value);
}

}  // namespace

std::string printable(std::string_view text) {
  constexpr size_t longest = 100;
  std::string out(text.substr(0, longest));
  if (text.size() > longest) {
    // Do not cut inside a UTF-8 sequence.
    while (!out.empty() && (static_cast<unsigned char>(out.back()) & 0xc0) == 0x80) out.pop_back();
    if (!out.empty() && static_cast<unsigned char>(out.back()) >= 0xc0) out.pop_back();
    out += "...";
  }
  return without_control_characters(out);
}

JsonDocument::JsonDocument(std::string file, std::string text, const JsonLimits& limits)
    : file_(std::move(file)), text_(std::move(text)) {
  if (text_.starts_with("\xef\xbb\xbf"))
    throw InputError(file_, 1, 1,
                     "not valid JSON: begins with a byte order mark; save it as UTF-8 without one");
  check_limits(text_, limits, file_);
  try {
    json_ = std::make_unique<Json>(Json::parse(text_));
  } catch (const Json::parse_error& e) {
    // The parser counts bytes from 1 and includes the byte that it rejects.
    const TextPosition at = position_of_offset(text_, e.byte > 0 ? e.byte - 1 : 0);
    throw InputError(file_, at.line, at.column,
                     "not valid JSON: " + without_control_characters(reason_of(e.what())));
  } catch (const Json::exception& e) {
    const TextPosition at = position_of_overflow(text_, e.what());
    throw InputError(file_, at.line, at.column, "not valid JSON: a number is too large");
  }
}

JsonDocument::~JsonDocument() = default;

JsonNode JsonDocument::root() const {
  return JsonNode(*this, *json_, "");
}

void JsonNode::fail(const std::string& what) const {
  const TextPosition at = position_of_json_value(document_->text(), pointer_);
  const std::string subject = pointer_.empty() ? "the document" : printable(pointer_);
  throw InputError(document_->file(), at.line, at.column, subject + ": " + what);
}

JsonNode JsonNode::below(const Json& value, std::string_view token) const {
  std::string pointer = pointer_ + '/';
  for (const char c : token) {
    if (c == '~')
      pointer += "~0";
    else if (c == '/')
      pointer += "~1";
    else
      pointer += c;
  }
  return JsonNode(*document_, value, std::move(pointer));
}

const std::string& JsonNode::file() const {
  return document_->file();
}
bool JsonNode::is_object() const {
  return value_->is_object();
}
bool JsonNode::is_array() const {
  return value_->is_array();
}

bool JsonNode::is_string() const {
  return value_->is_string();
}

std::optional<JsonNode> JsonNode::find(std::string_view key) const {
  if (!value_->is_object()) fail(expected("an object", *value_));
  const auto it = value_->find(std::string(key));
  if (it == value_->end()) return std::nullopt;
  return below(*it, key);
}

std::optional<JsonNode> JsonNode::find_value(std::string_view key) const {
  std::optional<JsonNode> found = find(key);
  if (found && found->value_->is_null()) found.reset();
  return found;
}

JsonNode JsonNode::member(std::string_view key) const {
  std::optional<JsonNode> found = find(key);
  if (!found) fail("has no '" + std::string(key) + "'");
  return *found;
}

std::vector<std::string> JsonNode::keys() const {
  if (!value_->is_object()) fail(expected("an object", *value_));
  std::vector<std::string> names;
  for (const auto& item : value_->items()) names.push_back(item.key());
  return names;
}

size_t JsonNode::size() const {
  if (!value_->is_array()) fail(expected("an array", *value_));
  return value_->size();
}

JsonNode JsonNode::element(size_t i) const {
  if (i >= size()) fail("has no element " + std::to_string(i));
  return below((*value_)[i], std::to_string(i));
}

const std::string& JsonNode::as_string() const {
  if (!value_->is_string()) fail(expected("a string", *value_));
  return value_->get_ref<const std::string&>();
}

bool JsonNode::as_bool() const {
  if (!value_->is_boolean()) fail(expected("true or false", *value_));
  return value_->get<bool>();
}

double JsonNode::as_number() const {
  if (!value_->is_number()) fail(expected("a number", *value_));
  const double number = value_->get<double>();
  if (!std::isfinite(number)) fail("is not a finite number");
  return number;
}

uint64_t JsonNode::as_integer(uint64_t max) const {
  if (!value_->is_number()) fail(expected("an integer", *value_));
  uint64_t integer = 0;
  if (value_->is_number_unsigned()) {
    integer = value_->get<uint64_t>();
  } else {
    const double number = as_number();
    if (number != std::floor(number)) fail("should be an integer, is a fraction");
    if (number < 0) fail("must not be negative");
    if (number > 9e15) fail("is too large");  // near 2^53, above which doubles skip integers
    integer = uint64_t(number);
  }
  if (integer > max)
    fail("is " + std::to_string(integer) + ", more than the allowed " + std::to_string(max));
  return integer;
}

uint32_t JsonNode::as_index(size_t count, const char* things) const {
  const uint64_t i = as_integer(~uint64_t(0));
  if (i >= count || i > 0xffffffffu)
    fail("names " + std::string(things) + " " + std::to_string(i) + ", but " +
         (count == 0 ? "the file has none" : "there are only " + std::to_string(count)));
  return uint32_t(i);
}

std::vector<double> JsonNode::as_numbers(size_t count) const {
  if (size() != count)
    fail("should have " + std::to_string(count) + " numbers, has " + std::to_string(size()));
  std::vector<double> numbers;
  for (size_t i = 0; i < count; ++i) numbers.push_back(element(i).as_number());
  return numbers;
}

std::string JsonNode::string_or(std::string_view key, std::string fallback) const {
  const auto found = find(key);
  return found ? found->as_string() : fallback;
}
bool JsonNode::bool_or(std::string_view key, bool fallback) const {
  const auto found = find(key);
  return found ? found->as_bool() : fallback;
}
double JsonNode::number_or(std::string_view key, double fallback) const {
  const auto found = find(key);
  return found ? found->as_number() : fallback;
}
uint64_t JsonNode::integer_or(std::string_view key, uint64_t fallback, uint64_t max) const {
  const auto found = find(key);
  return found ? found->as_integer(max) : fallback;
}
std::vector<double> JsonNode::numbers_or(std::string_view key, std::vector<double> fallback) const {
  const auto found = find(key);
  return found ? found->as_numbers(fallback.size()) : fallback;
}

std::optional<JsonNode> JsonNode::extension(std::string_view name) const {
  const auto extensions = find("extensions");
  if (!extensions) return std::nullopt;
  std::optional<JsonNode> found = extensions->find(name);
  if (found && !found->is_object()) found->fail("should be an object");
  return found;
}

}  // namespace troffer
