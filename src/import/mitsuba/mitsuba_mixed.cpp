// Mitsuba's bsdfs that combine several others: blendbsdf and mixturebsdf (part of MitsubaBsdfs).
#include <algorithm>
#include <cmath>

#include "import/blend_materials.h"
#include "import/mitsuba/mitsuba_bsdf.h"
#include "import/mitsuba/mitsuba_values.h"

namespace troffer {

namespace {

constexpr double negligible = 1e-6;

// Scales the material's reflectance. Returns false for materials that no single colour scales.
bool scale_by(Material& m, double share) {
  if (m.kind == MaterialKind::conductor && !m.is_reflectance && m.coat.value <= 0) {
    m.specular_color.value *= float(share);
    return true;
  }
  const bool is_scaled =
      m.kind == MaterialKind::diffuse || (m.kind == MaterialKind::conductor && m.is_reflectance);
  if (!is_scaled) return false;
  m.base_color.value *= float(share);
  m.diffuse_transmission_color.value *= float(share);
  return true;
}

}  // namespace

std::vector<MitsubaBsdfs::Part> MitsubaBsdfs::parts_of(const MitsubaNode& node) {
  std::vector<Part> parts;
  for (const MitsubaNode* child : node.children) {
    const MitsubaNode& inner = tree_.resolved(*child);
    if (inner.tag != "bsdf") continue;
    child->is_used = true;
    parts.push_back({0, convert(inner)});
  }
  return parts;
}

// Returns the material with coverage `share`, multiplied by its own mask if that is a constant.
std::optional<Material> MitsubaBsdfs::with_mask(const MitsubaNode& node, Material m,
                                                const FloatInput& share) {
  if (share.texture < 0 && share.value >= 1) return m;
  if (share.texture < 0 && share.value <= 0) return std::nullopt;
  if (m.is_alpha_masked && m.alpha.texture < 0 && share.texture < 0) {
    m.alpha.value *= share.value;
    return m;
  }
  if (m.is_alpha_masked) approximate(node, "without the mask within it");
  m.is_alpha_masked = m.is_alpha_blended = true;
  m.alpha = share;
  return m;
}

// Mixes bsdfs: diffuse ones are added, and `null` becomes alpha. Of other materials, the one with
// the most weight is taken.
std::optional<Material> MitsubaBsdfs::sum_of(const MitsubaNode& node, std::vector<Part> parts) {
  double open = 0, solid = 0;
  for (const Part& part : parts) (part.material ? solid : open) += part.share;
  std::erase_if(parts, [](const Part& p) { return !p.material || p.share <= negligible; });
  if (parts.empty()) return std::nullopt;
  const double all = open > negligible ? open + solid : 1;  // the remainder up to 1 is absorbed
  const bool are_diffuse = std::all_of(parts.begin(), parts.end(), [](const Part& p) {
    return is_plain_diffuse(*p.material) && p.material->base_color.texture < 0 &&
           transmitted(*p.material).texture < 0;
  });
  Material m = *parts[0].material;
  const double scale = open > negligible ? 1 / solid : 1;
  if (are_diffuse) {
    Rgb reflected{0}, through{0};
    for (const Part& p : parts) {
      reflected += p.material->base_color.value * float(p.share * scale);
      through += transmitted(*p.material).value * float(p.share * scale);
    }
    set_diffuse(m, {reflected, no_texture}, {through, no_texture});
  } else {
    const auto heavy = std::max_element(
        parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.share < b.share; });
    m = *heavy->material;
    const bool is_alone = parts.size() == 1;
    if (!is_alone) approximate(node, "by the bsdf with the larger weight");
    const double dimmed = heavy->share * scale;
    if (is_alone && dimmed < 1 - negligible && !scale_by(m, dimmed))
      approximate(node, "a weight below 1 as 1");
  }
  return with_mask(node, std::move(m), {float((all - open) / all), no_texture, 0});
}

// Blends two bsdfs by a textured weight: two diffuse ones by their colours, one and `null` by a
// mask.
std::optional<Material> MitsubaBsdfs::blended_by(const MitsubaNode& node, const FloatInput& weight,
                                                 std::vector<Part>& parts) {
  std::optional<Material>&first = parts[0].material, &second = parts[1].material;
  if (!first && !second) return std::nullopt;
  if (!first) return with_mask(node, *second, weight);
  if (!second) {
    const ColorInput rest = blend(scene_, {Rgb{1}, no_texture}, {Rgb{0}, no_texture}, weight);
    return with_mask(node, *first, {1, rest.texture, 0});
  }
  if (blend_diffuse(scene_, *first, *second, weight)) return first;
  approximate(node, "by the bsdf with the larger weight");
  return mean_of(scene_.textures, weight) > 0.5f ? second : first;
}

std::optional<Material> MitsubaBsdfs::blended(const MitsubaNode& node) {
  FloatInput weight = textures_.real(node, {"weight"}, 0.5f);
  std::vector<Part> parts = parts_of(node);
  if (parts.size() != 2) node.place.fail("bsdf \"" + shortened(node.type) + "\" needs two bsdfs");
  const bool has_images = std::any_of(parts.begin(), parts.end(), [](const Part& p) {
    return p.material && is_plain_diffuse(*p.material) && has_textured_input(*p.material);
  });
  if (weight.texture >= 0) return blended_by(node, weight, parts);
  weight.value = std::clamp(weight.value, 0.0f, 1.0f);
  if (weight.value <= 0) return parts[0].material;
  if (weight.value >= 1) return parts[1].material;
  if (has_images && parts[0].material && parts[1].material) return blended_by(node, weight, parts);
  parts[0].share = 1 - double(weight.value);
  parts[1].share = double(weight.value);
  return sum_of(node, std::move(parts));
}

// The remainder of the weights up to 1 is absorbed. Weights that exceed 1 in total are normalized.
std::optional<Material> MitsubaBsdfs::mixed(const MitsubaNode& node) {
  const MitsubaNode* given = find_parameter(node, "weights");
  std::vector<Part> parts = parts_of(node);
  const std::vector<double> weights =
      given ? numbers_of(*given, given->attribute("value")) : std::vector<double>();
  if (parts.empty() || weights.size() != parts.size())
    node.place.fail("bsdf \"" + shortened(node.type) + "\" needs as many weights as bsdfs");
  double sum = 0;
  for (size_t i = 0; i < parts.size(); ++i) {
    if (!(weights[i] >= 0)) given->place.fail("weights must not be negative");
    parts[i].share = weights[i];
    sum += weights[i];
  }
  if (sum > 1)
    for (Part& part : parts) part.share /= sum;
  return sum_of(node, std::move(parts));
}

}  // namespace troffer
