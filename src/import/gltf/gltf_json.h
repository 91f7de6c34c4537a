// A JSON document read through typed getters: whatever is not as it should be throws InputError
// with the line and column of the value. The only door to the JSON library in this room.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "import/json_limits.h"

namespace troffer {

class JsonDocument;

// A value inside a document, and the way to it. Valid as long as its document.
class JsonNode {
 public:
  bool is_object() const;
  bool is_array() const;
  // "/accessors/3/count"
  const std::string& pointer() const { return pointer_; }
  // The file that the document was read from.
  const std::string& file() const;

  // Members of an object; each fails where this is no object.
  std::optional<JsonNode> find(std::string_view key) const;
  JsonNode member(std::string_view key) const;  // fails where it is missing
  std::vector<std::string> keys() const;

  // Elements of an array; each fails where this is no array.
  size_t size() const;
  JsonNode element(size_t i) const;

  // The value, or failure where it is of another type. Numbers are finite; an integer lies in
  // [0, max]; an index is below `count`, the number of `things`.
  const std::string& as_string() const;
  bool as_bool() const;
  double as_number() const;
  uint64_t as_integer(uint64_t max) const;
  uint32_t as_index(size_t count, const char* things) const;
  std::vector<double> as_numbers(size_t count) const;

  // Members with defaults.
  std::string string_or(std::string_view key, std::string fallback) const;
  bool bool_or(std::string_view key, bool fallback) const;
  double number_or(std::string_view key, double fallback) const;
  uint64_t integer_or(std::string_view key, uint64_t fallback, uint64_t max) const;
  std::vector<double> numbers_or(std::string_view key, std::vector<double> fallback) const;

  // The object /extensions/NAME of this object.
  std::optional<JsonNode> extension(std::string_view name) const;

  // Throws InputError{file, line, column of this value, "POINTER: what"}.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  friend class JsonDocument;
  JsonNode(const JsonDocument& document, const nlohmann::json& value, std::string pointer)
      : document_(&document), value_(&value), pointer_(std::move(pointer)) {}
  JsonNode below(const nlohmann::json& value, std::string_view token) const;

  const JsonDocument* document_;
  const nlohmann::json* value_;
  std::string pointer_;
};

class JsonDocument {
 public:
  // Parses `text` (UTF-8 without byte order mark); a syntax error throws InputError at its place,
  // and so does more than the limits allow, before memory is taken for it.
  JsonDocument(std::string file, std::string text, const JsonLimits& limits = {});
  ~JsonDocument();
  JsonDocument(const JsonDocument&) = delete;
  JsonDocument& operator=(const JsonDocument&) = delete;

  JsonNode root() const;
  const std::string& file() const { return file_; }
  const std::string& text() const { return text_; }

 private:
  std::string file_, text_;
  std::unique_ptr<nlohmann::json> json_;
};

// Text of a file as it may stand in a one-line message: control characters become '?', and what
// is longer than 100 bytes is cut.
std::string printable(std::string_view text);

}  // namespace troffer
