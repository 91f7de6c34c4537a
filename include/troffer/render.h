/// @file
/// Pictures of a scene.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "troffer/image.h"
#include "troffer/scene.h"

namespace troffer::api {

/// Options of the method "kj92" (Kok & Jansen, 1992). None: what the program does by itself.
struct Kj92Options {
  std::optional<double> variance{};       ///< allowed standard error of a viewing ray, 0 to 1000
  std::optional<int> most_rays{};         ///< shadow rays per source and viewing ray, 1 to 65536
  std::optional<double> mean_change{};    ///< stop where the mean changes by less, 0 to 1; 0: never
  std::optional<int> level_difference{};  ///< levels between neighbouring cells, 0 to 24
  std::optional<int> probe_rays{};        ///< to sources that seem hidden or visible, 1 to 1024
  bool has_coherence = true;              ///< reuse the pattern of the viewing ray before
  bool uses_ratio = false;                ///< multiply the visible share by the exact light
  bool has_selection = true;              ///< the radiosity solution selects the sources
  std::vector<std::string> select{};      ///< only these lights may be sampled; empty: all
};

/// Options of the computation of light, for pictures and measurements.
struct LightOptions {
  std::string method = "certified";  ///< "certified", "kj92", "fixed", "path" …
  std::string indirect = "auto";     ///< reflected light: "auto", "cells", "radiosity", "none"
  double error = 0.01;               ///< certified: allowed relative error, above 0, at most 1
  int spp = 0;                       ///< samples per pixel or point; 0: what the method takes
  int depth = -1;                    ///< path: most bounces; -1: no limit
  int threads = 0;                   ///< 0: all cores; the result is the same for any number
  std::uint64_t seed = 0;            ///< another seed gives other noise
  Kj92Options kj92{};                ///< kj92 alone
};

/// Options of a picture. Options of other methods than the chosen one have no effect.
struct RenderOptions {
  LightOptions light{};                      ///< how light is computed
  int width = 0;                             ///< pixels; 0: by the camera
  int height = 0;                            ///< pixels; 0: by the camera
  std::optional<std::array<int, 4>> crop{};  ///< x0, y0, x1, y1 in pixels; x1 and y1 exclusive
  int max_spp = 0;                           ///< most viewing rays of a pixel; 0: by the method
  std::optional<int> shadow_rays{};          ///< fixed: per source; kj92: the first ones
  std::vector<std::string> aovs{};           ///< layers: "albedo", "normal", "depth", "direct" …
  double time_limit = 0;                     ///< seconds; 0: none
  double error_limit = 0;                    ///< stop at this estimated error; 0: none
};

/// Facts about the making of a picture. Seconds are those of the clock.
struct RenderStatistics {
  int width = 0;                        ///< pixels
  int height = 0;                       ///< pixels
  std::string end{};                    ///< "complete", "good_enough", "out_of_time", "stopped"
  double build_seconds = 0;             ///< ray tracer and light trees; 0: they were there
  double preprocess_seconds = 0;        ///< radiosity
  double render_seconds = 0;            ///< all that follows
  double estimated_error = 0;           ///< root mean square over pixels, over mean luminance
  double viewing_error = 0;             ///< the same, by the spread of viewing rays
  double share_above = 0;               ///< of pixels with a standard error above 1 %
  double share_done = 0;                ///< of the work
  std::size_t gaps_filled = 0;          ///< pixels that a time limit left to a first estimate
  std::size_t unsampled = 0;            ///< pixels without a sample after a stop; black
  std::uint64_t viewing_rays = 0;       ///< rays from the camera
  std::uint64_t surrogate_samples = 0;  ///< viewing rays that look up what is known
  std::uint64_t extension_rays = 0;     ///< closest-hit rays after the viewing ray
  std::uint64_t shadow_rays = 0;        ///< visibility rays
  std::uint64_t nan_samples = 0;        ///< samples that were not finite and count as black
  std::uint64_t lit_certified = 0;      ///< pairs of hit and source that are proved lit
  std::uint64_t dark_certified = 0;     ///< pairs that are proved dark
  std::uint64_t masked = 0;             ///< pairs answered by an exact mask
  std::uint64_t mixed = 0;              ///< pairs answered by rays
  bool is_by_paths = false;             ///< certified: paths replaced the cache cells
  std::uint64_t cells = 0;              ///< cache cells; 0 where the method makes none
  std::uint64_t cell_rays = 0;          ///< rays that fill the cache
  double cell_size = 0;                 ///< metres
  double cell_seconds = 0;              ///< spent on the cache
  double cell_bytes = 0;                ///< memory of the cache
};

/// A view of numbers that a picture owns.
struct PixelView {
  const float* data = nullptr;    ///< the first number; valid as long as the picture
  int width = 0;                  ///< columns
  int height = 0;                 ///< rows, the first on top
  int channels = 3;               ///< numbers per pixel: 1 or 3
  std::ptrdiff_t pixel_step = 3;  ///< floats from a pixel to the next of its row
};

/// A finished picture with its layers. Copies share the pixels.
class Picture {
 public:
  struct Impl;
  /// For the library.
  explicit Picture(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}

  /// Columns.
  int width() const;
  /// Rows.
  int height() const;
  /// Linear light, 3 channels.
  PixelView pixels() const;
  /// A copy of the pixels.
  Image image() const;
  /// Names of the further layers, in the order of RenderOptions::aovs.
  std::vector<std::string> layer_names() const;
  /// Returns true if there is a layer of that name.
  bool has_layer(const std::string& name) const;
  /// A layer. @throws UsageError where there is none of that name
  PixelView layer(const std::string& name) const;
  /// Facts about its making.
  const RenderStatistics& statistics() const;
  /// False after a stop or a time limit.
  bool is_complete() const;
  /// Writes .png (through `display`), .exr (with all layers), .hdr or .pfm (linear).
  /// @throws UsageError, EnvironmentError as write_image()
  void save(const std::string& path, const DisplayOptions& display = {}) const;
  /// The bytes of a PNG file.
  std::vector<std::uint8_t> png(const DisplayOptions& display = {}) const;

 private:
  std::shared_ptr<const Impl> impl_;
};

/// Renders what a camera sees. The result is the same, bit for bit, for any number of threads, and
/// the same as the program's.
/// @throws UsageError for options that contradict each other or the scene
/// @throws InputError for a camera whose numbers overflow
/// @throws EnvironmentError where memory runs out
Picture render(Scene& scene, const Camera& camera, const RenderOptions& options = {},
               const Progress& progress = {});

/// The same through the scene's first camera, or one that frames the scene.
Picture render(Scene& scene, const RenderOptions& options = {}, const Progress& progress = {});

/// Names of all methods.
std::vector<std::string> method_names();

/// Names of all layers that RenderOptions::aovs takes.
std::vector<std::string> layer_names();

}  // namespace troffer::api
