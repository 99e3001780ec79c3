#include "robot/service_notice.hpp"

#include <gmock/gmock.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "fleetmap/bus/local_network.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;

/// systemd's end of the socket.
class Supervisor {
 public:
  Supervisor() : socket_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string path = (folder_.path() / "notify").string();
    path.copy(address.sun_path, sizeof(address.sun_path) - 1);
    EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
    ::setenv("NOTIFY_SOCKET", path.c_str(), 1);
  }
  ~Supervisor() {
    ::unsetenv("NOTIFY_SOCKET");
    ::unsetenv("WATCHDOG_USEC");
    ::close(socket_);
  }
  std::vector<std::string> heard() const {
    std::vector<std::string> messages;
    char buffer[256];
    for (ssize_t size = 0; (size = ::recv(socket_, buffer, sizeof(buffer), 0)) > 0;)
      messages.emplace_back(buffer, static_cast<std::size_t>(size));
    return messages;
  }

 private:
  fleetmap::testing::TemporaryFolder folder_;
  int socket_;
};

TEST(ServiceNotice, IsReadyFeedsTheWatchdogByItsCallbacksAndStops) {
  const Supervisor supervisor;
  ::setenv("WATCHDOG_USEC", "3000000", 1);
  const auto network = *bus::LocalNetwork::create({});
  bus::Bus& bus = network->add_robot(*AgentId::parse("r1"));
  {
    const ServiceNotice notice(bus);
    EXPECT_THAT(supervisor.heard(), ElementsAre("READY=1"));
    network->run_until(Stamp{} + std::chrono::milliseconds(4500));
    const auto fed = supervisor.heard();
    EXPECT_EQ(fed.size(), 4u) << "each second of the bus";
    EXPECT_THAT(fed, Each("WATCHDOG=1"));
  }
  EXPECT_THAT(supervisor.heard(), ElementsAre("STOPPING=1"));
  network->run_until(Stamp{} + std::chrono::seconds(9));
  EXPECT_TRUE(supervisor.heard().empty());
}

TEST(ServiceNotice, WorkThatHangsIsNoProgress) {
  const Supervisor supervisor;
  ::setenv("WATCHDOG_USEC", "30000000", 1);
  for (const Duration work : {Duration(std::chrono::minutes(8)), Duration(std::chrono::hours(2))}) {
    bus::LocalNetworkConfig config;
    config.background_time = work;
    const auto network = *bus::LocalNetwork::create(config);
    const ServiceNotice notice(network->add_robot(*AgentId::parse("r1")));
    for (int minute = 1; minute <= 20; ++minute) {
      network->run_until(Stamp{} + std::chrono::minutes(minute));
      const bool hangs = work > ServiceNotice::kMaxWork && minute > 11;
      const bool fed = !supervisor.heard().empty();  // read each minute: the socket holds few messages
      if (minute == 11) continue;
      EXPECT_EQ(fed, !hangs) << minute;
    }
  }
}

TEST(ServiceNotice, WithoutAWatchdogItOnlyTellsThatItIsReady) {
  const Supervisor supervisor;
  const auto network = *bus::LocalNetwork::create({});
  const ServiceNotice notice(network->add_robot(*AgentId::parse("r1")));
  network->run_until(Stamp{} + std::chrono::seconds(60));
  EXPECT_THAT(supervisor.heard(), ElementsAre("READY=1"));
}

}  // namespace
}  // namespace fleetmap::apps
