#include "study_values.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fleetmap/core/text_list.hpp"

namespace fleetmap::experiment {

std::vector<Slice> slices(const config::Study& study, std::size_t free_axis) {
  std::vector<Slice> all{Slice{}};
  for (std::size_t axis = 0; axis < study.axes.size(); ++axis) {
    std::vector<Slice> longer;
    for (const Slice& slice : all) {
      if (axis == free_axis) {
        longer.push_back(slice);
        longer.back().labels.emplace_back();
        continue;
      }
      for (const config::AxisValue& value : study.axes[axis].values) {
        Slice next = slice;
        next.labels.push_back(value.label);
        const std::string& unit = study.axes[axis].unit;
        append_to_list(next.name,
                       study.axes[axis].name + "=" + value.label + (unit.empty() ? "" : " " + unit));
        longer.push_back(std::move(next));
      }
    }
    all = std::move(longer);
  }
  return all;
}

std::vector<const CaseRecord*> records_at(const config::Study& study, const std::vector<CaseRecord>& records,
                                          const std::vector<std::string>& point) {
  std::vector<const CaseRecord*> found;
  for (const std::uint64_t seed : study.seeds) {
    const auto record = std::ranges::find_if(records, [&](const CaseRecord& candidate) {
      return candidate.of.study == study.name && candidate.of.seed == seed && candidate.of.point == point;
    });
    if (record != records.end()) found.push_back(&*record);
  }
  return found;
}

const CaseRecord* first_done(const config::Study& study, const std::vector<CaseRecord>& records,
                             const std::vector<std::string>& point) {
  const auto found = records_at(study, records, point);
  const auto done = std::ranges::find_if(found, &CaseRecord::done);
  return done == found.end() ? nullptr : *done;
}

SliceValues values_along(const config::Study& study, const std::vector<CaseRecord>& records,
                         std::size_t free_axis, const Slice& slice, const std::string& metric) {
  SliceValues out;
  for (const config::AxisValue& value : study.axes[free_axis].values) {
    std::vector<std::string> point = slice.labels;
    point[free_axis] = value.label;
    out.x.push_back(value.position);
    out.labels.push_back(value.label);
    std::vector<double> row(study.seeds.size(), std::numeric_limits<double>::quiet_NaN());
    for (const CaseRecord* record : records_at(study, records, point)) {
      if (!record->done()) continue;
      const auto found = record->result->metrics.find(metric);
      if (found == record->result->metrics.end()) continue;
      const auto seed = std::ranges::find(study.seeds, record->of.seed);
      row[static_cast<std::size_t>(seed - study.seeds.begin())] = found->second;
    }
    out.values.push_back(std::move(row));
  }
  return out;
}

std::vector<double> values_at(const std::vector<const CaseRecord*>& records, const std::string& metric) {
  std::vector<double> values;
  for (const CaseRecord* record : records) {
    if (!record->done()) continue;
    const auto found = record->result->metrics.find(metric);
    if (found != record->result->metrics.end()) values.push_back(found->second);
  }
  return values;
}

Spread spread(const std::vector<double>& values, bool log_scale) {
  std::vector<double> counted;
  for (const double value : values) {
    if (!std::isfinite(value) || (log_scale && value <= 0.0)) continue;
    counted.push_back(log_scale ? std::log(value) : value);
  }
  Spread out;
  out.count = counted.size();
  if (counted.empty()) return out;
  for (const double value : counted) out.mean += value / static_cast<double>(counted.size());
  for (const double value : counted) out.deviation += (value - out.mean) * (value - out.mean);
  out.deviation =
      counted.size() > 1 ? std::sqrt(out.deviation / static_cast<double>(counted.size() - 1)) : 0.0;
  out.min = *std::ranges::min_element(counted);
  out.max = *std::ranges::max_element(counted);
  if (log_scale) {
    out.min = std::exp(out.min);
    out.mean = std::exp(out.mean);
    out.max = std::exp(out.max);
  }
  return out;
}

std::vector<std::string> absent_metrics(const config::ExperimentConfig& config,
                                        const std::vector<CaseRecord>& records) {
  std::vector<std::string> absent;
  for (const config::Study& study : config.studies) {
    std::vector<std::string> wanted = study.metrics;
    for (const config::Expectation& expectation : study.expectations) wanted.push_back(expectation.metric);
    const auto is_done = [&](const CaseRecord& record) {
      return record.of.study == study.name && record.done();
    };
    if (std::ranges::none_of(records, is_done)) continue;  // a failed study has no names
    for (const std::string& metric : wanted) {
      const bool reported = std::ranges::any_of(records, [&](const CaseRecord& record) {
        return is_done(record) && record.result->metrics.contains(metric);
      });
      const std::string line = study.name + ": no case gave the metric " + metric;
      if (!reported && std::ranges::find(absent, line) == absent.end()) absent.push_back(line);
    }
  }
  return absent;
}

}  // namespace fleetmap::experiment
