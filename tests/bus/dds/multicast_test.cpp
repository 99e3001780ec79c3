// Messages to all robots as one datagram to a multicast group.
#include <arpa/inet.h>
#include <sys/socket.h>

#include <array>

#include "bus/qos_directory.hpp"

namespace fleetmap::bus::testing {
namespace {

/// Counts the datagrams that arrive at a multicast group on the loopback.
class GroupListener {
 public:
  GroupListener(const char* group, std::uint16_t port)
      : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK, 0)) {
    const int yes = 1;
    ::setsockopt(socket_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_port = htons(port);
    place.sin_addr.s_addr = inet_addr(group);
    const ip_mreq membership{{inet_addr(group)}, {inet_addr("127.0.0.1")}};
    good_ = ::bind(socket_, reinterpret_cast<const sockaddr*>(&place), sizeof(place)) == 0 &&
            ::setsockopt(socket_, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof(membership)) == 0;
  }
  ~GroupListener() { ::close(socket_); }
  GroupListener(const GroupListener&) = delete;
  GroupListener& operator=(const GroupListener&) = delete;
  bool good() const { return good_; }
  /// Since the last call.
  int count() const {
    std::array<char, 4096> datagram{};
    int datagrams = 0;
    while (::recv(socket_, datagram.data(), datagram.size(), 0) >= 0) ++datagrams;
    return datagrams;
  }

 private:
  int socket_;
  bool good_ = false;
};

/// r1 tells r2 and r3 twenty times; returns how many datagrams went to the group.
class Multicast : public QosDirectory {
 protected:
  int tell_two(bool multicast, bool third_has_it) {
    config_.long_range.multicast = multicast;
    const Topic topic{Link::kLongRange, "node", "Node", "small"};
    const auto sender = DdsBus::create(config_).value();
    sender->advertise(topic);
    config_.agent = AgentId::parse("r2").value();
    const auto second = DdsBus::create(config_).value();
    config_.agent = AgentId::parse("r3").value();
    config_.long_range.multicast = third_has_it;
    const auto third = DdsBus::create(config_).value();
    int at_second = 0, at_third = 0;
    const Handle first_handle = second->subscribe(topic, [&](const Bytes&) { ++at_second; });
    const Handle second_handle = third->subscribe(topic, [&](const Bytes&) { ++at_third; });
    const auto run_all = [&](const std::function<bool()>& done) {
      return run_both(*second, *third, [&] {
        sender->run_until([] { return false; }, std::chrono::milliseconds(1));
        return done();
      });
    };
    EXPECT_TRUE(run_all([&] { return sender->matches(topic).readers == 2; }));
    // RTPS's multicast port for data: base 7400, 250 a domain, offset 1.
    const GroupListener group("239.255.0.1",
                              static_cast<std::uint16_t>(7401 + 250 * config_.long_range.domain));
    EXPECT_TRUE(group.good());
    for (int n = 0; n < 20; ++n) sender->publish(topic, Bytes(200));
    EXPECT_TRUE(run_all([&] { return at_second >= 20 && at_third >= 20; }));
    // Duplicates would arrive before this message.
    sender->publish(topic, Bytes(200));
    EXPECT_TRUE(run_all([&] { return at_second >= 21 && at_third >= 21; }));
    EXPECT_EQ(at_second, 21);
    EXPECT_EQ(at_third, 21);
    return group.count();
  }
};

TEST_F(Multicast, MessageForAllIsOneDatagram) { EXPECT_EQ(tell_two(true, true), 21); }

TEST_F(Multicast, WithoutItEachGetsItsOwn) { EXPECT_EQ(tell_two(false, false), 0); }

TEST_F(Multicast, ARobotWithoutItGetsItsOwn) { EXPECT_EQ(tell_two(true, false), 0); }

}  // namespace
}  // namespace fleetmap::bus::testing
