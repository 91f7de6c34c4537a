#include "import/radiance/radiance_view.h"

#include <charconv>
#include <cmath>

#include "base/units.h"
#include "import/file.h"
#include "import/radiance/radiance_text.h"
#include "import/text_lines.h"

namespace troffer {

namespace {

constexpr uint64_t max_view_file_bytes = uint64_t(1) << 20;
constexpr size_t max_cameras = 1000;

struct View {
  char type = 'v';
  Vec3d position, direction{0, 1, 0}, up{0, 0, 1};
  double horizontal = 45, vertical = 45, shift = 0, lift = 0;
  bool has_position = false;
};

bool read_number(const std::vector<std::string>& words, size_t& at, double& value) {
  if (at >= words.size()) return false;
  const std::string& w = words[at++];
  const auto result = std::from_chars(w.data(), w.data() + w.size(), value);
  return result.ec == std::errc() && result.ptr == w.data() + w.size() && std::isfinite(value);
}

bool read_vector(const std::vector<std::string>& words, size_t& at, Vec3d& v) {
  return read_number(words, at, v.x) && read_number(words, at, v.y) && read_number(words, at, v.z);
}

// Skips options that do not belong to a view. Returns false if a view option lacks its numbers, or
// if there is no position.
bool parse(const std::string& line, View& view) {
  const std::vector<std::string> words = words_of(line);
  for (size_t at = 0; at < words.size();) {
    const std::string word = words[at++];
    double ignored = 0;
    bool is_fine = true;
    if (word.starts_with("-vt") && word.size() == 4) {
      view.type = word[3];
    } else if (word == "-vp") {
      is_fine = view.has_position = read_vector(words, at, view.position);
    } else if (word == "-vd") {
      is_fine = read_vector(words, at, view.direction);
    } else if (word == "-vu") {
      is_fine = read_vector(words, at, view.up);
    } else if (word == "-vh") {
      is_fine = read_number(words, at, view.horizontal);
    } else if (word == "-vv") {
      is_fine = read_number(words, at, view.vertical);
    } else if (word == "-vs") {
      is_fine = read_number(words, at, view.shift);
    } else if (word == "-vl") {
      is_fine = read_number(words, at, view.lift);
    } else if (word == "-vo" || word == "-va") {
      is_fine = read_number(words, at, ignored);
    }
    if (!is_fine) return false;
  }
  return view.has_position;
}

}  // namespace

bool add_radiance_view(const std::string& line, const std::string& name, Scene& scene) {
  View view;
  if (!parse(line, view) || scene.cameras.size() >= max_cameras) return false;
  const Vec3d forward = normalize(view.direction);
  const Vec3d right = normalize(cross(forward, view.up));
  if (!is_finite(forward) || !is_finite(right)) return false;
  Camera camera;
  camera.name = name;
  const bool is_parallel = view.type == 'l', is_fisheye = view.type == 'a' || view.type == 'h';
  if (view.type == 'h')
    scene.warnings.add("view type \"-vth\" is shown as \"-vta\", which spaces angles evenly");
  if (!is_parallel && !is_fisheye && view.type != 'v')
    scene.warnings.add(std::string("view type \"-vt") + view.type +
                       "\" is not supported: shown as perspective");
  const auto half = [&](double size) {
    if (is_fisheye) return rad_from_deg(std::min(size, 360.0)) / 2;
    return is_parallel ? size / 2 : std::tan(rad_from_deg(std::min(size, 160.0)) / 2);
  };
  const double x = half(view.horizontal), y = half(view.vertical);
  if (!(x > 0) || !(y > 0)) return false;
  camera.kind = is_parallel  ? CameraKind::orthographic
                : is_fisheye ? CameraKind::fisheye
                             : CameraKind::perspective;
  camera.half_extent = float(y);
  camera.aspect = float(x / y);
  camera.position = Vec3(view.position - scene.origin);
  camera.forward = Vec3(forward);
  camera.right = Vec3(right);
  camera.up = Vec3(cross(right, forward));
  if (view.shift != 0 || view.lift != 0) {
    const double a = x / y, dx = 2 * a * view.shift, dy = 2 * view.lift;
    camera.has_screen_window = true;
    camera.screen_window = {float(dx - a), float(dx + a), float(dy - 1), float(dy + 1)};
  }
  if (!is_finite(camera.position) || !std::isfinite(camera.aspect)) return false;
  scene.cameras.push_back(std::move(camera));
  return true;
}

void add_radiance_view_file(const std::string& path, Scene& scene) {
  const std::string text = read_text_file(path, max_view_file_bytes);
  TextLines lines(path, text);
  while (lines.next_line()) {
    const std::string line(lines.rest());
    if (line.find("-vp") == std::string::npos) continue;
    if (!add_radiance_view(line, "view" + std::to_string(scene.cameras.size()), scene))
      scene.warnings.add(path + ": a view that cannot be used is left out");
  }
}

}  // namespace troffer
