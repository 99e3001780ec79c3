#include "qos_file.hpp"

#include <fastrtps/attributes/ParticipantAttributes.h>
#include <fastrtps/xmlparser/XMLProfileManager.h>
#include <tinyxml2.h>

#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fstream>
#include <iterator>
#include <map>
#include <mutex>
#include <sstream>

#include "fleetmap/bus/dds_bus.hpp"
#include "fleetmap/core/bytes.hpp"
#include "qos_schema.hpp"

namespace fleetmap::bus {
namespace {

using eprosima::fastrtps::ParticipantAttributes;
using eprosima::fastrtps::xmlparser::XMLP_ret;
using eprosima::fastrtps::xmlparser::XMLProfileManager;
using Factory = eprosima::fastdds::dds::DomainParticipantFactory;

/// Line of every profile_name, by kind of profile, and of every transport_id.
struct Names {
  std::map<std::string, int> participants;
  std::map<std::string, int> writers;
  std::map<std::string, int> readers;
  std::map<std::string, int> transports;
};

Result<std::string> read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file) {
    return failure(path.string() +
                   ": cannot be read; the QoS directory must hold onboard.xml, long_range.xml and " +
                   "short_range.xml (see docs/reference/dds.md)");
  }
  return text;
}

tinyxml2::XMLElement* profiles_element(tinyxml2::XMLDocument& document) {
  auto* root = document.RootElement();
  return std::string(root->Name()) == "profiles" ? root : root->FirstChildElement("profiles");
}

Status add_name(std::map<std::string, int>& names, const std::string& name,
                const tinyxml2::XMLElement& element, const std::string& file) {
  const auto [entry, fresh] = names.emplace(name, element.GetLineNum());
  if (fresh) return {};
  return failure(file + ":" + std::to_string(element.GetLineNum()) + ": <" + element.Name() + "> \"" + name +
                 "\" is already defined at line " + std::to_string(entry->second) + "; rename one of them");
}

/// Puts `prefix` before the transport_ids below `element`, which must be among `transports`.
Status prefix_transport_ids(tinyxml2::XMLElement& participant, const std::string& prefix, const Names& names,
                            const std::string& file) {
  auto* rtps = participant.FirstChildElement("rtps");
  auto* used = rtps ? rtps->FirstChildElement("userTransports") : nullptr;
  for (auto* id = used ? used->FirstChildElement() : nullptr; id; id = id->NextSiblingElement()) {
    const std::string name = id->GetText();
    if (!names.transports.contains(name)) {
      std::ostringstream message;
      message << file << ':' << id->GetLineNum() << ": no <transport_descriptor> has the id \"" << name
              << "\"; define it in <transport_descriptors> before its use";
      return failure(message.str());
    }
    id->SetText((prefix + name).c_str());
  }
  return {};
}

/// Collects the names and puts `prefix` before each.
Status prefix_names(tinyxml2::XMLElement& profiles, const std::string& prefix, const std::string& file,
                    Names& names) {
  for (auto* child = profiles.FirstChildElement(); child; child = child->NextSiblingElement()) {
    const std::string kind = child->Name();
    if (kind == "transport_descriptors") {
      for (auto* transport = child->FirstChildElement(); transport;
           transport = transport->NextSiblingElement()) {
        auto* id = transport->FirstChildElement("transport_id");
        if (!id) {
          return failure(file + ":" + std::to_string(transport->GetLineNum()) +
                         ": <transport_descriptor> has no <transport_id>; give it one");
        }
        if (auto status = add_name(names.transports, id->GetText(), *id, file); !status) return status;
        id->SetText((prefix + id->GetText()).c_str());
      }
      continue;
    }
    auto& same_kind = kind == "participant"   ? names.participants
                      : kind == "data_writer" ? names.writers
                                              : names.readers;
    const std::string name = child->Attribute("profile_name");
    if (auto status = add_name(same_kind, name, *child, file); !status) return status;
    if (kind == "participant") {
      if (auto status = prefix_transport_ids(*child, prefix, names, file); !status) return status;
    }
    child->SetAttribute("profile_name", (prefix + name).c_str());
  }
  return {};
}

Status check_wanted(const Names& names, Link link, const std::string& file) {
  const auto missing = [&](const char* kind, const std::string& name) {
    return failure(file + ": no <" + kind + " profile_name=\"" + name +
                   "\">; add that profile (docs/reference/dds.md says " + "what it is for)");
  };
  if (!names.participants.contains(to_string(link))) return missing("participant", to_string(link));
  for (const std::string& profile : profiles_of(link)) {
    if (!names.writers.contains(profile)) return missing("data_writer", profile);
    if (!names.readers.contains(profile)) return missing("data_reader", profile);
  }
  return {};
}

Status give_to_fast_dds(const tinyxml2::XMLDocument& document, const QosFile& file, Link link) {
  // Fast DDS has one unguarded table of profiles per process, so loading into it needs one lock per process.
  static std::mutex loading;
  const std::scoped_lock lock(loading);
  ParticipantAttributes known;
  if (XMLProfileManager::fillParticipantAttributes(file.registered(to_string(link)), known, false) ==
      XMLP_ret::XML_OK) {
    return {};
  }
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  const auto code = Factory::get_instance()->load_XML_profiles_string(
      printer.CStr(), static_cast<std::size_t>(printer.CStrSize() - 1));
  if (code == eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK) return {};
  return failure(file.path.string() +
                 ": Fast DDS refuses these profiles; its log on the standard error output says " +
                 "which element");
}

}  // namespace

Result<QosFile> load_qos_file(const std::filesystem::path& directory, Link link) {
  QosFile result;
  result.path = directory / (std::string(to_string(link)) + ".xml");
  const std::string file = result.path.string();
  const auto text = read_text(result.path);
  if (!text) return tl::unexpected(text.error());

  tinyxml2::XMLDocument document;
  if (document.Parse(text->data(), text->size()) != tinyxml2::XML_SUCCESS || !document.RootElement()) {
    return failure(file + ":" + std::to_string(document.ErrorLineNum()) + ": is not well-formed XML (" +
                   document.ErrorStr() + "); correct the file");
  }
  if (auto status = check_schema(*document.RootElement(), file); !status)
    return tl::unexpected(status.error());
  auto* profiles = profiles_element(document);
  if (!profiles) return failure(file + ": has no <profiles> element; add one");

  result.prefix = to_hex(content_hash(bytes_of(*text))).substr(0, 12) + "/";
  Names names;
  if (auto status = prefix_names(*profiles, result.prefix, file, names); !status) {
    return tl::unexpected(status.error());
  }
  if (auto status = check_wanted(names, link, file); !status) return tl::unexpected(status.error());
  for (const auto& [name, line] : names.writers) {
    if (names.readers.contains(name)) result.profiles.insert(name);
  }
  if (auto status = give_to_fast_dds(document, result, link); !status) return tl::unexpected(status.error());
  return result;
}

void check_profile(const QosFile& file, const Topic& topic) {
  if (file.profiles.contains(topic.profile)) return;
  throw std::logic_error(file.path.string() + ": topic " + topic.name + " needs a <data_writer> and a " +
                         "<data_reader> profile \"" + topic.profile + "\"; add them");
}

WriterPolicy writer_policy(const QosFile& file, const std::string& profile) {
  eprosima::fastrtps::PublisherAttributes attributes;
  eprosima::fastrtps::xmlparser::XMLProfileManager::fillPublisherAttributes(file.registered(profile),
                                                                            attributes);
  WriterPolicy policy;
  policy.best_effort =
      attributes.qos.m_reliability.kind == eprosima::fastdds::dds::BEST_EFFORT_RELIABILITY_QOS;
  policy.synchronous = attributes.qos.m_publishMode.kind == eprosima::fastdds::dds::SYNCHRONOUS_PUBLISH_MODE;
  policy.depth = static_cast<std::size_t>(std::max(1, attributes.topic.historyQos.depth));
  return policy;
}

}  // namespace fleetmap::bus
