#pragma once

#include <string>
#include <vector>

namespace fleetmap::structure {

struct FunctionLines {
  int line = 0;        ///< of the opening brace, from 1
  int lines = 0;       ///< from there to the closing brace, both included
  std::string header;  ///< the text before the brace
};

/// Functions defined in C++ source, by their braces: whatever opens a block in a namespace or a class and is
/// neither a type nor the value of a variable. Blocks within a function count to it.
std::vector<FunctionLines> functions_in(const std::string& source);

}  // namespace fleetmap::structure
