#include "radio_history.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>

#include "report/radio_use.hpp"

namespace fleetmap::apps {
namespace {

using output::LinkTraceRow;

constexpr std::size_t kMaxSteps = 900;
constexpr Duration kBetweenMissions = std::chrono::hours(1);
constexpr double kSecond = 1.0;  // that a row tells of

/// A link while its rows are added.
struct LinkSum {
  monitor::HeardLink heard;
  double lost = 0.0;                    ///< messages
  double delay_s = 0.0, timed = 0.0;    ///< sum, and its number of rows
  std::vector<double> lost_in, all_in;  ///< messages by step
  std::vector<bool> silent_in;          ///< by step: it fell silent

  LinkSum(const LinkTraceRow& row, std::size_t steps)
      : lost_in(steps, 0.0), all_in(steps, 0.0), silent_in(steps, false) {
    heard.from = row.from;
    heard.to = row.to;
    heard.link = row.link;
    heard.received.assign(steps, 0.0);
  }

  void add(const LinkTraceRow& row, std::size_t step, double step_s) {
    const auto messages = static_cast<double>(row.messages);
    silent_in[step] = row.messages == 0;
    if (row.messages == 0) return;
    const double share = std::min(0.01 * row.loss_percent, 0.999);  // one of a thousand was heard at least
    const double missed = messages * share / (1.0 - share);
    const double bytes = 1e3 / 8.0 * row.used_kbit_s * kSecond;
    heard.bytes += bytes;
    heard.messages += messages;
    heard.received[step] += bytes / step_s;
    lost += missed;
    lost_in[step] += missed;
    all_in[step] += messages + missed;
    if (row.delay_ms) delay_s += 1e-3 * *row.delay_ms, timed += 1.0;
  }

  monitor::HeardLink finished() && {
    if (heard.messages > 0.0) heard.loss = lost / (lost + heard.messages);
    if (timed > 0.0) heard.delay_s = delay_s / timed;
    for (std::size_t k = 0; k < all_in.size(); ++k) {
      std::optional<double> loss;
      if (all_in[k] > 0.0) loss = lost_in[k] / all_in[k];
      if (silent_in[k]) loss = 1.0;
      heard.loss_in.push_back(loss);
    }
    return std::move(heard);
  }
};

/// The first row of the last mission; `rows` in order of time.
std::vector<LinkTraceRow>::const_iterator begin_of_last(const std::vector<LinkTraceRow>& rows) {
  auto begin = rows.begin();
  for (auto row = rows.begin(); row != rows.end(); ++row)
    if (row != rows.begin() && row->time - std::prev(row)->time > kBetweenMissions) begin = row;
  return begin;
}

}  // namespace

monitor::RadioHistory radio_history(std::vector<LinkTraceRow> rows) {
  monitor::RadioHistory history;
  if (rows.empty()) return history;
  std::ranges::stable_sort(rows, {}, &LinkTraceRow::time);
  const auto first = begin_of_last(rows);
  const double length_s = to_seconds(rows.back().time - first->time) + kSecond;
  history.begin = first->time;
  history.step_s = std::max(kSecond, std::ceil(length_s / static_cast<double>(kMaxSteps)));
  history.steps = static_cast<std::size_t>(std::ceil(length_s / history.step_s));
  std::map<std::tuple<std::string, AgentId, AgentId>, LinkSum> sums;
  for (auto row = first; row != rows.end(); ++row) {
    LinkSum& sum = sums.try_emplace({row->link, row->from, row->to}, *row, history.steps).first->second;
    const double into_s = to_seconds(row->time - history.begin);
    sum.add(*row, std::min(static_cast<std::size_t>(into_s / history.step_s), history.steps - 1),
            history.step_s);
  }
  for (auto& [name, sum] : sums) history.links.push_back(std::move(sum).finished());
  return history;
}

void add_radio_use(const nlohmann::json& report, const AgentId& by, monitor::RadioHistory& history) {
  const auto uses = radio_uses(report);
  if (uses.empty()) return;
  const auto agents = report.find("agents");
  if (agents == report.end() || !agents->is_object())
    history.reports.push_back(by);
  else
    for (const auto& [name, agent] : agents->items())
      if (const auto robot = AgentId::parse(name)) history.reports.push_back(*robot);
  std::vector<monitor::KindTotal>& kinds = history.kinds;
  for (const auto& [name, use] : uses) {
    auto known = std::ranges::find_if(kinds, [&name = name](const monitor::KindTotal& kind) {
      return kind.link == name.first && kind.kind == name.second;
    });
    if (known == kinds.end()) known = kinds.insert(kinds.end(), monitor::KindTotal{name.first, name.second});
    known->sent_bytes += use.bytes;
    known->received_bytes += use.received_bytes;
  }
}

}  // namespace fleetmap::apps
