#include "function_scan.hpp"

#include <algorithm>
#include <cctype>
#include <regex>
#include <string_view>

namespace fleetmap::structure {
namespace {

enum class Block { kNamespace, kType, kValue, kFunction, kOther };

struct Open {
  Block block = Block::kOther;
  int line = 0;
  std::string header;
};

/// The end of the token of `source` at `at` that holds no code: a comment, a string, a character or a
/// preprocessor line. `at` itself if there is code.
std::size_t end_of_no_code(const std::string& source, std::size_t at) {
  const auto starts = [&](std::string_view token) { return source.compare(at, token.size(), token) == 0; };
  const auto behind = [&](std::string_view token, std::size_t from) {
    const std::size_t found = source.find(token, from);
    return found == std::string::npos ? source.size() : found + token.size();
  };
  const std::size_t before = at == 0 ? std::string::npos : source.find_last_not_of(' ', at - 1);
  const bool begins_line = before == std::string::npos || source[before] == '\n';
  if (starts("//") || (source[at] == '#' && begins_line))
    return std::min(source.find('\n', at), source.size());
  if (starts("/*")) return behind("*/", at + 2);
  if (starts("R\"")) {
    const std::size_t open = source.find('(', at);
    return behind(")" + source.substr(at + 2, open - at - 2) + "\"", open);
  }
  const char quote = source[at];
  const bool separates_digits =
      quote == '\'' && at > 0 && std::isalnum(static_cast<unsigned char>(source[at - 1]));
  if ((quote != '"' && quote != '\'') || separates_digits) return at;
  std::size_t end = at + 1;
  while (end < source.size() && source[end] != quote) end += source[end] == '\\' ? 2 : 1;
  return std::min(end + 1, source.size());
}

/// Without comments, strings, characters and preprocessor lines, but with all ends of lines.
std::string bare(const std::string& source) {
  std::string code;
  for (std::size_t at = 0; at < source.size();) {
    const std::size_t end = end_of_no_code(source, at);
    if (end == at) {
      code += source[at++];
    } else {
      const std::string skipped = source.substr(at, end - at);
      code.append(static_cast<std::size_t>(std::ranges::count(skipped, '\n')), '\n');
      at = end;
    }
  }
  return code;
}

std::string trimmed(const std::string& text) {
  const auto begin = text.find_first_not_of(" \n");
  return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(" \n") + 1 - begin);
}

Block kind_of(const std::string& header) {
  static const std::regex kNamespace(R"(^(inline )?namespace\b|^extern$)");
  static const std::regex kType(R"(^(template <.*> ?)?(struct|class|enum|union)\b[^()=]*$)");
  if (std::regex_search(header, kNamespace)) return Block::kNamespace;
  if (std::regex_search(header, kType)) return Block::kType;
  return header.ends_with('=') || header.empty() ? Block::kValue : Block::kFunction;
}

}  // namespace

std::vector<FunctionLines> functions_in(const std::string& source) {
  std::vector<FunctionLines> found;
  std::vector<Open> open;
  std::string header;
  int line = 1;
  for (const char c : bare(source)) {
    line += c == '\n';
    if (c == '{') {
      const bool outside = std::ranges::all_of(
          open, [](const Open& o) { return o.block == Block::kNamespace || o.block == Block::kType; });
      const std::string text = trimmed(header);
      open.push_back({outside ? kind_of(text) : Block::kOther, line, text});
      header.clear();
    } else if (c == '}' && !open.empty()) {
      const Open& last = open.back();
      if (last.block == Block::kFunction) found.push_back({last.line, line - last.line + 1, last.header});
      open.pop_back();
      header.clear();
    } else if (c == ';') {
      header.clear();
    } else {
      header += c;
    }
  }
  return found;
}

}  // namespace fleetmap::structure
