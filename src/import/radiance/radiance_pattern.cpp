#include "import/radiance/radiance_pattern.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "import/file.h"
#include "import/radiance/radiance_command.h"

namespace troffer {

namespace {

constexpr uint64_t max_function_file_bytes = uint64_t(4) << 20;

// A file in the scene's folder precedes one that comes with Radiance, as in Radiance's search path.
void read_functions(const std::string& name, const std::string& folder, const SourcePlace& place,
                    CalProgram& program) {
  const ConfinedPath path = confined_path(folder, name);
  std::error_code error;
  if (path.is_fine() && std::filesystem::is_regular_file(path.path, error)) {
    const std::string text = read_text_file(path.path, max_function_file_bytes);
    program.read(std::make_shared<const std::string>(path.path), text);
    return;
  }
  const std::string bare = name.substr(name.find_last_of("/\\") + 1);
  const std::string_view library = radiance_library_file(bare);
  if (library.empty())
    place.fail("the function file '" + shortened(name) + "' is not found: put it beside the scene");
  program.read(std::make_shared<const std::string>(bare), library);
}

bool is_transform_option(const std::string& word) {
  return word.size() > 1 && word[0] == '-' &&
         ((word[1] >= 'a' && word[1] <= 'z') || (word[1] >= 'A' && word[1] <= 'Z'));
}

}  // namespace

RadianceFunctions::RadianceFunctions(const RadianceModifier& m, size_t first, size_t count,
                                     size_t file, const std::string& folder)
    : place_(m.place) {
  const std::vector<std::string>& strings = m.arguments.strings;
  if (strings.size() <= std::max(file, first + count - 1))
    m.place.fail(m.type + " needs " + std::to_string(file + 1) + " string arguments");
  program_.set_arguments(m.arguments.reals);
  if (strings[file] != ".") read_functions(strings[file], folder, m.place, program_);
  for (size_t i = first; i < first + count; ++i)
    expressions_.push_back(program_.expression(strings[i], m.place));
  Affine world = m.world;
  for (size_t i = file + 1; i < strings.size(); ++i) {
    if (!is_transform_option(strings[i])) continue;
    const std::vector<std::string> words(strings.begin() + std::ptrdiff_t(i), strings.end());
    world = world * parse_xform(words, m.place).copies.at(0);
    break;
  }
  if (!(std::abs(world.determinant()) > 0)) m.place.fail(m.type + ": its transform is singular");
  local_from_world_ = inverse(world);
}

std::vector<double> RadianceFunctions::values(const CalRay& world) {
  const CalRay ray{normalize(local_from_world_.vector(world.direction)),
                   normalize(local_from_world_.vector(world.normal)),
                   local_from_world_.point(world.point)};
  std::vector<double> out;
  out.reserve(expressions_.size());
  for (const int32_t e : expressions_) {
    const std::optional<double> v = program_.value(e, ray);
    if (!v) place_.fail("its function cannot be evaluated: " + program_.problem());
    has_been_finite_ = has_been_finite_ || std::isfinite(*v);
    out.push_back(std::isfinite(*v) ? *v : 0);
  }
  return out;
}

void RadianceFunctions::check() const {
  if (!has_been_finite_) place_.fail("its function gives no finite number");
}

void RadiancePattern::add(const RadianceModifier& m, const std::string& folder) {
  const bool is_colour = m.type == "colorfunc";
  functions.emplace_back(m, 0, is_colour ? 3 : 1, is_colour ? 3 : 1, folder);
}

Rgb RadiancePattern::value(const CalRay& world) {
  Rgb product{1};
  for (RadianceFunctions& f : functions) {
    const std::vector<double> v = f.values(world);
    for (size_t c = 0; c < 3; ++c)
      product[c] *= float(std::clamp(v[v.size() == 1 ? 0 : c], 0.0, 1e30));
  }
  return product;
}

void RadiancePattern::check(const std::vector<Vec3d>& directions) {
  for (const Vec3d& d : directions) value({d, -d, {}});
  for (const RadianceFunctions& f : functions) f.check();
}

std::optional<Rgb> RadiancePattern::constant() {
  const Rgb v = value({});
  for (const RadianceFunctions& f : functions)
    if (f.has_used_ray()) return std::nullopt;
  return v;
}

}  // namespace troffer
