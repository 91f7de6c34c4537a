#include "app/output_guard.h"

#include <unistd.h>

#include "app/commands.h"
#include "base/error.h"
#include "image/output_target.h"

namespace troffer {

namespace {

// "FILE,1,2" may be a file of that name, or a file and up to two numbers. Returns all candidates.
std::vector<std::string> possible_files(std::string text) {
  std::vector<std::string> files;
  for (int numbers = 0; numbers < 3; ++numbers) {
    files.push_back(text);
    const size_t comma = text.rfind(',');
    if (comma == std::string::npos) break;
    text.resize(comma);
  }
  return files;
}

}  // namespace

OutputGuard::OutputGuard() {
  const auto add = [&](const char* role, int descriptor) {
    if (const auto identity = identity_of_descriptor(descriptor))
      outputs_.push_back({role, "", *identity, true});
  };
  add("standard output", STDOUT_FILENO);
  add("standard error", STDERR_FILENO);
}

void OutputGuard::check(const Named& output, const Named& input) {
  if (!(output.identity == input.identity)) return;
  if (output.path.empty())
    throw UsageError(input.role + " " + input.path + " is the file that " + output.role +
                     " goes to");
  throw UsageError(output.role + " " + output.path + " is the same file as " + input.role +
                   (input.path == output.path ? "" : " " + input.path) +
                   ": an output may not be an input");
}

void OutputGuard::add_input(const std::string& role, const std::string& path) {
  const auto identity = identity_of_input(path);
  if (!identity) return;
  const Named input{role, path, *identity};
  for (const Named& o : outputs_) check(o, input);
  inputs_.push_back(input);
}

void OutputGuard::add_output(const std::string& role, const std::string& path) {
  if (path.empty()) return;
  const auto identity = identity_of_output(path);
  if (!identity) return;
  const bool is_stream = output_target(path).kind == OutputTarget::Kind::descriptor;
  const Named output{role, path, *identity, is_stream};
  for (const Named& i : inputs_) check(output, i);
  for (const Named& o : outputs_) {
    if (!(o.identity == output.identity) || (o.path.empty() && is_stream)) continue;
    if (o.path.empty())
      throw UsageError(role + " " + path + " is the file that " + o.role + " goes to");
    throw UsageError(role + " " + path + " is the same file as " + o.role +
                     (o.path == path ? "" : " " + o.path) +
                     ": each output needs a file of its own");
  }
  outputs_.push_back(output);
}

void OutputGuard::add_outputs(const std::string& role, const std::vector<std::string>& paths) {
  for (const std::string& path : paths) add_output(role, path);
}

void OutputGuard::add_inputs(const SceneChoice& scene, const DaylightOptions& d) {
  add_input("the scene", scene.file);
  for (const std::string& luminaire : d.luminaires)
    for (const std::string& file : possible_files(luminaire.substr(luminaire.find('=') + 1)))
      add_input("--luminaire", file);
  add_input("--luminaires", d.luminaire_list);
  add_input("--weather", d.weather);
  for (const std::string& file : possible_files(d.environment)) add_input("--environment", file);
}

void OutputGuard::check_files_read() const {
  for (const std::string& path : read_.paths()) {
    const auto identity = identity_of_input(path);
    if (!identity) continue;
    for (const Named& o : outputs_) check(o, {"a file of the scene", path, *identity});
  }
}

}  // namespace troffer
