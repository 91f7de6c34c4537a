#include "import/pbrt/pbrt_transform.h"

#include <cmath>

#include "base/units.h"

namespace troffer {

namespace {

// camera_from_world of a camera that looks from `eye` to `target` [1].
Affine look_at(const std::vector<double>& n, const PbrtPlace& place) {
  const Vec3d eye(n[0], n[1], n[2]), target(n[3], n[4], n[5]), up(n[6], n[7], n[8]);
  const Vec3d direction = target - eye;
  if (!(length(direction) > 0)) fail_at(place, "LookAt: eye and target are the same point");
  const Vec3d forward = normalize(direction);
  const Vec3d side = cross(up, forward);
  if (!(length(side) > 1e-12 * length(up)))
    fail_at(place, "LookAt: the up vector is zero or along the viewing direction");
  Affine world_from_camera;
  const Vec3d right = normalize(side);
  world_from_camera.columns = {right, cross(forward, right), forward};
  world_from_camera.translation = eye;
  return inverse(world_from_camera);
}

// Reads sixteen numbers in column-major order; the translation is at 12, 13 and 14.
Affine matrix(const std::vector<double>& n, const PbrtPlace& place) {
  const bool is_affine =
      std::abs(n[3]) <= 1e-9 && std::abs(n[7]) <= 1e-9 && std::abs(n[11]) <= 1e-9 && n[15] != 0;
  if (!is_affine) fail_at(place, "projective transforms are not supported");
  const double w = 1 / n[15];
  Affine a;
  a.columns = {Vec3d(n[0], n[1], n[2]) * w, Vec3d(n[4], n[5], n[6]) * w,
               Vec3d(n[8], n[9], n[10]) * w};
  a.translation = Vec3d(n[12], n[13], n[14]) * w;
  return a;
}

}  // namespace

std::vector<double> parse_numbers(PbrtTokenizer& tokens, size_t count, std::string_view directive) {
  const bool has_brackets = tokens.peek().kind == PbrtTokenKind::open_bracket;
  if (has_brackets) tokens.next();
  std::vector<double> numbers;
  for (size_t i = 0; i < count; ++i) {
    const PbrtToken token = tokens.next();
    if (token.kind != PbrtTokenKind::number)
      fail_at(tokens.place(token),
              std::string(directive) + " needs " + std::to_string(count) + " numbers");
    if (!std::isfinite(token.number))
      fail_at(tokens.place(token), std::string(directive) + ": a number is not finite");
    numbers.push_back(token.number);
  }
  if (has_brackets) {
    const PbrtToken token = tokens.next();
    if (token.kind != PbrtTokenKind::close_bracket)
      fail_at(tokens.place(token), std::string(directive) + ": expected ']' after " +
                                       std::to_string(count) + " numbers");
  }
  return numbers;
}

std::optional<PbrtTransform> parse_transform(const PbrtToken& directive, PbrtTokenizer& tokens) {
  const std::string_view word = directive.text;
  const PbrtPlace place = tokens.place(directive);
  if (word == "Identity") return PbrtTransform{Affine(), true};
  if (word == "Translate" || word == "Scale") {
    const auto n = parse_numbers(tokens, 3, word);
    const Vec3d v(n[0], n[1], n[2]);
    return PbrtTransform{word == "Scale" ? Affine::scale(v) : Affine::translate(v), false};
  }
  if (word == "Rotate") {
    const auto n = parse_numbers(tokens, 4, word);
    const Vec3d axis(n[1], n[2], n[3]);
    if (!(length(axis) > 0)) fail_at(place, "Rotate: the axis is zero");
    return PbrtTransform{Affine::rotate(rad_from_deg(n[0]), axis), false};
  }
  if (word == "LookAt") return PbrtTransform{look_at(parse_numbers(tokens, 9, word), place), false};
  if (word == "Transform" || word == "ConcatTransform")
    return PbrtTransform{matrix(parse_numbers(tokens, 16, word), place), word == "Transform"};
  return std::nullopt;
}

}  // namespace troffer
