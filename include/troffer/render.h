/// @file
/// Renders pictures of a scene.
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

/// Options of the method "kj92" (Kok & Jansen, 1992). Options without a value take the program's
/// defaults. Errors and changes are relative to the unoccluded light.
struct Kj92Options {
  std::optional<double> variance{};     ///< allowed standard error of a viewing ray, 0 to 1000
  std::optional<int> most_rays{};       ///< most shadow rays per source and viewing ray, 1 to 65536
  std::optional<double> mean_change{};  ///< stops if the mean changes by less, 0 to 1; 0: never
  std::optional<int> level_difference{};  ///< of neighbouring leaves, 0 to 24
  std::optional<int> probe_rays{};  ///< to sources that seem fully hidden or visible, 1 to 1024
  bool has_coherence = true;        ///< reuses sample patterns from hit to hit
  bool uses_ratio = false;          ///< multiplies the visible share by the exact unoccluded light
  bool has_selection = true;        ///< the radiosity solution selects the sources
  std::vector<std::string> select{};  ///< names of the only lights to sample; empty: all
};

/// Options for computing light, shared by pictures and measurements.
struct LightOptions {
  std::string method = "certified";  ///< one of method_names()
  std::string indirect = "auto";     ///< reflected light: "auto", "cells", "radiosity", "none"
  double error = 0.01;               ///< certified: allowed relative error, above 0, at most 1
  int spp = 0;                       ///< samples per pixel or point; 0: the method's default
  int depth = -1;                    ///< path: largest number of bounces; -1: no limit
  int threads = 0;                   ///< 0: all cores; any number gives the same result
  std::uint64_t seed = 0;            ///< of the random numbers; another seed gives other noise
  Kj92Options kj92{};                ///< options of kj92
};

/// Options of a picture. Options that belong to other methods have no effect.
struct RenderOptions {
  LightOptions light{};                      ///< options for computing light
  int width = 0;                             ///< pixels; 0: from the camera
  int height = 0;                            ///< pixels; 0: from the camera
  std::optional<std::array<int, 4>> crop{};  ///< x0, y0, x1, y1 in pixels; x1 and y1 exclusive
  int max_spp = 0;                   ///< most viewing rays of a pixel; 0: the method's default
  std::optional<int> shadow_rays{};  ///< fixed: per source; kj92: initial ones per source
  std::vector<std::string> aovs{};   ///< further layers, named as in layer_names()
  double time_limit = 0;             ///< seconds; 0: none
  double error_limit = 0;            ///< estimated error at which to stop; 0: none
};

/// Statistics of a picture: size, time, estimated error and rays. Seconds are wall-clock time.
struct RenderStatistics {
  int width = 0;                        ///< pixels
  int height = 0;                       ///< pixels
  std::string end{};                    ///< "complete", "good_enough", "out_of_time", "stopped"
  double build_seconds = 0;             ///< ray tracer and light trees; 0 if they existed
  double preprocess_seconds = 0;        ///< spent on radiosity
  double render_seconds = 0;            ///< spent on everything that follows
  double estimated_error = 0;           ///< RMS standard error of pixels over mean luminance as shown
  double viewing_error = 0;             ///< the same, from the spread of viewing rays
  double share_above = 0;               ///< share of pixels whose standard error exceeds 1 %
  double share_done = 0;                ///< share of the work that was done
  std::size_t gaps_filled = 0;          ///< pixels that a time limit left to quick paths
  std::size_t unsampled = 0;            ///< pixels without samples after a stop; black
  std::uint64_t viewing_rays = 0;       ///< rays from the camera
  std::uint64_t surrogate_samples = 0;  ///< viewing rays that only look up cells and fits
  std::uint64_t extension_rays = 0;     ///< closest-hit rays after the viewing ray
  std::uint64_t shadow_rays = 0;        ///< visibility rays
  std::uint64_t nan_samples = 0;        ///< non-finite samples, which count as black
  std::uint64_t lit_certified = 0;      ///< pairs of hit and source, proved lit
  std::uint64_t dark_certified = 0;     ///< pairs proved dark
  std::uint64_t masked = 0;             ///< pairs answered by coverage masks
  std::uint64_t mixed = 0;              ///< pairs answered by rays
  bool is_by_paths = false;             ///< certified: paths replaced the cache cells
  std::uint64_t cells = 0;              ///< cache cells; 0 if the method makes none
  std::uint64_t cell_rays = 0;          ///< rays that fill the cache
  double cell_size = 0;                 ///< size of cache cells, metres
  double cell_seconds = 0;              ///< spent on the cache
  double cell_bytes = 0;                ///< memory of the cache, bytes
};

/// A view of pixels that a picture owns.
struct PixelView {
  const float* data = nullptr;    ///< first number; valid as long as a Picture shares the pixels
  int width = 0;                  ///< columns
  int height = 0;                 ///< rows; the first is on top
  int channels = 3;               ///< numbers per pixel: 1 or 3
  std::ptrdiff_t pixel_step = 3;  ///< distance of neighbours in a row, floats
};

/// A finished picture with its layers. Copies share the pixels.
class Picture {
 public:
  struct Impl;
  /// For the library's own use.
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
  /// A layer. @throws UsageError if no layer has that name
  PixelView layer(const std::string& name) const;
  /// Size, time, estimated error and numbers of rays.
  const RenderStatistics& statistics() const;
  /// False after a stop or a time limit.
  bool is_complete() const;
  /// Writes .png (converted by `display`), .exr (with all layers), .hdr or .pfm (linear).
  /// @throws UsageError as write_image()
  /// @throws EnvironmentError as write_image()
  void save(const std::string& path, const DisplayOptions& display = {}) const;
  /// The bytes of a PNG file.
  std::vector<std::uint8_t> png(const DisplayOptions& display = {}) const;

 private:
  std::shared_ptr<const Impl> impl_;
};

/// Renders a picture as a camera sees the scene. The result is the same, bit for bit, for any
/// number of threads, and equals that of the program.
/// @throws UsageError for options that contradict each other or the scene
/// @throws InputError for a camera whose numbers overflow
/// @throws EnvironmentError if memory runs out
Picture render(Scene& scene, const Camera& camera, const RenderOptions& options = {},
               const Progress& progress = {});

/// Renders a picture as Scene::camera() sees the scene.
Picture render(Scene& scene, const RenderOptions& options = {}, const Progress& progress = {});

/// Names of all methods.
std::vector<std::string> method_names();

/// Names of all layers that RenderOptions::aovs takes.
std::vector<std::string> layer_names();

}  // namespace troffer::api
