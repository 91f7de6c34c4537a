#include "app/option_help.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/option_table.h"
#include "app/option_values.h"

namespace troffer {

namespace {

constexpr size_t help_width = 80, text_column = 26;

// Values that an option's validator allows.
struct Values {
  std::string range;  // "1 or more"
  std::vector<std::string> choices;
};

Values values_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();  // "INT:1 or more"
  const size_t colon = type.find(':');
  if (colon == std::string::npos) return {};
  const std::string said = type.substr(colon + 1);
  if (said.find('|') == std::string::npos) return {said, {}};
  return {"", split_at(said, '|')};
}

// Returns the description with range and default appended: "… (1 or more) [4]".
std::string full_text(const CLI::Option& option) {
  std::string text = option.get_description();
  const Values values = values_of(option);
  if (!values.range.empty()) text += " (" + values.range + ")";
  // Some descriptions already explain every choice.
  const bool is_explained =
      std::all_of(values.choices.begin(), values.choices.end(),
                  [&](const std::string& c) { return text.find(c + ": ") != std::string::npos; });
  if (!is_explained) text += ": " + listed_with_or(values.choices);
  if (!option.get_default_str().empty()) text += " [" + option.get_default_str() + "]";
  return text;
}

// Returns the number of columns of a UTF-8 text: bytes that start a character.
size_t columns(const std::string& text) {
  return size_t(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xc0) != 0x80;
  }));
}

// Appends words from column `at` on, and wraps lines at `help_width`.
void add_wrapped(const std::string& text, size_t at, std::string& out) {
  for (const std::string& word : split_at(text, ' ')) {
    if (at > text_column && at + 1 + columns(word) > help_width) {
      out += "\n" + std::string(text_column, ' ');
      at = text_column;
    }
    if (at > text_column) {
      out += ' ';
      ++at;
    }
    out += word;
    at += columns(word);
  }
  out += "\n";
}

void add_row(const std::string& name, const std::string& text, std::string& out) {
  std::string row = "  " + name;
  if (columns(row) + 2 > text_column) {
    out += row + "\n" + std::string(text_column, ' ');
  } else {
    out += row + std::string(text_column - columns(row), ' ');
  }
  add_wrapped(text, text_column, out);
}

bool is_required(const CLI::Option& option) {
  return option.get_required();
}

// Returns the usage line: "troffer render SCENE -o FILE [options]".
std::string usage(const CLI::App& command) {
  const std::string name = command.get_name();
  std::string text = "troffer " + name;
  for (const CLI::Option* o : command.get_options())
    if (o->get_positional())
      text += " " + name_shown(name, *o) + (o->get_items_expected_max() > 1 ? "…" : "");
  for (const CLI::Option* o : command.get_options()) {
    if (o->get_positional() || !is_required(*o)) continue;
    const std::string option =
        o->get_snames().empty() ? "--" + o->get_lnames().front() : "-" + o->get_snames().front();
    text += " " + option + " " + value_shown(name, *o);
  }
  return text + " [options]";
}

nlohmann::ordered_json option_json(const std::string& command, const CLI::Option& option) {
  const Values values = values_of(option);
  const OptionRow* row = row_of(command, option);
  nlohmann::ordered_json j;
  j["names"] = split_at(name_shown(command, option), ',');
  j["value"] = value_shown(command, option);
  j["text"] = option.get_description();
  j["full_text"] = full_text(option);
  j["range"] = values.range;
  j["choices"] = values.choices;
  j["default"] = option.get_default_str();
  const std::string files = row != nullptr ? row->files : "";
  j["files"] = files.empty() ? std::vector<std::string>{} : split_at(files, '|');
  j["is_required"] = is_required(option);
  j["is_repeatable"] = option.get_items_expected_max() > 1;
  j["is_positional"] = option.get_positional();
  return j;
}

// Makes CLI11 print the texts of this file for --help.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string, CLI::AppFormatMode) const override {
    return app->get_parent() == nullptr ? commands_help(*app) : command_help(*app);
  }
};

}  // namespace

std::string commands_help(const CLI::App& program) {
  std::string out = program.get_description() + "\n\nUsage: troffer COMMAND …\n\nCommands:\n";
  for (const CLI::App* c : program.get_subcommands({}))
    out += fmt::format("  {:<11}{}\n", c->get_name(), c->get_description());
  return out +
         "\ntroffer help COMMAND lists the options of a command; troffer --version prints the "
         "version.\n";
}

std::string command_help(const CLI::App& command) {
  const std::string name = command.get_name();
  std::string out = command.get_description() + "\n\nUsage: " + usage(command) + "\n";
  for (const OptionGroup& group : grouped_options(command)) {
    out += "\n" + group.name + ":\n";
    for (const CLI::Option* o : group.options) {
      std::string term = name_shown(name, *o);
      std::replace(term.begin(), term.end(), ',', ' ');
      if (term.starts_with("-") && term.find(' ') != std::string::npos)
        term.replace(term.find(' '), 1, ", ");
      const std::string value = value_shown(name, *o);
      add_row(term + (value.empty() ? "" : " " + value), full_text(*o), out);
    }
  }
  return out;
}

std::string help_json(const CLI::App& program) {
  nlohmann::ordered_json j;
  j["summary"] = program.get_description();
  j["commands"] = nlohmann::ordered_json::array();
  for (const CLI::App* c : program.get_subcommands({})) {
    nlohmann::ordered_json command;
    command["name"] = c->get_name();
    command["summary"] = c->get_description();
    command["usage"] = usage(*c);
    command["groups"] = nlohmann::ordered_json::array();
    for (const OptionGroup& group : grouped_options(*c)) {
      nlohmann::ordered_json options = nlohmann::ordered_json::array();
      for (const CLI::Option* o : group.options) options.push_back(option_json(c->get_name(), *o));
      command["groups"].push_back({{"name", group.name}, {"options", options}});
    }
    j["commands"].push_back(command);
  }
  return j.dump(1) + "\n";
}

void set_help(CLI::App& program) {
  const auto formatter = std::make_shared<HelpFormatter>();
  program.formatter(formatter);
  for (CLI::App* c : program.get_subcommands({})) c->formatter(formatter);
}

}  // namespace troffer
