// One robot's long range as plain DDS: a participant with a writer and a reader of each kind of message, with
// or without DDS Security. Prints when every endpoint has matched those of all robots; dds_security.sh starts
// a fleet.
//   bench_dds_security NAME ROBOTS simple|static PEERS.txt [SECURITY_FOLDER]    ends on SIGTERM
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fstream>
#include <map>
#include <string>

namespace {

namespace edds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastdds::rtps::UDPv4TransportDescriptor;
using Clock = std::chrono::steady_clock;

constexpr int kDomain = 1;
/// One topic for each kind of message, which is the least that DDS discovery would have to tell of.
constexpr const char* kTopics[] = {"node",           "alignment",     "digest",          "status",
                                   "mission_report", "hold",          "proximity_match", "cloud_request",
                                   "item_request",   "cloud_fragment"};
constexpr int kEndpoints = 2 * static_cast<int>(std::size(kTopics));

/// No sample is sent: what is measured is what comes before the first.
class EmptyType final : public edds::TopicDataType {
 public:
  EmptyType() {
    setName("Empty");
    m_typeSize = 64;
  }
  bool serialize(void*, rtps::SerializedPayload_t*) override { return true; }
  bool deserialize(rtps::SerializedPayload_t*, void*) override { return true; }
  std::function<std::uint32_t()> getSerializedSizeProvider(void*) override {
    return [] { return 0U; };
  }
  void* createData() override { return new int(0); }
  void deleteData(void* data) override { delete static_cast<int*>(data); }
  bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }
};

/// Counts the matches of all endpoints of this robot.
class Matches final : public edds::DataWriterListener, public edds::DataReaderListener {
 public:
  explicit Matches(int wanted) : wanted_(wanted) {}
  void on_publication_matched(edds::DataWriter*, const edds::PublicationMatchedStatus& status) override {
    add(status.current_count_change);
  }
  void on_subscription_matched(edds::DataReader*, const edds::SubscriptionMatchedStatus& status) override {
    add(status.current_count_change);
  }
  int count() const { return count_; }

 private:
  void add(int change) {
    if ((count_ += change) != wanted_) return;
    std::printf("matched %.1f\n", std::chrono::duration<double>(Clock::now() - begun_).count());
    std::fflush(stdout);
  }
  int wanted_;
  Clock::time_point begun_ = Clock::now();
  std::atomic<int> count_ = 0;
};

rtps::Locator_t at(const std::string& address, const rtps::PortParameters& ports) {
  rtps::Locator_t locator;
  locator.kind = LOCATOR_KIND_UDPv4;
  rtps::IPLocator::setIPv4(locator, address);
  locator.port = ports.getUnicastPort(kDomain, 0);
  return locator;
}

void secure(const std::string& folder, edds::DomainParticipantQos& qos) {
  const auto file = [&](const std::string& name) { return "file://" + folder + "/" + name; };
  const std::map<std::string, std::string> properties = {
      {"dds.sec.auth.plugin", "builtin.PKI-DH"},
      {"dds.sec.auth.builtin.PKI-DH.identity_ca", file("ca.pem")},
      {"dds.sec.auth.builtin.PKI-DH.identity_certificate", file("cert.pem")},
      {"dds.sec.auth.builtin.PKI-DH.private_key", file("key.pem")},
      {"dds.sec.access.plugin", "builtin.Access-Permissions"},
      {"dds.sec.access.builtin.Access-Permissions.permissions_ca", file("ca.pem")},
      {"dds.sec.access.builtin.Access-Permissions.governance", file("governance.smime")},
      {"dds.sec.access.builtin.Access-Permissions.permissions", file("permissions.smime")},
      {"dds.sec.crypto.plugin", "builtin.AES-GCM-GMAC"},
  };
  for (const auto& [name, value] : properties) qos.properties().properties().emplace_back(name, value);
}

edds::DomainParticipantQos participant_qos(char** argv, const std::string& security) {
  edds::DomainParticipantQos qos;
  qos.name(argv[1]);
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(std::make_shared<UDPv4TransportDescriptor>());
  auto& wire = qos.wire_protocol();
  auto& discovery = wire.builtin.discovery_config;
  discovery.leaseDuration = {70, 0};  // as in qos/long_range.xml
  discovery.leaseDuration_announcementperiod = {20, 0};
  wire.builtin.metatrafficUnicastLocatorList.push_back(at("0.0.0.0", wire.port));  // no multicast
  std::ifstream peers(argv[4]);
  for (std::string address; peers >> address;)
    wire.builtin.initialPeersList.push_back(at(address, wire.port));
  if (std::string(argv[3]) == "static") {
    discovery.use_SIMPLE_EndpointDiscoveryProtocol = false;
    discovery.use_STATIC_EndpointDiscoveryProtocol = true;
    discovery.static_edp_xml_config(("file://" + std::string(argv[4]) + ".xml").c_str());
  }
  if (!security.empty()) secure(security, qos);
  return qos;
}

template <typename Qos>
Qos endpoint_qos(int id) {
  Qos qos;
  qos.reliability().kind = edds::BEST_EFFORT_RELIABILITY_QOS;
  qos.durability().kind = edds::VOLATILE_DURABILITY_QOS;
  qos.endpoint().user_defined_id = static_cast<std::int16_t>(id);  // by which static discovery names it
  qos.endpoint().entity_id = static_cast<std::int16_t>(id);
  return qos;
}

/// False where Fast DDS refuses an endpoint; its log says why.
bool add_endpoints(edds::DomainParticipant& participant, Matches& matches) {
  edds::TypeSupport(new EmptyType).register_type(&participant);
  auto* publisher = participant.create_publisher(edds::PUBLISHER_QOS_DEFAULT);
  auto* subscriber = participant.create_subscriber(edds::SUBSCRIBER_QOS_DEFAULT);
  int id = 0;
  for (const char* name : kTopics) {
    auto* topic = participant.create_topic(std::string("fleetmap/") + name, "Empty", edds::TOPIC_QOS_DEFAULT);
    if (!publisher->create_datawriter(topic, endpoint_qos<edds::DataWriterQos>(++id), &matches)) return false;
    if (!subscriber->create_datareader(topic, endpoint_qos<edds::DataReaderQos>(++id), &matches))
      return false;
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) return 2;
  sigset_t ends;
  sigemptyset(&ends);
  sigaddset(&ends, SIGTERM);
  sigprocmask(SIG_BLOCK, &ends, nullptr);              // before Fast DDS starts threads
  const int wanted = kEndpoints * std::atoi(argv[2]);  // its own match each other as well
  Matches matches(wanted);
  auto* participant = edds::DomainParticipantFactory::get_instance()->create_participant(
      kDomain, participant_qos(argv, argc > 5 ? argv[5] : ""));
  if (participant == nullptr || !add_endpoints(*participant, matches)) return 1;
  int signal = 0;
  sigwait(&ends, &signal);
  std::printf("in all %d of %d\n", matches.count() - kEndpoints, wanted - kEndpoints);
  std::fflush(stdout);
  std::_Exit(0);  // whoever leaves would tell the others so
}
