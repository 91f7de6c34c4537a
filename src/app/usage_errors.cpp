#include "app/usage_errors.h"

#include <algorithm>
#include <cctype>
#include <vector>

#include "app/option_table.h"
#include "app/printable.h"
#include "base/suggestion.h"

namespace troffer {

namespace {

// Returns the command that was typed; null if it is unknown.
const CLI::App* command_of(const CLI::App& program, int argc, const char* const* argv) {
  if (argc < 2) return nullptr;
  for (const CLI::App* c : program.get_subcommands({}))
    if (c->get_name() == argv[1]) return c;
  return nullptr;
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* o : command.get_options()) {
    for (const std::string& n : o->get_snames()) names.push_back("-" + n);
    for (const std::string& n : o->get_lnames()) names.push_back("--" + n);
  }
  return names;
}

// Returns "; did you mean --size?". A word such as "-size" may lack a dash.
std::string did_you_mean_option(const std::string& typed, const CLI::App& command) {
  std::string word = typed.substr(0, typed.find('='));
  if (word.size() > 2 && !word.starts_with("--")) word = "-" + word;
  const std::vector<std::string> names = option_names(command);
  const bool has_lost_dash = std::find(names.begin(), names.end(), word) != names.end();
  const std::string nearest = has_lost_dash ? word : nearest_name(word, names);
  return nearest.empty() ? "" : "; did you mean " + nearest + "?";
}

std::string see_help(const CLI::App& command) {
  return " (troffer help " + command.get_name() + " lists its options)";
}

// Reports the first unexpected argument: an unknown option, or a surplus word.
std::string unexpected(const CLI::App& command, int argc, const char* const* argv) {
  const std::vector<std::string> left = command.remaining(true);
  for (int i = 2; i < argc; ++i) {
    const std::string word = argv[i];
    if (std::find(left.begin(), left.end(), word) == left.end()) continue;
    const std::string shown = printable(word.substr(0, word.find('=')));
    if (word.size() > 1 && word[0] == '-' && std::isdigit(static_cast<unsigned char>(word[1])) == 0)
      return command.get_name() + " has no option " + shown + did_you_mean_option(word, command) +
             see_help(command);
    return command.get_name() + " has no use for '" + printable(word) + "'" + see_help(command);
  }
  return command.get_name() + " has no use for some of its arguments" + see_help(command);
}

// Reports the first missing required argument.
std::string missing(const CLI::App& command) {
  for (const CLI::Option* o : command.get_options()) {
    if (!o->get_required() || o->count() > 0) continue;
    const std::string name = command.get_name(), value = value_shown(name, *o);
    const std::string shown = o->get_positional() ? name_shown(name, *o)
                              : o->get_snames().empty()
                                  ? "--" + o->get_lnames().front() + " " + value
                                  : "-" + o->get_snames().front() + " " + value;
    return name + " needs " + shown + " (troffer help " + name + " lists its options)";
  }
  return "";
}

// Reports an option that is given twice, or whose value is missing because it is last or another
// option follows.
std::string without_value(const CLI::App& command, const std::string& what) {
  const std::string typed = what.substr(0, what.find(':'));
  for (const CLI::Option* o : command.get_options()) {
    if (o->get_name() != typed || o->get_items_expected_max() == 0) continue;
    if (o->count() > 1) return typed + " is given more than once: choose one value";
    return typed + " needs a value: " + typed + " " + value_shown(command.get_name(), *o);
  }
  return typed + " takes no value";
}

}  // namespace

std::string no_command(const CLI::App& program, const std::string& name) {
  std::vector<std::string> names;
  for (const CLI::App* c : program.get_subcommands({})) names.push_back(c->get_name());
  return "there is no command '" + printable(name) + "'" + did_you_mean(name, names) +
         " (troffer help lists the commands)";
}

std::string usage_message(const CLI::App& program, int argc, const char* const* argv,
                          const CLI::ParseError& error) {
  const CLI::App* command = command_of(program, argc, argv);
  if (command == nullptr) {
    const std::string word = argc > 1 ? argv[1] : "";
    if (word.empty() || word[0] == '-')
      return "a command must come first: troffer COMMAND … (troffer help lists the commands)";
    return no_command(program, word);
  }
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr)
    return unexpected(*command, argc, argv);
  if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
    const std::vector<std::string> left = command->remaining(true);
    const bool has_unknown = std::any_of(left.begin(), left.end(),
                                         [](const std::string& w) { return w.starts_with("-"); });
    if (has_unknown) return unexpected(*command, argc, argv);
    const std::string text = missing(*command);
    if (!text.empty()) return text;
  }
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr)
    return without_value(*command, error.what());
  return error.what();
}

}  // namespace troffer
