#include "source_tree.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>

namespace fleetmap::structure {
namespace {

namespace fs = std::filesystem;

const fs::path kTop = FLEETMAP_SOURCE_DIR;

template <class Keep>
std::vector<std::string> sorted_files(const std::string& root, Keep keep) {
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(kTop / root)) {
    if (entry.is_regular_file() && keep(entry.path().extension().string()))
      files.push_back(fs::relative(entry.path(), kTop).string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

std::vector<std::string> cpp_files_below(const std::string& root) {
  return sorted_files(root, [](const std::string& extension) {
    return extension == ".cpp" || extension == ".hpp" || extension == ".h";
  });
}

std::vector<std::string> files_below(const std::string& root, const std::string& extension) {
  return sorted_files(root, [&](const std::string& other) { return other == extension; });
}

std::string text_of(const std::string& file) {
  std::ifstream in(kTop / file);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<std::string> lines_of(const std::string& file) {
  std::vector<std::string> lines;
  std::ifstream in(kTop / file);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::string library_of(const std::string& file) {
  const std::string prefix = file.starts_with("include/") ? "include/fleetmap/"
                             : file.starts_with("tests/") ? "tests/"
                                                          : "src/";
  return file.substr(prefix.size(), file.find('/', prefix.size()) - prefix.size());
}

std::string unit_of(const std::string& file) {
  return library_of(file) + "/" + fs::path(file).stem().string();
}

std::vector<Include> includes_of(const std::string& file) {
  static const std::regex kInclude(R"(^\s*#\s*include\s*([<"][^>"]+[>"]))");
  std::vector<Include> found;
  int number = 0;
  for (const std::string& line : lines_of(file)) {
    ++number;
    std::smatch match;
    if (std::regex_search(line, match, kInclude)) found.push_back({file, number, match[1]});
  }
  return found;
}

}  // namespace fleetmap::structure
