// Parameter lists of pbrt directives: "type name" followed by values, checked by type.
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
  spectrum,  // numbers: wavelength (nm), value pairs; or one string: a name or a file
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
  bool is_default = false;       // comes of an Attribute directive
  mutable bool is_read = false;  // somebody asked for it
};

// The parameters of one directive. Getters mark what they return as read, and throw InputError at
// the parameter's place where type, number of values or a value (not finite) is wrong.
class PbrtParams {
 public:
  std::string owner;  // for messages: Shape "sphere"
  PbrtPlace place;    // of the directive

  void add(PbrtParam param) { params_.push_back(std::move(param)); }
  const std::vector<PbrtParam>& all() const { return params_; }
  template <class Change>
  void change_all(const Change& change) {
    for (PbrtParam& param : params_) change(param);
  }

  // The first parameter of that name, or none.
  const PbrtParam* find(std::string_view name) const;
  bool has(std::string_view name) const { return find(name) != nullptr; }

  double get_float(std::string_view name, double fallback) const;
  int get_int(std::string_view name, int fallback) const;
  bool get_bool(std::string_view name, bool fallback) const;
  std::string get_string(std::string_view name, const std::string& fallback) const;

  // All numbers of a parameter of one of the given types; none = empty. The count is a multiple of
  // the type's size; values may be infinite or NaN.
  const std::vector<double>& numbers(std::string_view name, PbrtType type) const;

  // Known and of no consequence here.
  void ignore(std::initializer_list<std::string_view> names) const;
  void ignore_all() const;
  // A counted warning for every parameter nobody asked for.
  void warn_unread(WarningLog& warnings) const;

 private:
  std::vector<PbrtParam> params_;
};

// What the file calls a type.
const char* type_name(PbrtType type);

// Reads `"type name" values` pairs up to the next thing that is not a string.
// InputError: malformed declarations, unknown types (pbrt-v3's are named as such), values that do
// not fit the type, values missing.
PbrtParams parse_params(PbrtTokenizer& tokens, std::string owner, const PbrtPlace& place,
                        WarningLog& warnings);

}  // namespace troffer
