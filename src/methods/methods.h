// The methods of computing light that troffer knows, and what each is made of: one table and one
// factory (methods.cpp). Used by render/ and view/.
//
// A method is walk × direct light × indirect light (wave_integrator.h), or an integrator of its
// own.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "gather/cell_builder.h"
#include "gather/gather_records.h"
#include "kj92/radiosity_light.h"
#include "kj92/tree_sampling.h"
#include "methods/method_plan.h"
#include "transport/integrator.h"

namespace troffer {

struct MethodRow;
struct IndirectRow;

// Names a row of the table of methods. The constants are the methods that code refers to; find()
// knows all by name.
class Method {
 public:
  static const Method certified, kj92, fixed, path, cached_path;

  static std::optional<Method> find(std::string_view name);
  // Returns all names as an enumeration in a sentence: "a, b or c".
  static std::string names();

  const MethodRow& row() const;
  bool operator==(const Method&) const = default;

 private:
  friend struct MethodTable;
  constexpr explicit Method(uint8_t row) : row_(row) {}
  uint8_t row_;
};
inline constexpr Method Method::certified{0}, Method::kj92{1}, Method::fixed{2}, Method::path{3},
    Method::cached_path{4};

// Names a way of computing reflected light. automatic: the method's usual way.
class Indirect {
 public:
  static const Indirect automatic, none, radiosity, cells;

  static std::optional<Indirect> find(std::string_view name);

  const IndirectRow& row() const;
  bool operator==(const Indirect&) const = default;

 private:
  friend struct MethodTable;
  constexpr explicit Indirect(uint8_t row) : row_(row) {}
  uint8_t row_;
};
inline constexpr Indirect Indirect::automatic{0}, Indirect::none{1}, Indirect::radiosity{2},
    Indirect::cells{3};

// Options of a method that users may set. Each method reads those that it knows.
struct MethodSettings {
  Indirect indirect = Indirect::automatic;
  int shadow_rays = 64;       // fixed: rays per source and viewing ray
  double error = 0.01;        // certified: asked error (certified_settings())
  int viewing_rays = 1;       // certified: per pixel; at measuring points: estimates per point
  TreeSamplingOptions trees;  // kj92
  // certified: limit of viewing rays per pixel that the user set; 0: the method decides
  int most_viewing_rays = 0;
  bool is_refined = false;  // certified: pixels may get further viewing rays where they need them
  bool measures_by_paths = false;  // certified: indirect light at sensors by paths instead of cells
  int depth = -1;                  // path: most scatterings; -1: no limit
  int threads = 0;                 // for preparation; 0: all cores

  bool is_direct_only() const { return indirect == Indirect::none; }
};

// Input for methods that use cells, and what they report about the cells.
struct CellInput {
  CellPilot pilot;
  const PictureView* view = nullptr;  // null: there is no picture
  uint64_t seed = 0;
  std::function<void(double)> progress;  // from 0 to 1; may be empty
  const StopFlag& stop;
  Counters counters;
  CellStatistics statistics;
  CellStore* store = nullptr;     // cells kept between runs (make_cells()); may be null
  ProcessGroup* group = nullptr;  // processes that make the same cells together; may be null
  // Without a view, limit of the number of cells: beyond it make_integrator() returns null.
  double most_cells = std::numeric_limits<double>::infinity();
  // Gathering at measuring points. If set, rays also resolve sub-cell features: they do not read
  // cells there, but sample lights and go on (CellMap::resolve_narrow).
  GatheringPoints points{};
  // Once set, preparation ends as soon as it can (CellBuilderOptions::enough). Null: never.
  const StopFlag* enough = nullptr;
  // Result, set if `enough` is not null: a cheaper, noisier integrator of the same light. GapFiller
  // uses it for pixels that a time limit leaves without samples. It is set as soon as there are
  // cells, even if `stop` later makes make_integrator() return null.
  std::unique_ptr<Integrator> quick{};
  // Result: decisions made after the plan, when there are cells.
  std::vector<PlannedPart> decisions{};
};

// Input of plan_method() and make_integrator(). radiosity and cells may be null if the method does
// not need them. The integrator keeps a copy of *radiosity.
struct MethodInput {
  const PreparedScene& scene;
  const MethodSettings& settings;
  const RadiosityLight* radiosity = nullptr;
  CellInput* cells = nullptr;
};

struct MethodRow {
  std::string_view name;
  MethodPlan (*plan)(const MethodInput&);
  std::unique_ptr<Integrator> (*make)(const MethodPlan&, const MethodInput&);
  // Returns the number of shadow rays that a viewing ray takes in a scene with this many lights:
  // approximate, and an upper limit.
  double (*rays_per_sample)(const MethodSettings&, size_t lights);

  // Way of computing indirect light, unless `none` is asked for.
  Indirect usual_indirect = Indirect::none;
  // True if the method computes no reflected light.
  bool is_direct_only = false;
  // True if the method needs the radiosity preprocessing even without indirect light.
  bool always_needs_radiosity = false;

  int widest_tile = 16;  // side of a tile, pixels
  // Tiles are smaller where they would take more shadow rays than this.
  double most_rays_per_tile = 1e300;
  // True if the noise of a pixel, though not its mean, depends on what else is in its batch. A crop
  // then has the same noise only if it is cut into the same batches.
  bool has_noise_of_batch = false;
  // True if the allowed error of dark pixels is relative to the picture's typical luminance.
  bool uses_typical_luminance = false;
  // True if the pixels of a crop must have the values that they have in the whole picture.
  bool is_same_in_crops = true;
  // 1: pixels get spp viewing rays and no more. Above 1: pixels are refined up to
  // most_viewing_rays(). In pictures of direct light alone, pixels with surrogate samples then get
  // at least this many times spp rays.
  int refinement = 1;
  int usual_measuring_samples = 4096;  // per measuring point
  // True if points are instead sampled until their relative error is a quarter of
  // MethodSettings::error.
  bool measures_to_error = false;
  // Shadow rays per source of one estimate at a measuring point; each counts as one sample.
  int rays_of_measuring_sample = 1;
  // Direct light takes part in every n-th estimate when measuring to an error, because it varies
  // much less than indirect light. A power of two.
  int measuring_samples_per_direct = 1;
};

struct IndirectRow {
  std::string_view name;
  bool needs_radiosity = false;
  bool needs_cells = false;
};

// Returns `none` if that is asked for, else the method's usual way.
Indirect chosen_indirect(Method method, Indirect indirect);
// True if the radiosity preprocessing must run first.
bool needs_radiosity(Method method, Indirect indirect);

// True if the method makes cells: it then needs CellInput.
bool needs_cells(Method method, Indirect indirect);

// Decides how the method computes the light. Traces no rays except test paths.
MethodPlan plan_method(Method method, const MethodInput& input);
// Prepares what the plan asks for, such as cells and gathers, and makes the integrator. Returns
// null if CellInput::stop was set meanwhile, or if more than CellInput::most_cells cells would be
// needed. Throws EnvironmentError if memory runs out.
std::unique_ptr<Integrator> make_integrator(Method method, const MethodPlan& plan,
                                            const MethodInput& input);
// Plans, then makes the integrator.
std::unique_ptr<Integrator> make_integrator(Method method, const MethodInput& input);

}  // namespace troffer
