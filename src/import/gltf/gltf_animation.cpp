#include "import/gltf/gltf_animation.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace troffer {

namespace {

constexpr uint64_t max_weights = 10'000;

enum class Interpolation { step, linear, cubic };

// One animation sampler: `width` elements of `values` at each key, or three times as many if cubic.
struct AnimationCurve {
  const AccessorView& times;
  const AccessorView& values;
  Interpolation interpolation;
  uint64_t width;  // 1, or the number of morph weights

  // Returns element k at a key. `part` matters for cubic curves: 0 in-tangent, 1 value, 2
  // out-tangent.
  std::array<float, 4> at(uint64_t key, uint64_t part, uint64_t k) const {
    const bool is_cubic = interpolation == Interpolation::cubic;
    return values.read((is_cubic ? key * 3 + part : key) * width + k);
  }
};

Interpolation interpolation_of(const JsonNode& sampler) {
  const std::string name = sampler.string_or("interpolation", "LINEAR");
  if (name == "LINEAR") return Interpolation::linear;
  if (name == "STEP") return Interpolation::step;
  if (name == "CUBICSPLINE") return Interpolation::cubic;
  sampler.member("interpolation").fail("'" + printable(name) + "' is not an interpolation");
}

// Position of a time between two keys: [1] appendix C.
struct Moment {
  uint64_t key = 0;     // key before the time; the time lies before the next key unless is_at_key
  double fraction = 0;  // fraction of the interval, 0 to 1
  double seconds = 0;   // length of the interval
  bool is_at_key = true;
};

Moment find_moment(const AccessorView& times, double time) {
  const auto at = [&](uint64_t i) { return double(times.read(i)[0]); };
  uint64_t low = 0, high = times.count;  // search for the first key after `time`
  while (low < high) {
    const uint64_t middle = (low + high) / 2;
    if (at(middle) > time)
      high = middle;
    else
      low = middle + 1;
  }
  if (low == 0) return {};
  Moment m;
  m.key = low - 1;
  if (low == times.count) return m;
  m.seconds = at(low) - at(m.key);
  if (!(m.seconds > 0) || !std::isfinite(m.seconds)) return m;
  m.fraction = std::clamp((time - at(m.key)) / m.seconds, 0.0, 1.0);
  m.is_at_key = false;
  return m;
}

using Numbers = std::array<double, 4>;

Numbers widened(const std::array<float, 4>& v) {
  return {double(v[0]), double(v[1]), double(v[2]), double(v[3])};
}

Numbers mixed(const Numbers& a, double wa, const Numbers& b, double wb) {
  Numbers out;
  for (size_t i = 0; i < 4; ++i) out[i] = wa * a[i] + wb * b[i];
  return out;
}

// Spherical linear interpolation along the shorter arc [1] appendix C.3.
Numbers slerp(const Numbers& a, Numbers b, double t) {
  double dot = 0, of_a = 0, of_b = 0;
  for (size_t i = 0; i < 4; ++i) {
    dot += a[i] * b[i];
    of_a += a[i] * a[i];
    of_b += b[i] * b[i];
  }
  const double lengths = std::sqrt(of_a * of_b);
  const double cosine = lengths > 0 ? dot / lengths : 1;
  const double sign = cosine < 0 ? -1 : 1;
  const double angle = std::acos(std::min(std::abs(cosine), 1.0));
  if (angle < 1e-6) return mixed(a, 1 - t, b, sign * t);
  return mixed(a, std::sin((1 - t) * angle) / std::sin(angle), b,
               sign * std::sin(t * angle) / std::sin(angle));
}

Numbers value_at(const AnimationCurve& curve, const Moment& m, uint64_t k, bool is_rotation) {
  const Numbers here = widened(curve.at(m.key, 1, k));
  if (m.is_at_key || curve.interpolation == Interpolation::step) return here;
  const Numbers next = widened(curve.at(m.key + 1, 1, k));
  const double t = m.fraction, t2 = t * t, t3 = t2 * t;
  if (curve.interpolation == Interpolation::linear)
    return is_rotation ? slerp(here, next, t) : mixed(here, 1 - t, next, t);
  const Numbers out = widened(curve.at(m.key, 2, k)), in = widened(curve.at(m.key + 1, 0, k));
  return mixed(mixed(here, 2 * t3 - 3 * t2 + 1, out, m.seconds * (t3 - 2 * t2 + t)), 1,
               mixed(next, -2 * t3 + 3 * t2, in, m.seconds * (t3 - t2)), 1);
}

// Returns the sampler's curve. Fails if the accessors of its times and values do not fit each
// other. `has_many` allows more than one element per key (morph weights).
AnimationCurve read_curve(const JsonNode& sampler, const GltfBuffers& buffers, uint32_t components,
                          bool has_many) {
  const JsonNode input = sampler.member("input"), output = sampler.member("output");
  const AccessorView& times = buffers.accessor(input);
  const AccessorView& values = buffers.accessor(output);
  const Interpolation interpolation = interpolation_of(sampler);
  if (times.components != 1 || times.component_type != gltf_float || times.count == 0)
    input.fail("its accessor should hold times: at least one scalar float");
  if (values.components != components)
    output.fail("its accessor should have " + std::to_string(components) + " components");
  const uint64_t parts = interpolation == Interpolation::cubic ? 3 : 1;
  const uint64_t width = has_many ? values.count / times.count / parts : 1;
  if (values.count != times.count * parts * width || width == 0 || width > max_weights)
    output.fail("its accessor's count does not match that of the times");
  return {times, values, interpolation, width};
}

template <size_t n>
std::array<double, n> first_of(const Numbers& v, const JsonNode& where) {
  std::array<double, n> out{};
  for (size_t i = 0; i < n; ++i) {
    out[i] = v[i];
    if (!std::isfinite(v[i])) where.fail("is not finite at that time");
  }
  return out;
}

void apply_channel(const JsonNode& animation, const JsonNode& channel, size_t nodes,
                   const GltfBuffers& buffers, double time, GltfPoses& poses,
                   WarningLog& warnings) {
  const JsonNode target = channel.member("target");
  const JsonNode samplers = animation.member("samplers");
  const JsonNode sampler =
      samplers.element(channel.member("sampler").as_index(samplers.size(), "samplers"));
  const std::string path = target.member("path").as_string();
  const auto node = target.find("node");
  const bool is_weights = path == "weights", is_rotation = path == "rotation";
  if (!node || (!is_weights && !is_rotation && path != "translation" && path != "scale")) {
    warnings.add("animations of anything but properties of nodes (" + printable(path) +
                 ") are not played");
    return;
  }
  GltfNodePose& pose = poses[node->as_index(nodes, "nodes")];
  const uint32_t components = is_weights ? 1 : is_rotation ? 4 : 3;
  const AnimationCurve curve = read_curve(sampler, buffers, components, is_weights);
  const Moment m = find_moment(curve.times, time);
  if (is_weights) {
    pose.weights.emplace();
    for (uint64_t k = 0; k < curve.width; ++k)
      pose.weights->push_back(first_of<1>(value_at(curve, m, k, false), sampler)[0]);
  } else if (is_rotation) {
    pose.rotation = first_of<4>(value_at(curve, m, 0, true), sampler);
  } else {
    (path == "scale" ? pose.scale : pose.translation) =
        first_of<3>(value_at(curve, m, 0, false), sampler);
  }
}

// Returns the requested animation, or the first one; nothing if the file has none. Throws
// UsageError if there is no animation of that name.
std::optional<JsonNode> chosen_animation(const JsonNode& root,
                                         const std::optional<std::string>& name) {
  const auto animations = root.find("animations");
  const size_t n = animations ? animations->size() : 0;
  if (!name) return n > 0 ? std::optional(animations->element(0)) : std::nullopt;
  std::string names;
  for (size_t i = 0; i < n; ++i) {
    const std::string is = animations->element(i).string_or("name", "");
    if (is == *name) return animations->element(i);
    names += (i > 0 ? ", " : "") + printable(is);
  }
  throw UsageError("--animation: there is no animation '" + printable(*name) + "'" +
                   (n == 0 ? "" : ", but " + names));
}

}  // namespace

GltfPoses gltf_poses(const JsonNode& root, const GltfBuffers& buffers, double time,
                     const std::optional<std::string>& animation, WarningLog& warnings) {
  GltfPoses poses;
  const auto chosen = chosen_animation(root, animation);
  if (!chosen) {
    warnings.add("there is no animation: --time changes nothing");
    return poses;
  }
  const size_t animations = root.member("animations").size();
  if (!animation && animations > 1)
    warnings.add("the file has " + std::to_string(animations) +
                 " animations; the first one is shown");
  const auto nodes = root.find("nodes");
  const JsonNode channels = chosen->member("channels");
  for (size_t i = 0; i < channels.size(); ++i)
    apply_channel(*chosen, channels.element(i), nodes ? nodes->size() : 0, buffers, time, poses,
                  warnings);
  return poses;
}

}  // namespace troffer
