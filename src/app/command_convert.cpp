#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "app/commands.h"
#include "app/output_guard.h"
#include "app/printable.h"
#include "app/signals.h"
#include "base/error.h"
#include "export/export_scene.h"
#include "import/import.h"

namespace troffer {

void add_convert(CLI::App& app, ConvertCommand& c) {
  CLI::App* s = app.add_subcommand("convert", "Write a scene in another format");
  add_scene_choice(*s, c.scene);
  s->add_option("output", c.output, "File to write: .pbrt, .gltf or .glb")->required();
  s->add_flag("--quiet", c.is_quiet, "No warnings");
}

int run_convert(const ConvertCommand& command) {
  check_scene_format(command.output);
  OutputGuard guard;
  guard.add_input("the scene", command.scene.file);
  guard.add_output("the output", command.output);
  const Scene scene = import_scene(command.scene.file, command.scene.options);
  guard.check_files_read();
  install_stop_handlers();  // a signal must not separate files that belong together
  const UpDecision up = up_of(command.scene, scene);
  const std::vector<Warning> lost = export_scene(scene, command.output, nullptr, up.up);
  if (command.is_quiet) return exit_done;
  const auto tell = [](const Warning& w) {
    fmt::print(stderr, "warning: {}", printable(w.text));
    if (w.count > 1) fmt::print(stderr, " ({} times)", w.count);
    fmt::print(stderr, "\n");
  };
  for (const Warning& w : scene.warnings.entries()) tell(w);
  if (!command.output.ends_with(".pbrt")) {
    if (!up.doubt.empty()) tell({up.doubt});
    tell_up(up);
  }
  for (const Warning& w : lost) tell(w);
  return exit_done;
}

}  // namespace troffer
