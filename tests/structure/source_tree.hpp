#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// The source tree that the tests of its structure read. Paths are relative to its top.
namespace fleetmap::structure {

/// Sources and headers below `root` ("src"), sorted.
std::vector<std::string> cpp_files_below(const std::string& root);
/// Files below `root` whose names end with `extension` (".md"), sorted.
std::vector<std::string> files_below(const std::string& root, const std::string& extension);

std::string text_of(const std::string& file);
std::vector<std::string> lines_of(const std::string& file);

/// "graph" of src/graph/solver/solver.cpp, include/fleetmap/graph/node.hpp and tests/graph/node_test.cpp.
std::string library_of(const std::string& file);
/// "graph/placement" of src/graph/placement.cpp and of include/fleetmap/graph/placement.hpp.
std::string unit_of(const std::string& file);

struct Include {
  std::string file;
  int line = 0;
  std::string target;  ///< with its quotes or brackets
};
std::vector<Include> includes_of(const std::string& file);

}  // namespace fleetmap::structure
