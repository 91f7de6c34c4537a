// The methods that troffer knows, and what each is made of: the one table and the one factory
// (methods.cpp).
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
#include "transport/integrator.h"

namespace troffer {

struct MethodRow;
struct IndirectRow;

// A row of the table of methods. Those that code names are here; find() knows all.
class Method {
 public:
  static const Method certified, kj92, fixed, path;

  static std::optional<Method> find(std::string_view name);
  // All names, as a sentence lists them.
  static std::string names();

  const MethodRow& row() const;
  bool operator==(const Method&) const = default;

 private:
  friend struct MethodTable;
  constexpr explicit Method(uint8_t row) : row_(row) {}
  uint8_t row_;
};
inline constexpr Method Method::certified{0}, Method::kj92{1}, Method::fixed{2}, Method::path{3};

// How light that was reflected before is computed, likewise. automatic: as suits the method.
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

// What users may choose about a method; each takes what it knows.
struct MethodSettings {
  Indirect indirect = Indirect::automatic;
  int shadow_rays = 64;       // fixed: per source and viewing ray
  double error = 0.01;        // certified: see certified_settings
  int viewing_rays = 1;       // certified: of a pixel, or estimates of a measuring point
  TreeSamplingOptions trees;  // kj92
  // certified: of a pixel, all in all, where they are not left to the method; 0: they are
  int most_viewing_rays = 0;
  bool is_refined = false;  // certified: pixels of a picture get further ones where they want them
  bool measures_by_paths = false;  // certified: at sensors, paths in place of cells
  int depth = -1;                  // path: most bounces; -1 = unlimited
  int threads = 0;                 // for what is built; 0 = all cores

  bool is_direct_only() const { return indirect == Indirect::none; }
};

// What cells are made from, where a method takes them, and what is told of them.
struct CellInput {
  CellPilot pilot;
  const PictureView* view = nullptr;  // null: no picture is made
  uint64_t seed = 0;
  std::function<void(double)> progress;  // 0 to 1; may be empty
  const StopFlag& stop;
  Counters counters;
  CellStatistics statistics;
  CellStore* store = nullptr;     // make_cells
  ProcessGroup* group = nullptr;  // others that make the same; may be null
  // Without a view: where more are wanted, there is no integrator.
  double most_cells = std::numeric_limits<double>::infinity();
  // How points gather from them, where it is to points: then their rays look closely, too
  // (CellMap::look_closely).
  GatheringPoints points{};
  // Once set, preparation ends as soon as it can (CellBuilderOptions::enough). Null: never.
  const StopFlag* enough = nullptr;
  // Result, if `enough` is given: the same light by fewer rays and with more noise, for pixels that
  // a time limit leaves without samples. It exists as soon as there are cells, even if `stop` then
  // prevents the integrator.
  std::unique_ptr<Integrator> quick{};
};

// What a method is made from. radiosity, cells: null where there is none; radiosity is copied.
struct MethodInput {
  const PreparedScene& scene;
  const MethodSettings& settings;
  const RadiosityLight* radiosity = nullptr;
  CellInput* cells = nullptr;
};

struct MethodRow {
  std::string_view name;
  std::unique_ptr<Integrator> (*make)(const MethodInput&);
  // Shadow rays, about and at most, that a viewing ray takes in a scene of so many lights.
  double (*rays_per_sample)(const MethodSettings&, size_t lights);

  // How the method computes indirect light, unless `none` is asked for.
  Indirect usual_indirect = Indirect::none;
  // Computes no light that was reflected before.
  bool is_direct_only = false;
  // Needs the radiosity preprocessing even where no indirect light is asked for.
  bool always_needs_radiosity = false;

  int widest_tile = 16;  // pixels; as long as a tile does not take more rays than
  double most_rays_per_tile = 1e300;
  // The noise of a pixel, though not its mean, depends on what else is in its batch: it is the same
  // in a crop only if batches are.
  bool has_noise_of_batch = false;
  // Errors are compared with what is usual in the picture where less light arrives.
  bool wants_typical = false;
  // Pixels of a crop are to have the values that they have in the whole picture.
  bool is_same_in_crops = true;
  int refinement = 1;                  // most viewing rays of a pixel, in --spp, by default
  int usual_measuring_samples = 4096;  // per measuring point
  // … or as many as a quarter of MethodSettings::error wants.
  bool measures_to_error = false;
  int rays_of_measuring_sample = 1;  // one estimate stands for so many of these samples
  // Light straight from sources, which errs by far less, takes part in every so many-th of them,
  // where it is measured to an error; a power of two.
  int measuring_samples_per_direct = 1;
};

struct IndirectRow {
  std::string_view name;
  bool needs_radiosity = false;
  bool needs_cells = false;
};

// How `method` computes indirect light: `none` if that is asked for, else its usual way.
Indirect chosen_indirect(Method method, Indirect indirect);
// The radiosity preprocessing is needed first.
bool needs_radiosity(Method method, Indirect indirect);

// Cells are made with the method: it needs CellInput.
bool needs_cells(Method method, Indirect indirect);

// Throws EnvironmentError if memory runs out. Null where CellInput::stop was set meanwhile, or by
// CellInput::most_cells.
std::unique_ptr<Integrator> make_integrator(Method method, const MethodInput& input);

}  // namespace troffer
