// Parameter lists of pbrt directives: "type name" followed by values, checked by type. Used by all
// readers of this folder.
//
// References: [1] pbrt-v4 Input File Format, section "Parameter Lists", pbrt.org/fileformat-v4.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/log.h"
#include "base/rgb.h"
#include "base/vec.h"
#include "import/pbrt/pbrt_tokens.h"

namespace troffer {

enum class PbrtType {
  integer,
  real,
  point2,
  vector2,
  point3,
  vector3,
  normal,
  rgb,
  spectrum,  // numbers: pairs of wavelength (nm) and value; or one string: a name or a file
  blackbody,
  boolean,
  string,
  texture,
};

struct PbrtParam {
  PbrtType type = PbrtType::real;
  std::string name;
  PbrtPlace place;
  std::vector<double> numbers;
  std::vector<std::string> strings;
  std::vector<bool> booleans;
  bool is_default = false;       // set by an Attribute directive
  mutable bool is_read = false;  // a reader has asked for it
};

// The parameters of one directive. Getters mark the parameters that they return as read. They throw
// InputError, at the parameter's place, for a wrong type or number of values and for values that
// are not finite.
class PbrtParams {
 public:
  std::string owner;  // for messages: Shape "sphere"
  PbrtPlace place;    // place of the directive

  void add(PbrtParam param) { params_.push_back(std::move(param)); }
  const std::vector<PbrtParam>& all() const { return params_; }
  template <class Change>
  void change_all(const Change& change) {
    for (PbrtParam& param : params_) change(param);
  }

  // Returns the first parameter of that name, or null.
  const PbrtParam* find(std::string_view name) const;
  bool has(std::string_view name) const { return find(name) != nullptr; }

  double get_float(std::string_view name, double fallback) const;
  int get_int(std::string_view name, int fallback) const;
  bool get_bool(std::string_view name, bool fallback) const;
  std::string get_string(std::string_view name, const std::string& fallback) const;

  // Returns all numbers of a parameter of that type; empty if it is absent. Their count is a
  // multiple of the type's size. Values may be infinite or NaN.
  const std::vector<double>& numbers(std::string_view name, PbrtType type) const;

  // Marks parameters as read that are known and have no effect here.
  void ignore(std::initializer_list<std::string_view> names) const;
  void ignore_all() const;
  // Adds a counted warning for every parameter that has not been read.
  void warn_unread(WarningLog& warnings) const;

 private:
  std::vector<PbrtParam> params_;
};

// Name of a type in pbrt files.
const char* type_name(PbrtType type);

// Reads `"type name" values` pairs up to the next token that is not a string. Throws InputError for
// malformed declarations, unknown types (those of pbrt-v3 are named as such), missing values, and
// values that do not fit the type.
PbrtParams parse_params(PbrtTokenizer& tokens, std::string owner, const PbrtPlace& place,
                        WarningLog& warnings);

}  // namespace troffer
