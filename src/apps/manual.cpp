#include "manual.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <sstream>
#include <utility>
#include <vector>

#include "command_result.hpp"

namespace fleetmap::apps {
namespace {

/// Commands that are shown to people; those of an empty group are not.
std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
}

/// Text in roff: a line that begins with a dot or an apostrophe would be a request.
std::string escaped(const std::string& text) {
  std::string result;
  bool line_begins = true;
  for (const char c : text) {
    if (c == '\\' || c == '-') result += '\\';
    if (line_begins && (c == '.' || c == '\'')) result += "\\&";
    result += c == '\\' ? 'e' : c;
    line_begins = c == '\n';
  }
  return result;
}

/// The value of an option that is not given; empty where there is none to name, as of flags.
std::string default_of(const CLI::Option& option) {
  const std::string value = option.get_default_str();
  const bool named = option.get_items_expected_max() > 0 && !option.get_required() && !value.empty();
  return named ? " (default: " + value + ")" : "";
}

std::string man_options(const CLI::App& app) {
  std::string page;
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;
    const std::string name =
        option->get_positional() ? option->get_name(true) : option->get_name(false, true);
    const std::string type = option->get_items_expected_max() > 0 ? " " + option->get_type_name() : "";
    page += ".TP\n\\fB" + escaped(name) + "\\fR" + escaped(type) + "\n" + escaped(option->get_description());
    page += option->get_required() ? " (required)\n" : escaped(default_of(*option)) + "\n";
  }
  return page;
}

std::string man_exit_status() {
  constexpr std::array<std::pair<ExitCode, const char*>, 4> kMeanings{
      {{kDone, "done"},
       {kFailed,
        "failed; or done, and what was asked for is not sound: a check has findings, the odometry lost its "
        "way, or parts of a recording are damaged and the results lack them"},
       {kUsage, "wrong usage: an option or value that there is not"},
       {kBadConfiguration, "the configuration has errors, each named with file and line"}}};
  std::string page = ".SH EXIT STATUS\n";
  for (const auto& [code, meaning] : kMeanings)
    page.append(".TP\n\\fB").append(std::to_string(code)).append("\\fR\n").append(meaning).append("\n");
  return page;
}

std::string man_commands(const CLI::App& app, const std::string& path) {
  std::string page;
  for (const CLI::App* command : commands_of(app)) {
    const std::string name = path + " " + command->get_name();
    page +=
        ".SH " + escaped(name) + "\n" + escaped(command->get_description()) + "\n" + man_options(*command);
    page += man_commands(*command, name);
  }
  return page;
}

/// "TEXT:{a,b,c}" lists the values that an option takes.
std::string values_of(const CLI::Option& option) {
  std::string type = option.get_type_name();
  const auto first = type.find('{'), last = type.find('}');
  if (first == std::string::npos || last == std::string::npos || last < first) return {};
  type = type.substr(first + 1, last - first - 1);
  std::ranges::replace(type, ',', ' ');
  return type;
}

/// The names of an option as typed: "-c --config".
std::string names_of(const CLI::Option& option) {
  std::string names;
  for (const std::string& name : option.get_snames()) names += " -" + name;
  for (const std::string& name : option.get_lnames()) names += " --" + name;
  return names;
}

/// The words that may follow those typed before: the commands, the options, and by option the values that it
/// takes; a space for one that takes any.
struct Words {
  std::map<std::string, std::string> commands, options, values;
};

void collect(const CLI::App& app, const std::string& path, Words& words) {
  for (const CLI::App* command : commands_of(app)) words.commands[path] += " " + command->get_name();
  std::string& options = words.options[path];
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty() || option->get_positional()) continue;
    options += names_of(*option);
    if (option->get_items_expected_max() == 0) continue;
    std::istringstream names(names_of(*option));
    for (std::string name; names >> name;)
      words.values[std::string(path).append(" ").append(name)] = values_of(*option);
  }
  for (const CLI::App* command : commands_of(app)) collect(*command, path + " " + command->get_name(), words);
}

/// Global, since bash-completion reads the script inside a function.
std::string table(const std::string& name, const std::map<std::string, std::string>& rows) {
  std::string text = "declare -gA " + name + "=(\n";
  for (const auto& [key, value] : rows)
    text.append("  ['").append(key).append("']='").append(value).append("'\n");
  return text + ")\n";
}

}  // namespace

void drop_empty_defaults(CLI::App& program) {
  for (CLI::Option* option : program.get_options({})) {
    const std::string value = option->get_default_str();
    if (value == "[]" || value == "{}" || value == "\"\"") option->default_str("");
  }
  for (CLI::App* command : program.get_subcommands({})) drop_empty_defaults(*command);
}

std::string man_page(const CLI::App& program) {
  const std::string& name = program.get_name();
  std::string title = name;
  std::ranges::transform(title, title.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  const std::string description = program.get_description();
  const auto colon = description.find(": ");
  return ".TH " + title + " 1\n.SH NAME\n" + name + " \\- " +
         escaped(colon == std::string::npos ? description : description.substr(colon + 2)) +
         "\n.SH SYNOPSIS\n\\fB" + name + "\\fR [OPTIONS] COMMAND\n.SH OPTIONS\n" + man_options(program) +
         man_commands(program, name) + man_exit_status();
}

std::string bash_completion(const CLI::App& program) {
  Words words;
  const std::string& name = program.get_name();
  collect(program, name, words);
  std::string script = R"(# Completes PROGRAM in bash.
_PROGRAM() {
  local path=PROGRAM word here=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} owner
  COMPREPLY=()
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    [[ $word != -* && -n $word && -v _PROGRAM_options["$path $word"] ]] && path+=" $word"
  done
  for owner in "$path" PROGRAM; do
    if [[ -v _PROGRAM_values["$owner $before"] ]]; then
      COMPREPLY=($(compgen -W "${_PROGRAM_values["$owner $before"]}" -- "$here"))
      return
    fi
  done
  if [[ $here == -* ]]; then
    COMPREPLY=($(compgen -W "${_PROGRAM_options["$path"]}" -- "$here"))
  else
    COMPREPLY=($(compgen -W "${_PROGRAM_commands["$path"]-}" -- "$here"))
  fi
}
complete -o default -F _PROGRAM PROGRAM
)";
  for (auto at = script.find("PROGRAM"); at != std::string::npos; at = script.find("PROGRAM", at))
    script.replace(at, 7, name);
  return table("_" + name + "_commands", words.commands) + table("_" + name + "_options", words.options) +
         table("_" + name + "_values", words.values) + script;
}

}  // namespace fleetmap::apps
