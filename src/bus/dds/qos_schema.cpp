#include "qos_schema.hpp"

#include <tinyxml2.h>

#include <algorithm>
#include <charconv>
#include <string_view>
#include <vector>

namespace fleetmap::bus {
namespace {

/// `element` is allowed in a `parent`; its content is of type `content`. Types in lower case are nodes of
/// this table, those in upper case are values, and A|B lists the allowed words.
struct Rule {
  std::string_view parent;
  std::string_view element;
  std::string_view content;
};

constexpr Rule kRules[] = {
    {"dds", "profiles", "profiles"},
    {"profiles", "transport_descriptors", "transports"},
    {"profiles", "participant", "participant"},
    {"profiles", "data_writer", "writer"},
    {"profiles", "data_reader", "reader"},

    {"transports", "transport_descriptor", "transport"},
    {"transport", "transport_id", "TEXT"},
    {"transport", "type", "UDPv4|SHM"},
    {"transport", "sendBufferSize", "UINT"},
    {"transport", "receiveBufferSize", "UINT"},
    {"transport", "maxMessageSize", "UINT"},
    {"transport", "maxInitialPeersRange", "UINT"},
    {"transport", "TTL", "UINT"},
    {"transport", "non_blocking_send", "BOOL"},
    {"transport", "output_port", "UINT"},
    {"transport", "interfaceWhiteList", "addresses"},
    {"transport", "segment_size", "UINT"},
    {"transport", "port_queue_capacity", "UINT"},
    {"transport", "healthy_check_timeout_ms", "UINT"},
    {"addresses", "address", "TEXT"},

    {"participant", "rtps", "rtps"},
    {"rtps", "name", "TEXT"},
    {"rtps", "sendSocketBufferSize", "UINT"},
    {"rtps", "listenSocketBufferSize", "UINT"},
    {"rtps", "participantID", "UINT"},
    {"rtps", "useBuiltinTransports", "BOOL"},
    {"rtps", "ignore_non_matching_locators", "BOOL"},
    {"rtps", "userTransports", "transport_ids"},
    {"rtps", "defaultUnicastLocatorList", "locators"},
    {"rtps", "defaultMulticastLocatorList", "locators"},
    {"rtps", "builtin", "builtin"},
    {"rtps", "port", "port"},
    {"rtps", "throughputController", "throughput"},
    {"rtps", "propertiesPolicy", "properties_policy"},
    {"rtps", "allocation", "participant_allocation"},
    {"transport_ids", "transport_id", "TEXT"},
    {"builtin", "discovery_config", "discovery"},
    {"builtin", "avoid_builtin_multicast", "BOOL"},
    {"builtin", "use_WriterLivelinessProtocol", "BOOL"},
    {"builtin", "metatrafficUnicastLocatorList", "locators"},
    {"builtin", "metatrafficMulticastLocatorList", "locators"},
    {"builtin", "initialPeersList", "locators"},
    {"builtin", "readerHistoryMemoryPolicy",
     "PREALLOCATED|PREALLOCATED_WITH_REALLOC|DYNAMIC|DYNAMIC_REUSABLE"},
    {"builtin", "writerHistoryMemoryPolicy",
     "PREALLOCATED|PREALLOCATED_WITH_REALLOC|DYNAMIC|DYNAMIC_REUSABLE"},
    {"builtin", "readerPayloadSize", "UINT"},
    {"builtin", "writerPayloadSize", "UINT"},
    {"builtin", "mutation_tries", "UINT"},
    {"discovery", "discoveryProtocol", "SIMPLE|CLIENT|SUPER_CLIENT|SERVER|BACKUP|NONE"},
    {"discovery", "discoveryServersList", "servers"},
    {"discovery", "EDP", "SIMPLE|STATIC"},
    {"discovery", "simpleEDP", "simple_edp"},
    {"discovery", "leaseDuration", "duration"},
    {"discovery", "leaseAnnouncement", "duration"},
    {"discovery", "initialAnnouncements", "announcements"},
    {"discovery", "clientAnnouncementPeriod", "duration"},
    {"servers", "RemoteServer", "server"},
    {"server", "metatrafficUnicastLocatorList", "locators"},
    {"server", "metatrafficMulticastLocatorList", "locators"},
    {"simple_edp", "PUBWRITER_SUBREADER", "BOOL"},
    {"simple_edp", "PUBREADER_SUBWRITER", "BOOL"},
    {"announcements", "count", "UINT"},
    {"announcements", "period", "duration"},
    {"port", "portBase", "UINT"},
    {"port", "domainIDGain", "UINT"},
    {"port", "participantIDGain", "UINT"},
    {"port", "offsetd0", "UINT"},
    {"port", "offsetd1", "UINT"},
    {"port", "offsetd2", "UINT"},
    {"port", "offsetd3", "UINT"},
    {"participant_allocation", "remote_locators", "remote_locators"},
    {"participant_allocation", "total_participants", "allocation"},
    {"participant_allocation", "total_readers", "allocation"},
    {"participant_allocation", "total_writers", "allocation"},
    {"participant_allocation", "max_properties", "UINT"},
    {"participant_allocation", "max_user_data", "UINT"},
    {"participant_allocation", "max_partitions", "UINT"},
    {"remote_locators", "max_unicast_locators", "UINT"},
    {"remote_locators", "max_multicast_locators", "UINT"},

    {"writer", "topic", "topic"},
    {"writer", "qos", "qos"},
    {"writer", "times", "writer_times"},
    {"writer", "unicastLocatorList", "locators"},
    {"writer", "multicastLocatorList", "locators"},
    {"writer", "throughputController", "throughput"},
    {"writer", "historyMemoryPolicy", "PREALLOCATED|PREALLOCATED_WITH_REALLOC|DYNAMIC|DYNAMIC_REUSABLE"},
    {"writer", "propertiesPolicy", "properties_policy"},
    {"writer", "matchedSubscribersAllocation", "allocation"},
    {"writer_times", "initialHeartbeatDelay", "duration"},
    {"writer_times", "heartbeatPeriod", "duration"},
    {"writer_times", "nackResponseDelay", "duration"},
    {"writer_times", "nackSupressionDuration", "duration"},
    {"reader", "topic", "topic"},
    {"reader", "qos", "qos"},
    {"reader", "times", "reader_times"},
    {"reader", "unicastLocatorList", "locators"},
    {"reader", "multicastLocatorList", "locators"},
    {"reader", "expectsInlineQos", "BOOL"},
    {"reader", "historyMemoryPolicy", "PREALLOCATED|PREALLOCATED_WITH_REALLOC|DYNAMIC|DYNAMIC_REUSABLE"},
    {"reader", "propertiesPolicy", "properties_policy"},
    {"reader", "matchedPublishersAllocation", "allocation"},
    {"reader_times", "initialAcknackDelay", "duration"},
    {"reader_times", "heartbeatResponseDelay", "duration"},

    {"topic", "historyQos", "history"},
    {"topic", "resourceLimitsQos", "limits"},
    {"history", "kind", "KEEP_LAST|KEEP_ALL"},
    {"history", "depth", "UINT"},
    {"limits", "max_samples", "UINT"},
    {"limits", "max_instances", "UINT"},
    {"limits", "max_samples_per_instance", "UINT"},
    {"limits", "allocated_samples", "UINT"},
    {"limits", "extra_samples", "UINT"},
    {"qos", "durability", "durability"},
    {"qos", "deadline", "period"},
    {"qos", "latencyBudget", "budget"},
    {"qos", "liveliness", "liveliness"},
    {"qos", "reliability", "reliability"},
    {"qos", "lifespan", "budget"},
    {"qos", "ownership", "ownership"},
    {"qos", "ownershipStrength", "strength"},
    {"qos", "partition", "partition"},
    {"qos", "publishMode", "publish_mode"},
    {"qos", "disablePositiveAcks", "positive_acks"},
    {"qos", "disable_heartbeat_piggyback", "BOOL"},
    {"durability", "kind", "VOLATILE|TRANSIENT_LOCAL|TRANSIENT|PERSISTENT"},
    {"period", "period", "duration"},
    {"budget", "duration", "duration"},
    {"liveliness", "kind", "AUTOMATIC|MANUAL_BY_PARTICIPANT|MANUAL_BY_TOPIC"},
    {"liveliness", "lease_duration", "duration"},
    {"liveliness", "announcement_period", "duration"},
    {"reliability", "kind", "BEST_EFFORT|RELIABLE"},
    {"reliability", "max_blocking_time", "duration"},
    {"ownership", "kind", "SHARED|EXCLUSIVE"},
    {"strength", "value", "UINT"},
    {"partition", "names", "names"},
    {"names", "name", "TEXT"},
    {"publish_mode", "kind", "SYNCHRONOUS|ASYNCHRONOUS"},
    {"positive_acks", "enabled", "BOOL"},
    {"positive_acks", "duration", "duration"},

    {"duration", "sec", "SECONDS"},
    {"duration", "nanosec", "UINT"},
    {"throughput", "bytesPerPeriod", "UINT"},
    {"throughput", "periodMillisecs", "UINT"},
    {"allocation", "initial", "UINT"},
    {"allocation", "maximum", "UINT"},
    {"allocation", "increment", "UINT"},
    {"properties_policy", "properties", "properties"},
    {"properties", "property", "property"},
    {"property", "name", "TEXT"},
    {"property", "value", "TEXT"},
    {"property", "propagate", "BOOL"},
    {"locators", "locator", "locator"},
    {"locator", "udpv4", "udpv4"},
    {"udpv4", "port", "UINT"},
    {"udpv4", "address", "TEXT"},
};

bool is_unsigned(std::string_view text) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

bool is_one_of(std::string_view words, std::string_view text) {
  while (!words.empty()) {
    const auto bar = std::min(words.find('|'), words.size());
    if (words.substr(0, bar) == text) return true;
    words.remove_prefix(std::min(bar + 1, words.size()));
  }
  return false;
}

/// Empty if `text` is a value of `content`, else what was expected.
std::string expected_value(std::string_view content, std::string_view text) {
  if (content == "TEXT") return text.empty() ? "a text" : "";
  if (content == "UINT") return is_unsigned(text) ? "" : "a whole number >= 0";
  if (content == "BOOL") return is_one_of("true|false", text) ? "" : "true or false";
  if (content == "SECONDS") {
    return is_unsigned(text) || is_one_of("DURATION_INFINITY", text) ? ""
                                                                     : "whole seconds or DURATION_INFINITY";
  }
  return is_one_of(content, text) ? "" : "one of " + std::string(content);
}

bool is_value(std::string_view content) { return content.front() >= 'A' && content.front() <= 'Z'; }

const Rule* rule_for(std::string_view parent, std::string_view element) {
  const auto* rule = std::find_if(std::begin(kRules), std::end(kRules), [&](const Rule& candidate) {
    return candidate.parent == parent && candidate.element == element;
  });
  return rule == std::end(kRules) ? nullptr : rule;
}

std::string children_of(std::string_view parent) {
  std::string all;
  for (const Rule& rule : kRules) {
    if (rule.parent == parent) all += (all.empty() ? "<" : ", <") + std::string(rule.element) + ">";
  }
  return all;
}

std::string where(const std::string& file, const tinyxml2::XMLElement& element) {
  return file + ":" + std::to_string(element.GetLineNum()) + ": ";
}

/// Only profiles (profile_name), discovery servers (prefix) and the root (xmlns) carry attributes.
Status check_attributes(const tinyxml2::XMLElement& element, std::string_view type, const std::string& file) {
  const bool profile = type == "participant" || type == "writer" || type == "reader";
  for (const auto* attribute = element.FirstAttribute(); attribute; attribute = attribute->Next()) {
    const std::string_view name = attribute->Name();
    const bool known = (profile && name == "profile_name") || (type == "server" && name == "prefix") ||
                       ((type == "dds" || type == "profiles") && name.starts_with("xmlns"));
    if (known) continue;
    return failure(where(file, element) + "attribute " + std::string(name) + " of <" + element.Name() +
                   "> is not allowed here; remove it");
  }
  const char* name = element.Attribute("profile_name");
  if (profile && (!name || !*name)) {
    return failure(where(file, element) + "<" + element.Name() + "> has no profile_name; give it one");
  }
  return {};
}

Status check_element(const tinyxml2::XMLElement& element, std::string_view type, const std::string& file) {
  if (auto status = check_attributes(element, type, file); !status) return status;
  for (const auto* child = element.FirstChildElement(); child; child = child->NextSiblingElement()) {
    const Rule* rule = rule_for(type, child->Name());
    if (!rule) {
      return failure(where(file, *child) + "unknown element <" + child->Name() + "> in <" + element.Name() +
                     ">; expected one of " + children_of(type));
    }
    if (!is_value(rule->content)) {
      if (auto status = check_element(*child, rule->content, file); !status) return status;
      continue;
    }
    const char* text = child->GetText();
    if (const auto expected = expected_value(rule->content, text ? text : ""); !expected.empty()) {
      return failure(where(file, *child) + "<" + child->Name() + "> is \"" + (text ? text : "") +
                     "\"; expected " + expected);
    }
  }
  return {};
}

}  // namespace

Status check_schema(const tinyxml2::XMLElement& root, const std::string& file) {
  const std::string_view name = root.Name();
  if (name != "dds" && name != "profiles") {
    return failure(where(file, root) + "the root element is <" + std::string(name) +
                   ">; expected <dds> or <profiles>, as in Fast DDS profile files");
  }
  return check_element(root, name, file);
}

}  // namespace fleetmap::bus
