// The commands of the program: their options, and one function each, which returns the exit status.
// Failures throw (base/error.h), and run() reports them. Options hold values as typed; units are
// those of `troffer help`.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/grid_points.h"
#include "app/lasting_options.h"
#include "import/import_options.h"
#include "lighting/daylight_options.h"
#include "render/radiosity.h"
#include "render/render.h"
#include "report/daylight_glare.h"

namespace CLI {
class App;
}

namespace troffer {

class ProcessGroup;

constexpr int exit_done = 0;
constexpr int exit_bad_input = 1;
constexpr int exit_usage = 2;
constexpr int exit_interrupted = 130;

// The choice of a scene, as typed.
struct SceneChoice {
  std::string file;
  ImportOptions options;
  std::string up;                      // direction for parse_up(); empty: decide_up()
  std::shared_ptr<const Scene> scene;  // an already loaded scene; null: read the file
};
void add_scene_choice(CLI::App& app, SceneChoice& choice);  // adds its options

struct RenderCommand {
  SceneChoice scene;
  std::vector<std::string> outputs;
  RenderOptions options;
  std::string method = "certified";
  std::string camera;
  std::vector<std::string> lights;
  DaylightOptions daylight;
  std::string stats;
  std::string exposure;  // stops, auto, or empty: automatic where needed
  std::string tone_map = "filmic";
  std::vector<std::string> selected_lights;  // kj92; empty: all lights
  std::string solution;                      // kj92, certified: file, or empty
  std::string eye, target;                   // "x,y,z"; override the camera
  float fov_deg = 60;
  LastingOptions lasting;
  bool has_preview = false;  // outputs are also written during the rendering
  bool explains = false;     // prints the plan before rendering
  bool is_quiet = false;
};
int run_render(RenderCommand command);

struct MergeCommand {
  std::string output;
  std::vector<std::string> parts;
  std::string exposure, tone_map = "filmic";  // as in RenderCommand
  bool is_quiet = false;
};
void add_merge(CLI::App& app, MergeCommand& command);  // adds its options
int run_merge(const MergeCommand& command);

struct CompareCommand {
  std::string image, reference;
  std::string map;         // FLIP error map to write, or empty
  std::string difference;  // absolute difference to write, or empty
  bool is_json = false;
};
void add_compare(CLI::App& app, CompareCommand& command);  // adds its options
int run_compare(const CompareCommand& command);

// A file ending in .exr, .hdr or .pfm is a fisheye picture that is rated as it is.
struct GlareCommand {
  SceneChoice scene;
  std::string eye, target, camera;  // "x,y,z", "x,y,z", name
  int side = 800;                   // pixels
  std::string task;                 // "x,y" in pixels, or empty
  GlareSettings settings;
  bool leaves_low_light = false;
  std::string output;  // picture, or empty
  bool is_json = false;
  std::string method = "path";
  double error = 0.02;
  std::vector<std::string> lights;
  DaylightOptions daylight;
  int threads = 0;
  uint64_t seed = 0;
  bool is_quiet = false;
};
void add_glare(CLI::App& app, GlareCommand& command);  // adds its options
int run_glare(GlareCommand command);

struct MeasureCommand {
  SceneChoice scene;
  std::string points, output;  // point file, or empty
  GridChoice grid;
  std::string method = "certified";
  std::vector<std::string> lights;
  DaylightOptions daylight;
  std::string solution;  // kj92, certified: file, or empty
  int spp = 0;           // 0: default of the method
  int depth = -1;
  double error = 0.01;  // certified
  Indirect indirect = Indirect::automatic;
  int threads = 0;
  uint64_t seed = 0;
  bool is_quiet = false;
};
int run_measure(const MeasureCommand& command);

struct RadiosityCommand {
  SceneChoice scene;
  std::vector<std::string> outputs;
  RadiosityOptions options;
  std::vector<std::string> lights;
  DaylightOptions daylight;
  bool makes_cells = false;  // makes cells for certified instead of a solution
  std::string stats;
  int threads = 0;
  bool is_quiet = false;
};
void add_radiosity(CLI::App& app, RadiosityCommand& command);  // adds its options
int run_radiosity(const RadiosityCommand& command);

struct ViewCommand {
  SceneChoice scene;
  int port = 0;      // 0: any free port
  std::string size;  // WxH, or empty
  std::string camera;
  std::string annual;  // folder of `troffer annual`, or empty
  std::string method = "certified";
  double error = 0.02;
  std::vector<std::string> lights;
  DaylightOptions daylight;
  int threads = 0;
  uint64_t seed = 0;
  bool is_quiet = false;
};
void add_view(CLI::App& app, ViewCommand& command);  // adds its options
int run_view(const ViewCommand& command);

struct InfoCommand {
  SceneChoice scene;
  std::string polar;  // file for the polar curves of a luminaire; empty: none
  bool is_json = false;
};
int run_info(const InfoCommand& command);

struct ConvertCommand {
  SceneChoice scene;
  std::string output;
  bool is_quiet = false;
};
void add_convert(CLI::App& app, ConvertCommand& command);  // adds its options
int run_convert(const ConvertCommand& command);

struct BakeCommand {
  SceneChoice scene;
  std::string output;
  std::string hdr = "exr";  // format of the separate pages: exr, hdr, none
  bool has_vertex_colors = false, is_unlit = false, is_emissive = false;
  double texels_per_metre = 0;  // 0: as many as fit one page of --resolution
  int resolution = 512, largest_page = 4096, gutter = 2, spp = 64;
  std::string exposure = "auto";
  std::string method = "certified", solution, indirect = "auto";
  double error = 0.01;
  int depth = -1, threads = 0;
  std::vector<std::string> lights;
  DaylightOptions daylight;
  uint64_t seed = 0;
  bool is_quiet = false;
};
void add_bake(CLI::App& app, BakeCommand& command);  // adds its options
// Throws UsageError for contradictory options, and warns of those that the method does not use.
int check_and_bake(const CLI::App& command_line, BakeCommand command);

// Called with the scene without images, before they are read; not called for scenes without images.
using ShowShapes = std::function<void(const Scene& scene)>;

// Up direction of a scene, for the command that loads it.
struct UpUse {
  bool is_needed = false;  // true if the command itself needs it, not only its lights
  UpDecision decision;     // set by load_scene()
};

// Reads the scene of the file, with a progress bar.
Scene read_scene(const SceneChoice& choice, bool is_quiet);

// Returns the scene of a command: imported, with the light of `daylight` (null: unchanged), and
// only `lights` emitting (all if empty). Prints warnings to standard error unless is_quiet.
Scene load_scene(const SceneChoice& choice, const std::vector<std::string>& lights,
                 const DaylightOptions* daylight, bool is_quiet, UpUse& up,
                 const ShowShapes& show_shapes = {});

// Decides the up direction by --up, or else by the scene as read.
UpDecision up_of(const SceneChoice& choice, const Scene& scene);
// Prints the decision to standard error, unless the user or the format states it, or a warning
// does.
void tell_up(const UpDecision& decision);
// Warns, unless is_quiet, of luminaires outside of the room or inside an object.
void warn_of_misplaced(const PreparedScene& scene, bool is_quiet);

// Parses the name of a method. Throws UsageError for unknown names.
Method parse_method(const std::string& name);
Indirect parse_indirect(const std::string& name);  // throws UsageError for unknown names
// Accepts an empty text, "auto" or stops. Throws UsageError for others.
void check_exposure(const std::string& text);

// Throws UsageError if options belong to another method.
void check_method(Method method, Indirect indirect, const std::string& solution);

// Warns, unless is_quiet, of every given option of `command` that its method does not use.
void warn_of_unused_options(const CLI::App& command, Method method, bool is_quiet);

// Warns of lights that the preprocessing leaves out.
void warn_of_lights_left_out(const PreparedScene& scene, bool is_quiet);

// Prepares what `method` needs, with a progress bar: the radiosity solution of the file `solution`,
// or a new one if that is empty, and the selected sources. Null for methods that need nothing, and
// if interrupted.
std::unique_ptr<Preparation> prepare_method(const PreparedScene& scene, Method method,
                                            const Kj92Settings& settings, Indirect indirect,
                                            const std::string& solution, int threads, bool is_quiet,
                                            const StopFlag& stop);

// Parses the command line and runs it: the whole program except main().
int run(int argc, const char* const* argv, ProcessGroup* group = nullptr);

}  // namespace troffer
