#include "scene/orientation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <vector>

#include "scene/up_hints.h"

namespace troffer {

namespace {

// Weights at which evidence decides alone, or casts doubt on the format.
constexpr double deciding = 1, contradicting = 3;
// Evidence for another direction casts doubt from this share of the decision's weight.
constexpr double doubtful_share = 0.6;

struct FormatRule {
  const char* ending;
  const char* name;
  bool is_fixed;  // the format prescribes the axis
  char axis;      // prescribed axis, or that of most files
  double weight;  // weight of the convention among hints (scene/up_hints.h)
};

// OBJ exporters turn scenes to y by default, STL exporters keep z; pbrt and PLY files have either.
constexpr FormatRule formats[] = {
    {"gltf", "glTF", true, 'y', 0},       {"glb", "glTF", true, 'y', 0},
    {"rad", "Radiance", true, 'z', 0},    {"xml", "Mitsuba", false, 'y', 2},
    {"hbjson", "Honeybee", true, 'z', 0}, {"json", "Honeybee", true, 'z', 0},
    {"pbrt", "pbrt", false, 'y', 0.25},   {"obj", "OBJ", false, 'y', 1},
    {"ply", "PLY", false, 'y', 0.25},     {"stl", "STL", false, 'z', 1},
};
constexpr FormatRule no_format{"", "scene", false, 'y', 0.25};

// Format by the file's ending, as importers choose it.
const FormatRule& format_of(const Scene& scene) {
  std::string file = scene.file;
  std::transform(file.begin(), file.end(), file.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  if (file.ends_with(".gz")) file.resize(file.size() - 3);
  for (const FormatRule& f : formats)
    if (file.ends_with(std::string(".") + f.ending)) return f;
  return no_format;
}

Vec3 axis_of(char name) {
  return name == 'z' ? Vec3{0, 0, 1} : Vec3{0, 1, 0};
}

double weight_for(const std::vector<UpHint>& hints, const Vec3& up) {
  double sum = 0;
  for (const UpHint& h : hints)
    if (h.up == up) sum += h.weight;
  return sum;
}

// Text "by A, B and C" with the three strongest sources.
std::string sources_of(const std::vector<UpHint>& hints, const Vec3& up) {
  std::vector<std::string> names;
  for (const UpHint& h : hints)
    if (h.up == up && names.size() < 3) names.push_back(h.source);
  std::string text = "by ";
  for (size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return text;
}

// The direction other than `up` with the most weight; weight 0 if there is none.
UpHint strongest_other(const std::vector<UpHint>& hints, const Vec3& up) {
  UpHint best{up, 0, ""};
  for (const UpHint& h : hints) {
    const double weight = weight_for(hints, h.up);
    if (!(h.up == up) && weight > best.weight) best = {h.up, weight, ""};
  }
  return best;
}

UpDecision decide_by_format(const FormatRule& format, const std::vector<UpHint>& hints) {
  UpDecision d;
  d.up = axis_of(format.axis);
  d.basis = UpBasis::format;
  d.reason = fmt::format("by the {} format", format.name);
  const UpHint other = strongest_other(hints, d.up);
  if (other.weight >= contradicting && weight_for(hints, d.up) < 0.5 * other.weight)
    d.doubt = fmt::format("{} is taken for up, {}, but {} is up {} (--up {} takes that)",
                          name_of_up(d.up), d.reason, name_of_up(other.up),
                          sources_of(hints, other.up), name_of_up(other.up));
  return d;
}

// Hint from the proportions: most scenes are less tall than wide.
UpHint hint_of_extent(const Scene& scene) {
  constexpr double weak = 0.5;
  const Box box = bounds(scene);
  if (box.is_empty()) return {{0, 1, 0}, 0, ""};
  const Vec3 size = box.extent();
  if (size.y == size.z) return {{0, 1, 0}, 0, ""};
  return {size.z < size.y ? Vec3{0, 0, 1} : Vec3{0, 1, 0}, weak, "its proportions"};
}

UpDecision decide_by_evidence(const Scene& scene, const FormatRule& format,
                              const std::vector<UpHint>& hints) {
  const UpHint extent = hint_of_extent(scene);
  const auto weight = [&](const Vec3& up) {
    return weight_for(hints, up) + (up == axis_of(format.axis) ? format.weight : 0) +
           (up == extent.up ? extent.weight : 0);
  };
  UpDecision d;
  d.up = axis_of('y');
  if (weight(axis_of('z')) > weight(d.up)) d.up = axis_of('z');
  for (const UpHint& h : hints)
    if (weight(h.up) > weight(d.up)) d.up = h.up;
  const double own = weight_for(hints, d.up);
  const UpHint other = strongest_other(hints, d.up);
  if (own < deciding) {
    const bool is_usual = d.up == axis_of(format.axis) && format.weight >= 1;
    const Vec3 second = d.up == axis_of('y') ? axis_of('z') : axis_of('y');
    d.basis = UpBasis::convention;
    d.reason =
        is_usual ? fmt::format("as in most {} files", format.name) : "by its proportions alone";
    d.doubt = fmt::format(
        "nothing in the file says which way is up: {} is taken, {} (--up {} if it stands on {})",
        name_of_up(d.up), d.reason, name_of_up(second), name_of_up(second));
    return d;
  }
  d.basis = UpBasis::evidence;
  d.reason = sources_of(hints, d.up);
  if (other.weight >= 1.5 && other.weight >= doubtful_share * weight(d.up))
    d.doubt = fmt::format(
        "which way is up is in doubt: {} {}, {} {}; {} is taken (--up {} takes the other)",
        name_of_up(d.up), d.reason, name_of_up(other.up), sources_of(hints, other.up),
        name_of_up(d.up), name_of_up(other.up));
  return d;
}

}  // namespace

UpDecision decide_up(const Scene& scene) {
  const FormatRule& format = format_of(scene);
  const std::vector<UpHint> hints = up_hints(scene);
  return format.is_fixed ? decide_by_format(format, hints)
                         : decide_by_evidence(scene, format, hints);
}

UpDecision requested_up(const Vec3& up) {
  return {up, UpBasis::asked, "by --up", ""};
}

std::string name_of_up(const Vec3& up) {
  static constexpr const char* names[] = {"x", "y", "z"};
  for (size_t a = 0; a < 3; ++a) {
    Vec3 axis{0};
    axis[a] = length(up);
    if (up == axis) return names[a];
    if (up == -axis) return std::string("-") + names[a];
  }
  return fmt::format("{:.4g},{:.4g},{:.4g}", up.x, up.y, up.z);
}

std::string describe(const UpDecision& d) {
  return fmt::format("{} is up, {}", name_of_up(d.up), d.reason);
}

bool is_mirrored(const Scene& scene) {
  if (scene.cameras.empty()) return false;
  const Camera& c = scene.cameras.front();
  return dot(cross(c.forward, c.up), c.right) < 0;
}

}  // namespace troffer
