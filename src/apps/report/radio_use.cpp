#include "radio_use.hpp"

#include "robot/radio_rates.hpp"

namespace fleetmap::apps {
namespace {

using nlohmann::json;

std::string name_in(const json& row, const char* key) {
  const auto found = row.find(key);
  return found != row.end() && found->is_string() ? found->get<std::string>() : std::string();
}

std::uint64_t total_in(const json& row, const char* key) {
  const auto found = row.find(key);
  return found != row.end() && found->is_number_integer() && *found >= 0 ? found->get<std::uint64_t>() : 0;
}

}  // namespace

std::map<std::pair<std::string, std::string>, RadioUse> radio_uses(const json& report) {
  std::map<std::pair<std::string, std::string>, RadioUse> uses;
  const auto rows_of = [&report](const char* key) {
    const auto found = report.find(key);
    return found != report.end() && found->is_array() ? *found : json::array();
  };
  if (!report.is_object()) return uses;
  for (const json& row : rows_of("links")) {
    if (!row.is_object()) continue;
    RadioUse& use = uses[{name_in(row, "link"), kind_of_topic(name_in(row, "topic"))}];
    use.messages += total_in(row, "messages");
    use.bytes += total_in(row, "wire_bytes");
  }
  for (const json& row : rows_of("topics")) {
    if (!row.is_object()) continue;
    RadioUse& use = uses[{name_in(row, "link"), name_in(row, "kind")}];
    use.messages += total_in(row, "sent_messages");
    use.bytes += total_in(row, "sent_bytes");
    use.received_bytes += total_in(row, "received_bytes");
  }
  return uses;
}

}  // namespace fleetmap::apps
