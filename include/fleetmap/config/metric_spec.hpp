#pragma once

#include <string>

namespace fleetmap::config {

/// A number that every case yields, and its presentation.
struct MetricSpec {
  std::string name;   ///< as in a case's result: map.rmse
  std::string title;  ///< of its plot and column
  std::string unit;
  bool log_scale = false;  ///< positive and spread over magnitudes: averaged and compared as logarithms
  /// The metric is measured in multiples of this, in `unit`; 0: its values are continuous.
  double resolution = 0.0;
  std::string with = {};    ///< the metric in whose plot this one is drawn; empty: it has a plot of its own
  std::string series = {};  ///< the name of its lines there
};

}  // namespace fleetmap::config
