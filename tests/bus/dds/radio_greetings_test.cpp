// Robots with keys: who is known by its greeting, who is not, and what is said of it.
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <sys/socket.h>
#include <unistd.h>

#include "bus/captured_log.hpp"
#include "bus/dds_domains.hpp"
#include "bus/fleet.hpp"
#include "fleetmap/bus/dds_bus.hpp"
#include "fleetmap/bus/wire_overhead.hpp"
#include "fleetmap/core/utc.hpp"
#include "fleetmap/trust/datagram.hpp"
#include "trust/fleet_of_keys.hpp"

namespace fleetmap::bus::testing {
namespace {

using fleetmap::testing::agent;
using fleetmap::testing::FleetOfKeys;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using trust::Credentials;
using trust::Role;

constexpr FleetSettings kFleetSettings{
    .wire_schema = 3, .fleet = 1, .submap_voxel = 1, .map_voxel = 1, .placement = 1};
const Topic kNotes{Link::kLongRange, "note", "Note", "small"};

std::uint16_t port_of(int participant) {
  return static_cast<std::uint16_t>(7410 + 250 * static_cast<int>(first_test_domain()) + 2 * participant);
}

/// A socket of this machine that is no robot.
class Outsider {
 public:
  explicit Outsider(std::uint16_t port, const char* group = nullptr)
      : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK, 0)) {
    const int yes = 1;
    ::setsockopt(socket_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_port = htons(port);
    place.sin_addr.s_addr = inet_addr(group != nullptr ? group : "127.0.0.1");
    good_ = ::bind(socket_, reinterpret_cast<const sockaddr*>(&place), sizeof place) == 0;
    if (group == nullptr) return;
    const ip_mreq membership{{inet_addr(group)}, {inet_addr("127.0.0.1")}};
    good_ =
        good_ && ::setsockopt(socket_, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership) == 0;
  }
  ~Outsider() { ::close(socket_); }
  Outsider(const Outsider&) = delete;
  Outsider& operator=(const Outsider&) = delete;

  bool good() const { return good_; }
  const std::vector<Bytes>& record() {
    Bytes datagram(4096);
    for (ssize_t size = 0; (size = ::recv(socket_, datagram.data(), datagram.size(), 0)) >= 0;)
      recorded_.emplace_back(datagram.begin(), datagram.begin() + size);
    return recorded_;
  }
  void replay(std::uint16_t port) const {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(port);
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    for (const Bytes& datagram : recorded_)
      ::sendto(socket_, datagram.data(), datagram.size(), 0, reinterpret_cast<const sockaddr*>(&to),
               sizeof to);
  }

 private:
  int socket_;
  bool good_ = false;
  std::vector<Bytes> recorded_;
};

class SealedRadio : public ::testing::Test {
 protected:
  struct Robot {
    std::unique_ptr<DdsBus> bus;
    std::vector<Bytes> came;
    Handle heard;
  };

  Robot& start(const char* id, const std::optional<Credentials>& keys, bool multicast = false) {
    DdsBusConfig config;
    config.agent = agent(id);
    config.qos_directory = FLEETMAP_SOURCE_DIR "/qos";
    config.onboard.enabled = config.short_range.enabled = false;
    config.long_range.domain = first_test_domain();
    config.long_range.address = "127.0.0.1";
    config.long_range.multicast = multicast;
    config.settings = kFleetSettings;
    if (keys) config.keys = std::make_shared<const Credentials>(*keys);
    auto bus = DdsBus::create(config);
    if (!bus) throw std::runtime_error(bus.error().message);
    Robot& robot = *robots_.emplace_back(std::make_unique<Robot>());
    robot.bus = *std::move(bus);
    robot.heard = robot.bus->subscribe(kNotes, [&robot](const Bytes& cdr) { robot.came.push_back(cdr); });
    robot.bus->advertise(kNotes);
    return robot;
  }
  void stop(const Robot& robot) {
    std::erase_if(robots_, [&](const auto& other) { return other.get() == &robot; });
  }
  bool run_until(const std::function<bool()>& done) {
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (std::chrono::steady_clock::now() < deadline) {
      for (const auto& robot : robots_) {
        if (robot->bus->run_until(done, std::chrono::milliseconds(2))) return true;
      }
    }
    return done();
  }
  static bool knows(const Robot& robot, std::size_t others) {
    const auto matches = robot.bus->matches(kNotes);
    return matches.readers == others && matches.writers == others;
  }
  static std::vector<std::string> notices(const Robot& robot) {
    return robot.bus->survey(Link::kLongRange).refused;
  }
  /// A message arrives. Repeated, since radios may lose it.
  bool hears(const Robot& to, const Robot& from) {
    const Bytes text = message(200, ++seed_).cdr;
    return run_until([&] {
      from.bus->publish(kNotes, text);
      return std::ranges::find(to.came, text) != to.came.end();
    });
  }
  /// r1 and r2 have keys, r3 is as given: r1 names it and nobody takes what it says.
  void expect_refused(const std::optional<Credentials>& keys, const std::string& notice) {
    Robot& first = start("r1", r1_);
    Robot& third = start("r3", keys);
    Robot& second = start("r2", r2_);
    ASSERT_TRUE(run_until([&] { return knows(first, 1) && knows(second, 1) && !notices(first).empty(); }))
        << log_.text();
    EXPECT_THAT(notices(first), ElementsAre(HasSubstr(notice)));
    third.bus->publish(kNotes, message(100, 1).cdr);
    ASSERT_TRUE(hears(second, first));
    EXPECT_TRUE(third.came.empty());
    ASSERT_TRUE(hears(first, second));
    EXPECT_EQ(first.bus->survey(Link::kLongRange).robots.size(), 1u);
    EXPECT_TRUE(knows(first, 1));
    EXPECT_THAT(log_.text(), Not(HasSubstr("heard r3")));
  }

  CapturedLog log_;
  FleetOfKeys fleet_{.made = system_now()};
  Credentials r1_ = fleet_.member("r1"), r2_ = fleet_.member("r2"), r3_ = fleet_.member("r3");
  std::vector<std::unique_ptr<Robot>> robots_;
  std::uint8_t seed_ = 1;
};

TEST_F(SealedRadio, MembersKnowEachOtherAndExchange) {
  Robot& first = start("r1", r1_);
  Robot& second = start("r2", r2_);
  Robot& third = start("r3", r3_);
  ASSERT_TRUE(run_until([&] { return knows(first, 2) && knows(second, 2) && knows(third, 2); }))
      << log_.text();
  EXPECT_TRUE(hears(second, first));
  EXPECT_TRUE(hears(first, second));
  EXPECT_TRUE(hears(first, third));
  for (const Robot* robot : {&first, &second, &third}) EXPECT_TRUE(notices(*robot).empty());
}

TEST_F(SealedRadio, WithTheCertificatesInTheFolderToo) {
  r1_.members = r2_.members = {r1_.certificate, r2_.certificate};
  Robot& first = start("r1", r1_);
  Robot& second = start("r2", r2_);
  ASSERT_TRUE(run_until([&] { return knows(first, 1) && knows(second, 1); }));
  EXPECT_TRUE(hears(second, first));
}

TEST_F(SealedRadio, LargeMessagesArriveWhole) {
  Robot& first = start("r1", r1_);
  Robot& second = start("r2", r2_);
  ASSERT_TRUE(run_until([&] { return knows(first, 1) && knows(second, 1); }));
  const Bytes large = message(6000, 3).cdr;
  EXPECT_TRUE(run_until([&] {
    first.bus->publish(kNotes, large);
    return std::ranges::find(second.came, large) != second.came.end();
  }));
}

TEST_F(SealedRadio, ARobotThatStartsAnewIsKnownAgain) {
  Robot& first = start("r1", r1_);
  for (int k = 0; k < 3; ++k) {
    Robot& second = start("r2", r2_);
    ASSERT_TRUE(run_until([&] { return knows(first, 1) && knows(second, 1); })) << log_.text();
    EXPECT_TRUE(hears(first, second));
    EXPECT_TRUE(hears(second, first));
    stop(second);
  }
}

TEST_F(SealedRadio, ReceivedBytesIncludeTheSeal) {
  Robot& first = start("r1", r1_);
  Robot& second = start("r2", r2_);
  ASSERT_TRUE(run_until([&] { return knows(first, 1) && knows(second, 1); }));
  ASSERT_TRUE(hears(second, first));
  const std::vector<HeardTraffic> traffic = second.bus->take_heard_traffic();
  ASSERT_EQ(traffic.size(), 1u);
  EXPECT_EQ(traffic[0].bytes, traffic[0].messages * wire_bytes(204, {.seal = kSealBytes}));
  static_assert(kSealBytes == trust::kMessageHeaderBytes + trust::kTagBytes - 20);
  static_assert(hello_overhead(true).seal == trust::kGreetingHeaderBytes + trust::kTagBytes - 20);
}

TEST_F(SealedRadio, ARobotWithoutKeysIsNamed) { expect_refused(std::nullopt, "r3 has no keys"); }

TEST_F(SealedRadio, ARobotOfAnotherFleetIsNamed) {
  expect_refused(FleetOfKeys{.made = system_now()}.member("r3"), "r3 has the keys of another fleet");
}

TEST_F(SealedRadio, AnotherAuthoritysCertificateUnderThisFleetsKeyIsNamed) {
  Credentials mixed = FleetOfKeys{.made = system_now()}.member("r3");
  mixed.authority = r1_.authority;
  mixed.fleet_keys = r1_.fleet_keys;
  expect_refused(mixed, "r3 is refused: its certificate was not signed by this fleet's authority");
}

TEST_F(SealedRadio, ARobotWhoseKeysExpiredIsNamed) {
  expect_refused(fleet_.member("r3", Role::kRobot, -std::chrono::hours(1)),
                 "r3 is refused: the certificate of r3 expired on");
}

TEST_F(SealedRadio, ARevokedRobotIsNamed) {
  r1_.revocations = r2_.revocations = {1, {r3_.certificate.serial}};
  expect_refused(r3_, "r3 is refused: the certificate of r3 was revoked");
}

TEST_F(SealedRadio, ARevokedRobotLacksTheFleetsNewKeyAndIsNamed) {
  const trust::FleetKeys next = trust::with_new_epoch(fleet_.fleet_keys);
  for (Credentials* member : {&r1_, &r2_}) {
    member->fleet_keys = next;
    member->revocations = {1, {r3_.certificate.serial}};
    member->members = {r3_.certificate};
  }
  expect_refused(r3_, "r3 was revoked");
}

TEST_F(SealedRadio, ARobotThatMissedTheNewKeyIsNamed) {
  r1_.fleet_keys = r2_.fleet_keys = trust::with_new_epoch(fleet_.fleet_keys);
  expect_refused(r3_, "r3 has an old key of the fleet (its number 1, ours 2): copy its folder anew");
}

TEST_F(SealedRadio, ARobotUnderTheNameOfAnotherIsNamed) {
  expect_refused(fleet_.member("r4"), "r3 is refused: it has the keys of r4");
}

TEST_F(SealedRadio, AnObserverHearsAndIsNotHeard) {
  Robot& first = start("r1", r1_);
  Robot& observer = start("o1", fleet_.member("o1", Role::kObserver));
  ASSERT_TRUE(run_until([&] { return knows(first, 1) && knows(observer, 1); })) << log_.text();
  Robot& second = start("r2", r2_);
  ASSERT_TRUE(run_until([&] { return knows(first, 2) && knows(second, 2); })) << log_.text();
  for (std::uint8_t k = 0; k < 20; ++k) observer.bus->publish(kNotes, message(50, k).cdr);
  EXPECT_TRUE(hears(observer, first));
  EXPECT_TRUE(hears(first, second));
  for (const Bytes& cdr : first.came) EXPECT_EQ(cdr.size(), 204u) << "what the observer sent";
  EXPECT_THAT(notices(first), ElementsAre(HasSubstr("o1 may only read (observer)")));
}

/// Replays the messages that r1 sent to r2, and to an address without a robot, before both restarted.
class Replay : public SealedRadio {
 protected:
  void record(const std::optional<Credentials>& first_keys, const std::optional<Credentials>& second_keys) {
    ASSERT_TRUE(at_no_robot_.good() && at_group_.good());
    Robot& first = start("r1", first_keys, true);
    Robot& second = start("r2", second_keys, true);
    Robot& third = start("r3", second_keys ? std::optional(r3_) : std::nullopt, true);
    ASSERT_TRUE(run_until([&] { return knows(first, 2) && knows(second, 2) && knows(third, 2); }));
    ASSERT_TRUE(hears(second, first));
    // Hellos of all three, and messages.
    constexpr std::size_t kHellos = 6;
    ASSERT_TRUE(
        run_until([&] { return at_no_robot_.record().size() >= kHellos && !at_group_.record().empty(); }));
  }
  void replay(std::uint16_t port) const {
    at_no_robot_.replay(port);
    at_group_.replay(port);
  }
  Outsider at_no_robot_{port_of(9)};
  Outsider at_group_{static_cast<std::uint16_t>(7401 + 250 * first_test_domain()), "239.255.0.1"};
};

TEST_F(Replay, WithoutKeysDeceives) {
  record(std::nullopt, std::nullopt);
  robots_.clear();
  Robot& second = start("r2", std::nullopt, true);
  EXPECT_TRUE(run_until([&] {
    replay(port_of(0));
    return second.bus->survey(Link::kLongRange).robots.size() >= 1;
  }));
}

TEST_F(Replay, GreetingOfYesterdayIsRefusedByARobotThatJustStarted) {
  record(r1_, r2_);
  robots_.clear();
  Robot& second = start("r2", r2_, true);
  Robot& third = start("r3", r3_, true);
  ASSERT_TRUE(run_until([&] {
    replay(port_of(0));
    return knows(second, 1) && knows(third, 1);
  }));
  ASSERT_TRUE(hears(second, third)) << "what was replayed came before";
  EXPECT_EQ(second.bus->survey(Link::kLongRange).robots.size(), 1u);
  EXPECT_EQ(second.came.size(),
            static_cast<std::size_t>(std::ranges::count(second.came, second.came.back())));
  EXPECT_THAT(notices(second), ElementsAre());
}

TEST_F(Replay, WhileTheSenderIsStillThereIsRefusedToo) {
  record(r1_, r2_);
  Robot& first = *robots_[0];
  stop(*robots_[1]);
  Robot& second = start("r2", r2_, true);
  ASSERT_TRUE(run_until([&] { return knows(first, 2) && knows(second, 2); })) << log_.text();
  ASSERT_TRUE(hears(second, first));
  const Bytes last = second.came.back();
  replay(port_of(1));
  replay(port_of(0));
  ASSERT_TRUE(hears(second, first));
  for (const Bytes& cdr : second.came)
    EXPECT_TRUE(cdr == last || cdr == second.came.back()) << "of before its start";
}

}  // namespace
}  // namespace fleetmap::bus::testing
