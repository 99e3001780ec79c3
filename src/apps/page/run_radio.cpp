#include "run_radio.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "fleetmap/output/line_file.hpp"
#include "fleetmap/output/link_trace.hpp"
#include "radio_history.hpp"

namespace fleetmap::apps {

void add_radio(LoadedRun& run, std::span<const AgentId> without) {
  const auto left_out = [&](const AgentId& robot) {
    return std::ranges::find(without, robot) != without.end();
  };
  std::vector<output::LinkTraceRow> rows;
  std::vector<AgentId> traces;
  for (const RobotFiles& files : run.files) {
    if (left_out(files.robot)) continue;
    const std::filesystem::path file = files.folder / output::kLinkTraceFile;
    output::LinkTrace trace = output::read_link_trace(file);
    if (auto note = output::damage_note(trace.damaged, file)) run.view.notes.push_back(std::move(*note));
    if (!trace.rows.empty()) traces.push_back(files.robot);
    std::ranges::copy_if(trace.rows, std::back_inserter(rows),
                         [&](const output::LinkTraceRow& row) { return !left_out(row.from); });
  }
  monitor::RadioHistory& radio = run.view.radio;
  radio = radio_history(std::move(rows));
  radio.traces = std::move(traces);
  if (!without.empty()) return;  // reports do not tell how much of a kind came from whom
  for (const RobotFiles& files : run.files) add_radio_use(report_of(files), files.robot, radio);
}

}  // namespace fleetmap::apps
