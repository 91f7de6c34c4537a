#include "import/mitsuba/mitsuba_transform.h"

#include <cmath>

#include "base/units.h"
#include "import/mitsuba/mitsuba_values.h"

namespace troffer {

namespace {

double number(const MitsubaNode& node, const char* key, double fallback) {
  if (!node.has(key)) return fallback;
  const std::vector<double> n = numbers_of(node, node.attribute(key));
  if (n.size() != 1) node.place.fail(std::string(key) + ": one number expected");
  return n[0];
}

Vec3d triple(const MitsubaNode& node, const std::string& text) {
  const std::vector<double> n = numbers_of(node, text);
  if (n.size() == 1) return Vec3d{n[0]};
  if (n.size() != 3) node.place.fail("three numbers expected, not '" + shortened(text) + "'");
  return {n[0], n[1], n[2]};
}

// The camera looks along +z from `origin`, with y up and x to the left.
Affine look_at(const MitsubaNode& node) {
  const Vec3d origin = triple(node, node.attribute("origin"));
  const Vec3d direction = triple(node, node.attribute("target")) - origin;
  Vec3d up = node.has("up") ? triple(node, node.attribute("up")) : Vec3d{0};
  if (!(length(direction) > 0)) node.place.fail("lookat: origin and target are the same point");
  const Vec3d forward = normalize(direction);
  if (!(length(up) > 0))  // any direction across the view
    up = std::abs(forward.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
  const Vec3d left = cross(up, forward);
  if (!(length(left) > 1e-12 * length(up))) node.place.fail("lookat: up is along the view");
  Affine t;
  t.columns[0] = normalize(left);
  t.columns[1] = cross(forward, t.columns[0]);
  t.columns[2] = forward;
  t.translation = origin;
  return t;
}

Affine matrix(const MitsubaNode& node) {
  const std::vector<double> m = numbers_of(node, node.attribute("value"));
  Affine t;
  if (m.size() == 9) {
    for (size_t c = 0; c < 3; ++c) t.columns[c] = {m[c], m[3 + c], m[6 + c]};
    return t;
  }
  if (m.size() != 16) node.place.fail("a matrix has 16 numbers");
  if (std::abs(m[12]) > 1e-9 || std::abs(m[13]) > 1e-9 || std::abs(m[14]) > 1e-9 || m[15] == 0)
    node.place.fail("projective transforms are not supported");
  for (size_t c = 0; c < 3; ++c) t.columns[c] = Vec3d{m[c], m[4 + c], m[8 + c]} / m[15];
  t.translation = Vec3d{m[3], m[7], m[11]} / m[15];
  return t;
}

Affine step(const MitsubaNode& node) {
  if (node.tag == "translate") return Affine::translate(vector_attribute(node, Vec3d{0}));
  if (node.tag == "scale") {
    return Affine::scale(vector_attribute(node, Vec3d{1}));
  }
  if (node.tag == "rotate") {
    const Vec3d axis = vector_attribute(node, Vec3d{0});
    if (!(length(axis) > 0)) node.place.fail("rotate: the axis has no length");
    return Affine::rotate(rad_from_deg(number(node, "angle", 0)), axis);
  }
  if (node.tag == "lookat" || node.tag == "lookAt" || node.tag == "look_at") return look_at(node);
  if (node.tag == "matrix") return matrix(node);
  node.place.fail("unknown transform <" + shortened(node.tag) + ">");
}

}  // namespace

Vec3d vector_attribute(const MitsubaNode& node, const Vec3d& fallback) {
  if (node.has("value")) return triple(node, node.attribute("value"));
  return {number(node, "x", fallback.x), number(node, "y", fallback.y),
          number(node, "z", fallback.z)};
}

Affine transform_of(const MitsubaNode& node) {
  if (node.tag == "animation") {
    for (const MitsubaNode* child : node.children)
      if (child->tag == "transform") return transform_of(*child);
    return {};
  }
  Affine t;
  for (const MitsubaNode* child : node.children) t = step(*child) * t;
  const bool is_usable = is_finite(Vec3(t.columns[0])) && is_finite(Vec3(t.columns[1])) &&
                         is_finite(Vec3(t.columns[2])) && is_finite(Vec3(t.translation));
  if (!is_usable) node.place.fail("the transform is out of range");
  return t;
}

}  // namespace troffer
