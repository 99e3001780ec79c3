#include "fleetmap/ros_codec/message_definitions.hpp"

#include <algorithm>
#include <map>
#include <sstream>
#include <vector>

#include "idl_texts.hpp"

namespace fleetmap::ros_codec {
namespace {

/// IDL's names of basic types and those of .msg files; longer names first.
constexpr std::pair<std::string_view, std::string_view> kBasicTypes[] = {
    {"unsigned long long", "uint64"},
    {"unsigned short", "uint16"},
    {"unsigned long", "uint32"},
    {"long long", "int64"},
    {"boolean", "bool"},
    {"double", "float64"},
    {"string", "string"},
    {"short", "int16"},
    {"float", "float32"},
    {"octet", "uint8"},
    {"int8", "int8"},
    {"long", "int32"},
};

struct Definition {
  std::string text;
  std::vector<std::string> members;  ///< types that it contains: "std_msgs/Header"
};
using Definitions = std::map<std::string, Definition, std::less<>>;  ///< by "std_msgs/Header"

/// "a::msg::dds_::B_" or "B_" of package a -> "a/B".
std::string short_name(std::string_view type, const std::string& package) {
  const std::size_t first = type.find("::"), last = type.rfind("::");
  const bool scoped = first != std::string_view::npos;
  std::string_view name = scoped ? type.substr(last + 2) : type;
  if (name.ends_with('_')) name.remove_suffix(1);
  return (scoped ? std::string(type.substr(0, first)) : package) + '/' + std::string(name);
}

std::string trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(' ');
  return first == std::string_view::npos
             ? std::string()
             : std::string(text.substr(first, text.find_last_not_of(' ') + 1 - first));
}

/// "double covariance[36];" -> "float64[36] covariance".
void add_member(Definition& into, std::string_view line, const std::string& package) {
  const std::size_t end = line.find(';'), comment = line.find("//");
  if (end == std::string_view::npos || end > comment) return;
  const std::string member = trimmed(line.substr(0, end));
  const std::size_t space = member.rfind(' ');
  if (space == std::string::npos) return;
  std::string type = trimmed(member.substr(0, space)), name = member.substr(space + 1), brackets;
  if (const std::size_t bracket = name.find('['); bracket != std::string::npos) {
    brackets = name.substr(bracket);
    name.resize(bracket);
  }
  if (type.starts_with("sequence<")) {
    brackets = "[]";
    type = type.substr(9, type.size() - 10);
  }
  const auto* basic = std::ranges::find(kBasicTypes, type, [](const auto& pair) { return pair.first; });
  if (basic != std::end(kBasicTypes)) {
    type = basic->second;
  } else {
    type = short_name(type, package);
    into.members.push_back(type);
  }
  into.text += type + brackets + ' ' + name;
  if (comment != std::string_view::npos) into.text += "  # " + trimmed(line.substr(comment + 2));
  into.text += '\n';
}

/// Reads the subset of IDL in which ROS 2's types are written here: a member a line, no constants.
void add_definitions(Definitions& into, const char* idl) {
  std::istringstream lines(idl);
  std::string package;
  Definition* open = nullptr;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word, name;
    words >> word >> name;
    if (word == "module") {
      package = name;
    } else if (word == "struct") {
      open = &into[short_name(name, package)];
    } else if (word.starts_with("}")) {
      open = nullptr;
    } else if (open != nullptr) {
      add_member(*open, line, package);
    }
  }
}

const Definitions& definitions() {
  static const Definitions all = [] {
    Definitions read;
    for (const char* idl : kIdlTexts) add_definitions(read, idl);
    return read;
  }();
  return all;
}

/// Appends the types that `name` contains, each once and before those that it contains itself.
void add_contained(std::vector<std::string>& names, const std::string& name) {
  const auto found = definitions().find(name);
  if (found == definitions().end()) return;
  for (const std::string& member : found->second.members) {
    if (std::ranges::find(names, member) != names.end()) continue;
    names.push_back(member);
    add_contained(names, member);
  }
}

}  // namespace

std::string message_definition(std::string_view type) {
  std::string name(type);
  if (const std::size_t at = name.find("/msg/"); at != std::string::npos) name.erase(at, 4);
  const auto found = definitions().find(name);
  if (found == definitions().end()) return {};
  std::string text = found->second.text;
  std::vector<std::string> contained{name};
  add_contained(contained, name);
  for (std::size_t k = 1; k < contained.size(); ++k) {
    text += std::string(80, '=') + "\nMSG: " + contained[k] + '\n';
    if (const auto part = definitions().find(contained[k]); part != definitions().end())
      text += part->second.text;
  }
  return text;
}

}  // namespace fleetmap::ros_codec
