#pragma once

#include <functional>
#include <string>
#include <vector>

#include "fleetmap/experiment/case_record.hpp"

namespace fleetmap::experiment {

/// A fixed value on every axis of a study but one.
struct Slice {
  std::vector<std::string> labels;  ///< one an axis; that of the free axis is empty
  std::string name;                 ///< "rate_hz=10 Hz", empty if there are no other axes
};

/// Every combination of the other axes' values. Without a free axis (index >= axes) all points.
std::vector<Slice> slices(const config::Study& study, std::size_t free_axis);

/// The metric at each value of the free axis, by seed; NaN where a case failed or did not give it.
struct SliceValues {
  std::vector<double> x;
  std::vector<std::string> labels;
  std::vector<std::vector<double>> values;  ///< [value of the axis][seed]
};
SliceValues values_along(const config::Study& study, const std::vector<CaseRecord>& records,
                         std::size_t free_axis, const Slice& slice, const std::string& metric);

/// The records of one point of the study, in the order of the seeds.
std::vector<const CaseRecord*> records_at(const config::Study& study, const std::vector<CaseRecord>& records,
                                          const std::vector<std::string>& point);

/// The first of them that came to its end; null: none did.
const CaseRecord* first_done(const config::Study& study, const std::vector<CaseRecord>& records,
                             const std::vector<std::string>& point);

/// The metric of those cases that gave it.
std::vector<double> values_at(const std::vector<const CaseRecord*>& records, const std::string& metric);

struct Spread {
  std::size_t count = 0;
  double min = 0.0, mean = 0.0, max = 0.0, deviation = 0.0;  ///< deviation: of a sample, 0 for one value
};
/// Spread of the finite values. A log-scale metric has the geometric mean, and only positive values count.
Spread spread(const std::vector<double>& values, bool log_scale);

/// Metrics that a study shows or expects, but none of the cases that came to their end gave.
std::vector<std::string> absent_metrics(const config::ExperimentConfig& config,
                                        const std::vector<CaseRecord>& records);

}  // namespace fleetmap::experiment
