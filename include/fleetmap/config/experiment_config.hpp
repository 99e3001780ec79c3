#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/config/metric_spec.hpp"
#include "fleetmap/config/override.hpp"

/// Contents of an experiment: studies, each a grid of fleets that differ in a few keys, and each fleet run
/// once a seed.
namespace fleetmap::config {

/// One value of an axis: the keys it sets in the fleet's file.
struct AxisValue {
  std::string label;
  double position = 0.0;  ///< in plots and shapes: the value itself if it is a number, else its index
  std::vector<Override> overrides;
  std::optional<std::size_t> agents;  ///< of the axis "agents": the first N of the fleet's file drive
};

/// A parameter that a study varies, with its values in order.
struct Axis {
  std::string name;
  std::string unit;
  std::vector<AxisValue> values;
  std::string title = {};  ///< in plots; empty: the name
};

/// Shape of a curve that an experiment expects.
enum class Shape : std::uint8_t { kFalls, kRises, kFallsLessThanLinearly, kDoesNotRise, kDoesNotFall };
const char* to_string(Shape shape);

/// The required change of a metric's mean along an axis, for every combination of the other axes.
struct Expectation {
  std::string metric;
  std::string over;
  Shape shape = Shape::kFalls;
  double by = 0.0;  ///< of kDoesNotRise and kDoesNotFall: a change that matters, in the metric's unit; of log
                    ///< metrics of its ln
  bool required =
      true;  ///< else it is only reported, e.g. what a paper reports and another method need not show
};

/// A grid of axes and seeds, with its metrics and expectations.
struct Study {
  std::string name;
  std::string title;
  std::string figure;  ///< of the paper
  std::size_t agents = 0;
  std::vector<Axis> axes;
  std::vector<std::uint64_t> seeds;
  std::vector<Override> overrides;
  std::vector<std::string> metrics;
  std::vector<std::string> histograms;
  std::vector<std::string> pictures;
  std::vector<Expectation> expectations;
};

/// An experiment file, already narrowed down if the quick set is requested.
struct ExperimentConfig {
  std::string title;
  std::filesystem::path base;  ///< FLEET.yaml that every case starts from
  std::vector<Override> overrides;
  std::vector<std::string> seed_keys;  ///< dotted keys of `base` that get the case's seed
  std::string seed_keys_at;            ///< file, line and key, for messages
  std::vector<MetricSpec> metrics;
  std::vector<Study> studies;

  const MetricSpec* metric(const std::string& name) const;
};

}  // namespace fleetmap::config
