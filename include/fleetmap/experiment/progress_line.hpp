#pragma once

#include <ostream>

#include "fleetmap/experiment/runner.hpp"

namespace fleetmap::experiment {

/// Tells a person where the experiment stands: a line for each case that ends and, on a terminal, one that is
/// rewritten with what is under way.
class ProgressLine {
 public:
  ProgressLine(std::ostream& out, bool terminal) : out_(&out), terminal_(terminal) {}
  void show(const Progress& progress);
  /// Ends the line that is rewritten.
  void finish();

 private:
  std::ostream* out_;
  bool terminal_;
  bool open_ = false;
};

/// "1 h 04 min", "3 min 20 s", "12 s".
std::string duration_text(double seconds);

}  // namespace fleetmap::experiment
