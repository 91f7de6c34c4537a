// JSON documents, read through typed getters. A value of the wrong type or out of range throws
// InputError with the value's line and column. Used by the importer of glTF and by other readers of
// JSON. No other header of this folder includes the JSON library.
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

// A value inside a document, with its JSON pointer. Valid as long as its document.
class JsonNode {
 public:
  bool is_object() const;
  bool is_array() const;
  bool is_string() const;
  // JSON pointer of the value, for example "/accessors/3/count".
  const std::string& pointer() const { return pointer_; }
  // Path of the file that the document was read from.
  const std::string& file() const;

  // Members of an object. Each function fails if this value is not an object.
  std::optional<JsonNode> find(std::string_view key) const;
  JsonNode member(std::string_view key) const;  // fails if it is missing
  // Like find(), but takes null as missing.
  std::optional<JsonNode> find_value(std::string_view key) const;
  std::vector<std::string> keys() const;

  // Elements of an array. Each function fails if this value is not an array.
  size_t size() const;
  JsonNode element(size_t i) const;

  // Return the value; fail if it has another type. Numbers are finite. An integer lies in [0, max].
  // An index is below `count`, the number of `things` (a plural noun for the message).
  const std::string& as_string() const;
  bool as_bool() const;
  double as_number() const;
  uint64_t as_integer(uint64_t max) const;
  uint32_t as_index(size_t count, const char* things) const;
  std::vector<double> as_numbers(size_t count) const;

  // Return a member's value, or `fallback` if the member is missing.
  std::string string_or(std::string_view key, std::string fallback) const;
  bool bool_or(std::string_view key, bool fallback) const;
  double number_or(std::string_view key, double fallback) const;
  uint64_t integer_or(std::string_view key, uint64_t fallback, uint64_t max) const;
  std::vector<double> numbers_or(std::string_view key, std::vector<double> fallback) const;

  // Returns the object /extensions/NAME of this object, if it is there.
  std::optional<JsonNode> extension(std::string_view name) const;

  // Throws InputError{file, line and column of this value, "POINTER: what"}.
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

// A parsed JSON text. It must outlive its nodes.
class JsonDocument {
 public:
  // Parses `text` (UTF-8 without a byte order mark). Throws InputError at the position of a syntax
  // error, or where `limits` are exceeded; limits are checked before memory is allocated.
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

// Returns text from a file in a form that fits a one-line message: control characters become '?',
// and text longer than 100 bytes is cut.
std::string printable(std::string_view text);

}  // namespace troffer
