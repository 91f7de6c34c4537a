// The commands of the program, one function each. They return the exit status; failures throw
// (base/error.h) and are reported by run().
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

namespace CLI {
class App;
}

namespace troffer {

class ProcessGroup;

constexpr int exit_done = 0;
constexpr int exit_bad_input = 1;
constexpr int exit_usage = 2;
constexpr int exit_interrupted = 130;

// Which scene, as typed.
struct SceneChoice {
  std::string file;
  ImportOptions options;
  std::string up;                      // parse_up()'s, or empty: decide_up()'s
  std::shared_ptr<const Scene> scene;  // as it was read before; null: it is to be read
};
void add_scene_choice(CLI::App& app, SceneChoice& choice);  // its options

struct RenderCommand {
  SceneChoice scene;
  std::vector<std::string> outputs;
  RenderOptions options;
  std::string method = "certified";
  std::string camera;
  std::vector<std::string> lights;
  DaylightOptions daylight;
  std::string stats;
  std::string exposure;  // stops, auto, or empty: by itself
  std::string tone_map = "filmic";
  std::vector<std::string> selected_lights;  // kj92: empty: all may be sampled
  std::string solution;                      // kj92, certified: file, or empty
  std::string eye, target;                   // "x,y,z"; override the camera
  float fov_deg = 60;
  LastingOptions lasting;
  bool has_preview = false;  // outputs are written while the work is under way too
  bool is_quiet = false;
};
int run_render(RenderCommand command);

struct MergeCommand {
  std::string output;
  std::vector<std::string> parts;
  std::string exposure, tone_map = "filmic";  // as RenderCommand's
  bool is_quiet = false;
};
void add_merge(CLI::App& app, MergeCommand& command);  // its options
int run_merge(const MergeCommand& command);

struct CompareCommand {
  std::string image, reference;
  std::string map;         // FLIP error map to write, or empty
  std::string difference;  // absolute difference to write, or empty
  bool is_json = false;
};
int run_compare(const CompareCommand& command);

struct MeasureCommand {
  SceneChoice scene;
  std::string points, output;  // points: a file, or empty
  GridChoice grid;
  std::string method = "certified";
  std::vector<std::string> lights;
  DaylightOptions daylight;
  std::string solution;  // kj92, certified: file, or empty
  int spp = 0;           // 0 = by the method
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
  bool makes_cells = false;  // for certified, instead of a solution
  std::string stats;
  int threads = 0;
  bool is_quiet = false;
};
void add_radiosity(CLI::App& app, RadiosityCommand& command);  // its options
int run_radiosity(const RadiosityCommand& command);

struct ViewCommand {
  SceneChoice scene;
  int port = 0;      // 0: any
  std::string size;  // WxH, or empty
  std::string camera;
  std::string method = "certified";
  double error = 0.02;
  std::vector<std::string> lights;
  DaylightOptions daylight;
  std::string tev;  // HOST:PORT, or empty
  int threads = 0;
  uint64_t seed = 0;
  bool is_quiet = false;
};
void add_view(CLI::App& app, ViewCommand& command);  // its options
int run_view(const ViewCommand& command);

struct InfoCommand {
  SceneChoice scene;
  std::string polar;  // a drawing to make of a luminaire; empty: none
  bool is_json = false;
};
int run_info(const InfoCommand& command);

struct ConvertCommand {
  SceneChoice scene;
  std::string output;
  bool is_quiet = false;
};
void add_convert(CLI::App& app, ConvertCommand& command);  // its options
int run_convert(const ConvertCommand& command);

struct BakeCommand {
  SceneChoice scene;
  std::string output;
  std::string hdr = "exr";  // of the pages beside it: exr, hdr, none
  bool has_vertex_colors = false, is_unlit = false, is_emissive = false;
  double texels_per_metre = 0;  // 0: as many as fill a page of --resolution
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
void add_bake(CLI::App& app, BakeCommand& command);  // its options
// UsageError where options are at odds; warns of those that the method does not use.
int check_and_bake(const CLI::App& command_line, BakeCommand command);

// Gets a scene without its images, where it has some, before it is read with them.
using ShowShapes = std::function<void(const Scene& scene)>;

// Which way is up, for a command that loads a scene.
struct UpUse {
  bool is_needed = false;  // by the command itself, not by its lights alone
  UpDecision decision;     // set by load_scene()
};

// The scene as its file has it, with a progress bar.
Scene read_scene(const SceneChoice& choice, bool is_quiet);

// The scene of a command: imported, with the light of `daylight` (null: as it is), only `lights`
// emitting (all if empty), warnings printed to standard error unless is_quiet.
Scene load_scene(const SceneChoice& choice, const std::vector<std::string>& lights,
                 const DaylightOptions* daylight, bool is_quiet, UpUse& up,
                 const ShowShapes& show_shapes = {});

// Decides by --up, else by the scene, given as it was read.
UpDecision up_of(const SceneChoice& choice, const Scene& scene);
// A line on standard error that says what was decided, unless the user or the format says it, or a
// warning does.
void tell_up(const UpDecision& decision);
// Warns, unless is_quiet, of luminaires that hang outside of the room or within something.
void warn_of_misplaced(const PreparedScene& scene, bool is_quiet);

// "certified", "kj92", "fixed" and "path"; UsageError for others.
Method parse_method(const std::string& name);
Indirect parse_indirect(const std::string& name);  // likewise
// Nothing, auto or stops; UsageError for others.
void check_exposure(const std::string& text);

// UsageError where options belong to another method.
void check_method(Method method, Indirect indirect, const std::string& solution);

// Warns, unless is_quiet, of every option given to `command` that its method does not use.
void warn_of_unused_options(const CLI::App& command, Method method, bool is_quiet);

// Says what the preprocessing leaves out of a scene.
void warn_of_lights_left_out(const PreparedScene& scene, bool is_quiet);

// What `method` needs beforehand, with a progress bar: the radiosity solution of the file
// `solution`, or (empty) a new one, and the sources selected. Null for methods that need nothing,
// and where it was interrupted.
std::unique_ptr<Preparation> prepare_method(const PreparedScene& scene, Method method,
                                            const Kj92Settings& settings, Indirect indirect,
                                            const std::string& solution, int threads, bool is_quiet,
                                            const StopFlag& stop);

// Parses the command line and runs it: the whole program but main.
int run(int argc, const char* const* argv, ProcessGroup* group = nullptr);

}  // namespace troffer
