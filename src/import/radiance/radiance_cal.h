// Interpreter of Radiance's function files (.cal), a small language for patterns. A program holds
// definitions and expressions. Names are looked up when they are evaluated, so files may define
// them in any order. Arguments are evaluated lazily: `if` and `select` evaluate only what they
// return. Used by RadianceFunctions.
//
// References: [1] G. Ward, "The RADIANCE function file language" (refman §4, manual page icalc(1));
//   [2] manual pages gensky(1), gendaylit(1): names and arguments of the sky functions.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/vec.h"
#include "import/source_place.h"

namespace troffer {

// The ray that an expression is evaluated for, in the pattern's own space.
struct CalRay {
  Vec3d direction{0, 0, 1};  // Dx Dy Dz: unit, away from the viewer
  Vec3d normal{0, 0, -1};    // Nx Ny Nz: unit surface normal
  Vec3d point;               // Px Py Pz
};

enum class CalOp : uint8_t {
  number,
  add,
  subtract,
  multiply,
  divide,
  power,
  negate,
  parameter,  // parameter of the function that is being evaluated
  name,       // variable
  call,       // call of a function, or of a parameter that names one
};

struct CalNode {
  CalOp op = CalOp::number;
  double number = 0;
  // parameter: which one; name, call: index into names_; call of a parameter: ~which
  int32_t index = 0;
  std::vector<int32_t> children;
};

// Definitions and expressions of one pattern. Evaluation changes the program: use one per thread.
class CalProgram {
 public:
  CalProgram();

  // Adds the definitions of a file; later ones replace earlier ones. Throws InputError with the
  // place in that text.
  void read(std::shared_ptr<const std::string> file, std::string_view text);
  // Adds an expression for value() and returns its index. Throws InputError at `place`.
  int32_t expression(std::string_view text, const SourcePlace& place);
  // Sets the values of arg(1), arg(2) and so on.
  void set_arguments(std::vector<double> arguments) { arguments_ = std::move(arguments); }

  // Returns the value of an expression for a ray; not finite after a division by zero or the like.
  // Returns nothing, and sets problem(), if a name is undefined, an argument is missing, or the
  // evaluation does not end.
  std::optional<double> value(int32_t expression, const CalRay& ray);
  const std::string& problem() const { return problem_; }
  // True if any value so far depended on the ray.
  bool has_used_ray() const { return has_used_ray_; }

 private:
  struct Definition {
    std::string name;
    std::vector<std::string> parameters;
    int32_t body = -1;  // -1: not defined, or built in
    bool is_function = false;
    uint64_t clock = 0;  // evaluation that `value` belongs to
    double value = 0;
  };
  // A function call that is being evaluated.
  struct Activation {
    const CalNode* call = nullptr;
    const Activation* outer = nullptr;
  };

  std::deque<CalNode> nodes_;
  std::vector<Definition> names_;
  std::map<std::string, int32_t, std::less<>> index_of_name_;
  std::vector<double> arguments_;
  CalRay ray_;
  std::string problem_;
  bool has_used_ray_ = false;
  uint64_t clock_ = 0;
  int depth_ = 0;
  int64_t steps_ = 0;

  friend class CalParser;
  int32_t name_index(std::string_view name);
  double fail(std::string what);
  double evaluate(const CalNode& node, const Activation* in);
  double argument(const CalNode& call, size_t i, const Activation* in);
  double variable(int32_t name);
  double call(const CalNode& node, const Activation* in);
  double built_in(const std::string& name, const CalNode& call, const Activation* in);
  std::optional<double> of_ray(const std::string& name);
};

// Text of a function file that comes with Radiance and that scenes refer to: the skies of gensky
// and gendaylit. Empty for other names.
std::string_view radiance_library_file(std::string_view name);
// Functions and constants that every function file can use.
std::string_view radiance_common_definitions();

}  // namespace troffer
