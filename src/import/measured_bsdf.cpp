#include "import/measured_bsdf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/units.h"
#include "import/file.h"
#include "import/gltf/gltf_json.h"
#include "import/spectra.h"

namespace troffer {

namespace {

constexpr uint64_t max_measured_bytes = uint64_t(1) << 29;
constexpr size_t max_fields = 256, max_dimensions = 8;
constexpr uint8_t type_float = 10;  // 32 bits, little-endian

// Floats of one field; a view of the file's bytes.
struct Tensor {
  std::vector<uint64_t> shape;
  const uint8_t* bytes = nullptr;
  uint64_t count = 0;

  float at(uint64_t i) const {
    float v = 0;
    std::memcpy(&v, bytes + 4 * i, sizeof v);
    return std::isfinite(v) ? v : 0.0f;
  }
};

struct Problem {
  std::string text;
};

class TensorFile {
 public:
  explicit TensorFile(std::vector<uint8_t> bytes) : bytes_(std::move(bytes)) {
    constexpr std::string_view magic("tensor_file\0", 12);
    if (bytes_.size() < 18 || std::memcmp(bytes_.data(), magic.data(), magic.size()) != 0)
      throw Problem{"is not a tensor file"};
    if (bytes_[12] != 1) throw Problem{"is not of version 1"};
    at_ = 14;
    const auto fields = take<uint32_t>();
    if (fields > max_fields) throw Problem{"has too many fields"};
    for (uint32_t i = 0; i < fields; ++i) read_field();
  }

  // Returns a float field with that number of dimensions, none of them empty.
  const Tensor& field(const char* name, size_t dimensions) const {
    const Tensor* found = find(name, dimensions);
    if (found == nullptr) throw Problem{fmt::format("has no usable field '{}'", name)};
    return *found;
  }
  const Tensor* find(const char* name, size_t dimensions) const {
    const auto it = fields_.find(name);
    return it != fields_.end() && it->second.shape.size() == dimensions ? &it->second : nullptr;
  }

 private:
  template <class T>
  T take() {
    if (bytes_.size() - at_ < sizeof(T)) throw Problem{"ends too early"};
    T v;
    std::memcpy(&v, bytes_.data() + at_, sizeof v);
    at_ += sizeof v;
    return v;
  }

  void read_field() {
    const auto name_length = take<uint16_t>();
    if (bytes_.size() - at_ < name_length) throw Problem{"ends too early"};
    const std::string name(reinterpret_cast<const char*>(bytes_.data() + at_), name_length);
    at_ += name_length;
    const auto dimensions = take<uint16_t>();
    const auto type = take<uint8_t>();
    const auto offset = take<uint64_t>();
    if (dimensions > max_dimensions) throw Problem{"has a field of too many dimensions"};
    Tensor t;
    t.count = 1;
    for (uint16_t d = 0; d < dimensions; ++d) {
      t.shape.push_back(take<uint64_t>());
      if (t.shape.back() == 0 || t.shape.back() > max_measured_bytes / t.count) t.count = 0;
      if (t.count == 0) break;
      t.count *= t.shape.back();
    }
    while (t.shape.size() < dimensions) t.shape.push_back(take<uint64_t>());
    if (type != type_float || t.count == 0) return;  // not floats: for example the description
    if (offset > bytes_.size() || t.count > (bytes_.size() - offset) / 4)
      throw Problem{"has a field that lies outside the file"};
    t.bytes = bytes_.data() + offset;
    fields_.emplace(name, std::move(t));
  }

  std::vector<uint8_t> bytes_;
  size_t at_ = 0;
  std::map<std::string, Tensor> fields_;
};

// Returns the mean of a grid over its square: linear between nodes, the first and last of which lie
// on the edges.
double mean_over_square(const Tensor& t, uint64_t first, uint64_t height, uint64_t width) {
  const auto weight = [](uint64_t i, uint64_t n) {
    return n > 1 && (i == 0 || i + 1 == n) ? 0.5 : 1.0;
  };
  double sum = 0, total = 0;
  for (uint64_t y = 0; y < height; ++y)
    for (uint64_t x = 0; x < width; ++x) {
      const double w = weight(x, width) * weight(y, height);
      sum += w * double(t.at(first + y * width + x));
      total += w;
    }
  return sum / total;
}

// Returns the albedo of each channel under uniform illumination from the hemisphere. Values are
// weights of directions drawn from the microfacet density [1, Eq. 12]. Their mean over the square
// of random numbers is therefore the albedo for one direction of incidence.
std::vector<double> mean_albedos(const Tensor& values, const Tensor& inclinations) {
  const uint64_t azimuths = values.shape[0], tilts = values.shape[1], channels = values.shape[2],
                 height = values.shape[3], width = values.shape[4];
  if (inclinations.count != tilts) throw Problem{"has fields that do not fit together"};
  std::vector<double> sums(channels);
  double total = 0;
  for (uint64_t t = 0; t < tilts; ++t) {
    const auto theta = [&](uint64_t i) {
      return std::clamp(double(inclinations.at(std::min(i, tilts - 1))), 0.0, pi / 2);
    };
    const double wide = std::abs(theta(t + 1) - theta(t > 0 ? t - 1 : 0));
    const double weight = std::max(std::sin(2 * theta(t)) * wide, 1e-9);
    for (uint64_t a = 0; a < azimuths; ++a) {
      total += weight;
      for (uint64_t c = 0; c < channels; ++c)
        sums[c] +=
            weight * mean_over_square(values, ((a * tilts + t) * channels + c) * height * width,
                                      height, width);
    }
  }
  for (double& s : sums) s = std::clamp(s / total, 0.0, 1.0);
  return sums;
}

Rgb colour_of(const TensorFile& file) {
  const Tensor& inclinations = file.field("theta_i", 1);
  if (const Tensor* rgb = file.find("rgb", 5)) {
    const std::vector<double> c = mean_albedos(*rgb, inclinations);
    if (c.size() != 3) throw Problem{"has fields that do not fit together"};
    return {float(c[0]), float(c[1]), float(c[2])};
  }
  const Tensor& wavelengths = file.field("wavelengths", 1);
  const std::vector<double> c = mean_albedos(file.field("spectra", 5), inclinations);
  if (wavelengths.count != c.size()) throw Problem{"has fields that do not fit together"};
  SampledSpectrum spectrum;
  for (size_t i = 0; i < c.size(); ++i) {
    const auto nm = double(wavelengths.at(i));
    if (i > 0 && !(nm > spectrum.wavelengths_nm.back()))
      throw Problem{"has wavelengths that do not ascend"};
    spectrum.wavelengths_nm.push_back(nm);
    spectrum.values.push_back(c[i]);
  }
  return clamp01(reflectance_from_spectrum(spectrum));
}

// Width and share of the peak in the density of normals, averaged over azimuths. Nodes lie at
// inclinations u² pi / 2. GGX's density times cos⁴ falls to a quarter where the tangent equals its
// width; 16/17 of its area lie within four times that.
struct Peak {
  float width = 1, share = 0;
};
Peak peak_of(const Tensor& densities) {
  const uint64_t azimuths = densities.shape[0], n = densities.shape[1];
  if (n < 2) throw Problem{"has fields that do not fit together"};
  std::vector<double> d(n), theta(n);
  for (uint64_t i = 0; i < n; ++i) {
    theta[i] = pi / 2 * sqr(double(i) / double(n - 1));
    for (uint64_t a = 0; a < azimuths; ++a)
      d[i] += double(std::max(densities.at(a * n + i), 0.0f)) / double(azimuths);
  }
  const auto slope = [&](uint64_t i) { return d[i] * sqr(sqr(std::cos(theta[i]))); };
  if (!(d[0] > 0)) return {};
  uint64_t k = 1;
  while (k + 1 < n && slope(k) > d[0] / 4) ++k;
  const double before = slope(k - 1), after = slope(k);
  const double between = before > after ? (before - d[0] / 4) / (before - after) : 1;
  const double half =
      std::clamp(lerp(theta[k - 1], theta[k], std::clamp(between, 0.0, 1.0)), 0.0, 1.5);
  Peak p;
  p.width = float(std::clamp(std::tan(half), 1e-3, 1.0));
  double inside = 0, all = 0;
  for (uint64_t i = 0; i + 1 < n; ++i) {
    const double at = 0.5 * (theta[i] + theta[i + 1]);
    const double area = 0.5 * (d[i] + d[i + 1]) * std::sin(2 * at) * (theta[i + 1] - theta[i]);
    all += area;
    if (std::tan(at) < 4 * double(p.width)) inside += area;
  }
  p.share = all > 0 ? float(std::clamp(inside / all * 17 / 16, 0.0, 1.0)) : 0;
  return p;
}

std::string path_of(const std::string& folder, const std::string& name) {
  const ConfinedPath path = confined_path(folder, name);
  if (path.is_fine()) return path.path;
  const std::string beside = path_beside(folder, name);
  if (beside.empty()) throw Problem{path.problem};
  return beside;
}

}  // namespace

Material measured_material(const std::string& folder, const std::string& name,
                           WarningLog& warnings) {
  Material m;
  m.base_color.value = Rgb{0.5f};
  const std::string shown = "measured '" + printable(name) + "': ";
  try {
    const TensorFile file(read_file(path_of(folder, name), max_measured_bytes));
    const Rgb colour = colour_of(file);
    const Peak peak = peak_of(file.field("ndf", 2));
    m.kind = MaterialKind::metallic_roughness;
    m.base_color.value = colour;
    m.roughness = {peak.width, no_texture, 1};
    m.roughness_meaning = RoughnessMeaning::alpha;
    m.metallic.value = peak.share;
    m.specular.value = 0;
    warnings.add(shown +
                 fmt::format("shown as {:.0f} % metal of width {:.2g}, the rest diffuse, of "
                             "its mean colour",
                             100 * peak.share, peak.width));
  } catch (const Problem& p) {
    warnings.add(shown + p.text + "; diffuse grey replaces it");
  } catch (const InputError& e) {
    warnings.add(shown + e.reason() + "; diffuse grey replaces it");
  }
  return m;
}

}  // namespace troffer
