#include "import/radiance/radiance_cal.h"

#include <cmath>

#include "base/units.h"

namespace troffer {

namespace {

constexpr int max_depth = 200;
constexpr int64_t max_steps = 1'000'000;  // per value

// Evaluates functions of one number that C++ has under the same name.
double plain_function(const std::string& name, double x, bool& is_known) {
  is_known = true;
  if (name == "sin") return std::sin(x);
  if (name == "cos") return std::cos(x);
  if (name == "tan") return std::tan(x);
  if (name == "asin") return std::asin(x);
  if (name == "acos") return std::acos(x);
  if (name == "atan") return std::atan(x);
  if (name == "exp") return std::exp(x);
  if (name == "log") return std::log(x);
  if (name == "log10") return std::log10(x);
  if (name == "sqrt") return std::sqrt(x);
  if (name == "floor") return std::floor(x);
  if (name == "ceil") return std::ceil(x);
  if (name == "erf") return std::erf(x);
  if (name == "erfc") return std::erfc(x);
  is_known = false;
  return 0;
}

}  // namespace

CalProgram::CalProgram() {
  read(std::make_shared<const std::string>("rayinit.cal"), radiance_common_definitions());
}

double CalProgram::fail(std::string what) {
  if (problem_.empty()) problem_ = std::move(what);
  return 0;
}

std::optional<double> CalProgram::value(int32_t expression, const CalRay& ray) {
  ray_ = ray;
  problem_.clear();
  ++clock_;
  depth_ = 0;
  steps_ = 0;
  const double v = evaluate(nodes_[size_t(expression)], nullptr);
  if (!problem_.empty()) return std::nullopt;
  return v;
}

double CalProgram::evaluate(const CalNode& node, const Activation* in) {
  if (!problem_.empty()) return 0;
  if (++steps_ > max_steps || depth_ > max_depth) return fail("it does not end");
  ++depth_;
  const auto child = [&](size_t i) { return evaluate(nodes_[size_t(node.children[i])], in); };
  double v = 0;
  switch (node.op) {
    case CalOp::number:
      v = node.number;
      break;
    case CalOp::add:
      v = child(0) + child(1);
      break;
    case CalOp::subtract:
      v = child(0) - child(1);
      break;
    case CalOp::multiply:
      v = child(0) * child(1);
      break;
    case CalOp::divide:
      v = child(0) / child(1);
      break;
    case CalOp::power:
      v = std::pow(child(0), child(1));
      break;
    case CalOp::negate:
      v = -child(0);
      break;
    case CalOp::parameter:
      v = argument(*in->call, size_t(node.index), in->outer);
      break;
    case CalOp::name:
      v = variable(node.index);
      break;
    case CalOp::call:
      v = call(node, in);
      break;
  }
  --depth_;
  return v;
}

double CalProgram::argument(const CalNode& call, size_t i, const Activation* in) {
  if (i >= call.children.size()) return fail("a function has too few arguments");
  return evaluate(nodes_[size_t(call.children[i])], in);
}

double CalProgram::variable(int32_t name) {
  Definition& d = names_[size_t(name)];
  if (d.body >= 0 && !d.is_function) {
    if (d.clock == clock_) return d.value;
    const double v = evaluate(nodes_[size_t(d.body)], nullptr);
    Definition& kept = names_[size_t(name)];
    kept.value = v;
    kept.clock = clock_;
    return v;
  }
  if (const auto v = of_ray(d.name)) return *v;
  return fail("'" + shortened(d.name) + "' is not defined");
}

std::optional<double> CalProgram::of_ray(const std::string& name) {
  const auto varying = [&](double v) {
    has_used_ray_ = true;
    return v;
  };
  if (name.size() == 2 && name[1] >= 'x' && name[1] <= 'z') {
    const auto axis = size_t(name[1] - 'x');
    switch (name[0]) {
      case 'D':
        return varying(ray_.direction[axis]);
      case 'N':
        return varying(ray_.normal[axis]);
      case 'P':
        return varying(ray_.point[axis]);
      case 'T':  // the pattern's origin is that of its own space
        return 0;
      case 'I':
      case 'J':
      case 'K':
        return axis == size_t(name[0] - 'I') ? 1 : 0;
      default:
        return std::nullopt;
    }
  }
  if (name == "Rdot") return varying(-dot(ray_.direction, ray_.normal));
  if (name == "S") return 1;
  return std::nullopt;
}

double CalProgram::call(const CalNode& node, const Activation* in) {
  int32_t name = node.index;
  if (name < 0) {  // a parameter: its argument must be the name of a function
    const auto which = size_t(~name);
    const Activation* at = in;
    const CalNode* passed = nullptr;
    for (size_t i = which; at != nullptr;) {
      if (i >= at->call->children.size()) return fail("a function has too few arguments");
      passed = &nodes_[size_t(at->call->children[i])];
      if (passed->op != CalOp::parameter) break;
      i = size_t(passed->index);
      at = at->outer;
    }
    if (passed == nullptr || passed->op != CalOp::name)
      return fail("something that is not a function is called");
    name = passed->index;
  }
  const Definition& d = names_[size_t(name)];
  if (d.body < 0 || !d.is_function) return built_in(d.name, node, in);
  const Activation activation{&node, in};
  return evaluate(nodes_[size_t(d.body)], &activation);
}

double CalProgram::built_in(const std::string& name, const CalNode& call, const Activation* in) {
  const size_t count = call.children.size();
  const auto at = [&](size_t i) { return argument(call, i, in); };
  bool is_known = false;
  if (name == "if") return at(0) > 0 ? at(1) : at(2);
  if (name == "select") {
    const double n = std::floor(at(0) + 0.5);
    if (!(n >= 1 && n < double(count))) return fail("select: its first argument is out of range");
    return at(size_t(n));
  }
  if (name == "arg") {
    const double n = std::floor(at(0) + 0.5);
    if (n < 1) return double(arguments_.size());
    if (!(n <= double(arguments_.size())))
      return fail("real argument " + std::to_string(int(std::min(n, 1e6))) + " is missing");
    return arguments_[size_t(n) - 1];
  }
  if (name == "min" || name == "max") {
    double v = at(0);
    for (size_t i = 1; i < count; ++i) v = name == "min" ? std::min(v, at(i)) : std::max(v, at(i));
    return v;
  }
  if (name == "atan2") return std::atan2(at(0), at(1));
  const double v = plain_function(name, 0, is_known);
  if (is_known) return plain_function(name, at(0), is_known);
  if (name.starts_with("noise3") || name == "fnoise3" || name == "rand")
    return fail("Radiance's random function '" + name + "' is not evaluated");
  return v + fail("the function '" + shortened(name) + "' is not defined");
}

}  // namespace troffer
