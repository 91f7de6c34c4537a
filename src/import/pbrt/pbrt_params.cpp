#include "import/pbrt/pbrt_params.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace troffer {

namespace {

struct TypeRow {
  std::string_view word;
  PbrtType type;
};
// Type names that a file may use. The first row of each type gives its name in messages.
constexpr std::array type_rows{
    TypeRow{"integer", PbrtType::integer},
    TypeRow{"float", PbrtType::real},
    TypeRow{"point2", PbrtType::point2},
    TypeRow{"vector2", PbrtType::vector2},
    TypeRow{"point3", PbrtType::point3},
    TypeRow{"point", PbrtType::point3},
    TypeRow{"vector3", PbrtType::vector3},
    TypeRow{"vector", PbrtType::vector3},
    TypeRow{"normal", PbrtType::normal},
    TypeRow{"normal3", PbrtType::normal},
    TypeRow{"rgb", PbrtType::rgb},
    TypeRow{"spectrum", PbrtType::spectrum},
    TypeRow{"blackbody", PbrtType::blackbody},
    TypeRow{"bool", PbrtType::boolean},
    TypeRow{"string", PbrtType::string},
    TypeRow{"texture", PbrtType::texture},
};

// Numbers per value of a type.
size_t group_size(PbrtType type) {
  switch (type) {
    case PbrtType::point2:
    case PbrtType::vector2:
      return 2;
    case PbrtType::point3:
    case PbrtType::vector3:
    case PbrtType::normal:
    case PbrtType::rgb:
      return 3;
    default:
      return 1;
  }
}

bool takes_numbers(PbrtType type) {
  return type != PbrtType::boolean && type != PbrtType::string && type != PbrtType::texture;
}
bool takes_strings(PbrtType type) {
  return type == PbrtType::string || type == PbrtType::texture || type == PbrtType::spectrum;
}

std::string in_quotes(std::string_view text) {
  return "\"" + std::string(text) + "\"";
}

PbrtType find_type(std::string_view word, const PbrtPlace& place) {
  for (const TypeRow& row : type_rows)
    if (row.word == word) return row.type;
  if (word == "color" || word == "xyz")
    fail_at(place, "parameter type " + in_quotes(word) +
                       " is pbrt-v3 syntax; pbrt-v4 files say \"rgb\" or \"spectrum\"");
  fail_at(place, "unknown parameter type " + in_quotes(word.substr(0, 40)));
}

// Parses the "type name" of a declaration, which are separated by blanks.
PbrtParam parse_declaration(const PbrtToken& token, const PbrtPlace& place) {
  const std::string_view text = token.text;
  const auto blank = " \t";
  const size_t type_begin = text.find_first_not_of(blank);
  const size_t type_end =
      type_begin == std::string_view::npos ? type_begin : text.find_first_of(blank, type_begin);
  const size_t name_begin =
      type_end == std::string_view::npos ? type_end : text.find_first_not_of(blank, type_end);
  if (name_begin == std::string_view::npos)
    fail_at(place, "expected a parameter \"type name\", found " + in_quotes(text.substr(0, 40)));
  const size_t name_end = std::min(text.find_first_of(blank, name_begin), text.size());
  PbrtParam param;
  param.type = find_type(text.substr(type_begin, type_end - type_begin), place);
  param.name = std::string(text.substr(name_begin, name_end - name_begin));
  param.place = place;
  return param;
}

void check_integer(const PbrtParam& param, double value, const PbrtPlace& place) {
  if (!(std::floor(value) == value && std::abs(value) < 2147483648.0))
    fail_at(place, "parameter " + in_quotes(param.name) + " needs 32-bit integers");
}

void add_value(PbrtParam& param, const PbrtToken& token, const PbrtTokenizer& tokens,
               WarningLog& warnings) {
  const bool is_true = token.text == "true";
  const bool is_boolean = is_true || token.text == "false";
  if (token.kind == PbrtTokenKind::number && takes_numbers(param.type)) {
    if (param.type == PbrtType::integer) check_integer(param, token.number, tokens.place(token));
    param.numbers.push_back(token.number);
  } else if (param.type == PbrtType::boolean && is_boolean) {
    if (token.kind == PbrtTokenKind::string)
      warnings.add(at_place(tokens.place(token), "pbrt-v4 writes true and false without quotes"));
    param.booleans.push_back(is_true);
  } else if (token.kind == PbrtTokenKind::string && takes_strings(param.type)) {
    param.strings.push_back(unescaped(token.text));
  } else {
    fail_at(tokens.place(token), "'" + std::string(token.text.substr(0, 40)) +
                                     "' is not a value for the " + type_name(param.type) +
                                     " parameter " + in_quotes(param.name));
  }
}

void parse_values(PbrtParam& param, PbrtTokenizer& tokens, WarningLog& warnings) {
  const PbrtToken first = tokens.next();
  if (first.kind == PbrtTokenKind::end || first.kind == PbrtTokenKind::close_bracket)
    fail_at(tokens.place(first), "parameter " + in_quotes(param.name) + " has no value");
  if (first.kind != PbrtTokenKind::open_bracket) {
    add_value(param, first, tokens, warnings);
  } else {
    for (PbrtToken token = tokens.next(); token.kind != PbrtTokenKind::close_bracket;
         token = tokens.next()) {
      if (token.kind == PbrtTokenKind::end) fail_at(tokens.place(first), "'[' without ']'");
      add_value(param, token, tokens, warnings);
    }
  }
  if (param.numbers.size() % group_size(param.type) != 0)
    fail_at(param.place, "parameter " + in_quotes(param.name) + ": " +
                             std::to_string(param.numbers.size()) + " numbers do not make whole " +
                             type_name(param.type) + " values");
}

[[noreturn]] void fail_type(const PbrtParam& param, const char* wanted) {
  fail_at(param.place, "parameter " + in_quotes(param.name) + " should be of type " + wanted +
                           ", not " + type_name(param.type));
}

[[noreturn]] void fail_count(const PbrtParam& param) {
  fail_at(param.place, "parameter " + in_quotes(param.name) + " should have one value");
}

}  // namespace

const char* type_name(PbrtType type) {
  for (const TypeRow& row : type_rows)
    if (row.type == type) return row.word.data();
  return "?";
}

const PbrtParam* PbrtParams::find(std::string_view name) const {
  for (const PbrtParam& param : params_) {
    if (param.name != name) continue;
    param.is_read = true;
    return &param;
  }
  return nullptr;
}

double PbrtParams::get_float(std::string_view name, double fallback) const {
  const PbrtParam* param = find(name);
  if (!param) return fallback;
  if (param->type != PbrtType::real && param->type != PbrtType::integer) fail_type(*param, "float");
  if (param->numbers.size() != 1) fail_count(*param);
  if (!std::isfinite(param->numbers[0]))
    fail_at(param->place, "parameter " + in_quotes(name) + " is not finite");
  return param->numbers[0];
}

int PbrtParams::get_int(std::string_view name, int fallback) const {
  const PbrtParam* param = find(name);
  if (!param) return fallback;
  if (param->type != PbrtType::integer) fail_type(*param, "integer");
  if (param->numbers.size() != 1) fail_count(*param);
  return int(param->numbers[0]);
}

bool PbrtParams::get_bool(std::string_view name, bool fallback) const {
  const PbrtParam* param = find(name);
  if (!param) return fallback;
  if (param->type != PbrtType::boolean) fail_type(*param, "bool");
  if (param->booleans.size() != 1) fail_count(*param);
  return param->booleans[0];
}

std::string PbrtParams::get_string(std::string_view name, const std::string& fallback) const {
  const PbrtParam* param = find(name);
  if (!param) return fallback;
  if (param->type != PbrtType::string) fail_type(*param, "string");
  if (param->strings.size() != 1) fail_count(*param);
  return param->strings[0];
}

const std::vector<double>& PbrtParams::numbers(std::string_view name, PbrtType type) const {
  static const std::vector<double> none;
  const PbrtParam* param = find(name);
  if (!param) return none;
  if (param->type != type) fail_type(*param, type_name(type));
  return param->numbers;
}

void PbrtParams::ignore(std::initializer_list<std::string_view> names) const {
  for (const std::string_view name : names) find(name);
}

void PbrtParams::ignore_all() const {
  for (const PbrtParam& param : params_) param.is_read = true;
}

void PbrtParams::warn_unread(WarningLog& warnings) const {
  for (const PbrtParam& param : params_)
    if (!param.is_read && !param.is_default)
      warnings.add(owner + ": parameter \"" + param.name + "\" is unknown or given twice; ignored");
}

PbrtParams parse_params(PbrtTokenizer& tokens, std::string owner, const PbrtPlace& place,
                        WarningLog& warnings) {
  PbrtParams params;
  params.owner = std::move(owner);
  params.place = place;
  while (tokens.peek().kind == PbrtTokenKind::string) {
    const PbrtToken token = tokens.next();
    PbrtParam param = parse_declaration(token, tokens.place(token));
    parse_values(param, tokens, warnings);
    params.add(std::move(param));
  }
  return params;
}

}  // namespace troffer
