#include "radio_history_json.hpp"

#include "names_json.hpp"
#include "rounded_json.hpp"

namespace fleetmap::monitor {
namespace {

using nlohmann::json;

json links_json(const std::vector<HeardLink>& all) {
  json links = json::array();
  for (const HeardLink& link : all) {
    json received = json::array(), loss = json::array();
    for (const double rate : link.received) received.push_back(rounded(rate, 1.0));
    for (const std::optional<double>& share : link.loss_in) loss.push_back(optional_json(share, 1e3));
    links.push_back({{"from", link.from.str()},
                     {"to", link.to.str()},
                     {"link", link.link},
                     {"bytes", rounded(link.bytes, 1.0)},
                     {"messages", rounded(link.messages, 1.0)},
                     {"loss", rounded(link.loss, 1e4)},
                     {"delay_s", optional_json(link.delay_s, 1e4)},
                     {"received", std::move(received)},
                     {"loss_in", std::move(loss)}});
  }
  return links;
}

json kinds_json(const std::vector<KindTotal>& all) {
  json kinds = json::array();
  for (const KindTotal& kind : all)
    kinds.push_back({{"link", kind.link},
                     {"kind", kind.kind},
                     {"sent", kind.sent_bytes},
                     {"received", kind.received_bytes}});
  return kinds;
}

}  // namespace

json radio_history_json(const RadioHistory& history, Stamp first, Stamp last) {
  if (history.traces.empty() && history.reports.empty()) return {};
  json all{{"traces", names_json(history.traces)},
           {"reports", names_json(history.reports)},
           {"step_s", history.step_s},
           {"steps", history.steps},
           {"links", links_json(history.links)},
           {"kinds", kinds_json(history.kinds)}};
  const double begin_s = to_seconds(history.begin - first);
  const double end_s = begin_s + history.step_s * static_cast<double>(history.steps);
  if (begin_s <= to_seconds(last - first) && end_s >= 0.0) all["begin_s"] = rounded(begin_s, 10.0);
  return all;
}

}  // namespace fleetmap::monitor
