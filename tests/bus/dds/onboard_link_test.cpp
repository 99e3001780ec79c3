#include "bus/dds/onboard_link.hpp"

#include <gmock/gmock.h>

#include <stdexcept>

#include "bus/qos_directory.hpp"

namespace fleetmap::bus::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const Topic kPoints{Link::kOnboard, "rt/points", "Points", "sensor"};

/// Two processes of one robot, here two links in one.
class OnboardLinkTest : public QosDirectory {
 protected:
  Result<std::shared_ptr<LinkEnd>> make() {
    auto qos = load_qos_file(directory_, Link::kOnboard);
    if (!qos) return tl::unexpected(qos.error());
    return OnboardLink::create(config_.onboard, config_.agent, *std::move(qos), executor_);
  }
  /// False after a minute without `done()`.
  bool run_until(const std::function<bool()>& done) {
    const auto deadline = Executor::Clock::now() + std::chrono::minutes(1);
    while (!done()) {
      if (Executor::Clock::now() > deadline) return false;
      executor_->run_one(Executor::Clock::now() + std::chrono::milliseconds(5));
    }
    return true;
  }

  std::shared_ptr<Executor> executor_ = std::make_shared<Executor>();
};

TEST_F(OnboardLinkTest, EndsMatchWhileBothAreOpenAndSamplesCome) {
  const auto driver = make().value(), agent = make().value();
  driver->advertise(kPoints);
  Bytes came;
  for (int round = 0; round < 2; ++round) {
    Handle reads = agent->subscribe(kPoints, [&](const Bytes& cdr) { came = cdr; });
    ASSERT_TRUE(run_until(
        [&] { return driver->matches(kPoints).readers == 1 && agent->matches(kPoints).writers == 1; }));
    const Bytes sample{0, 1, 0, 0, 7, static_cast<std::uint8_t>(round)};
    driver->publish(kPoints, sample);
    EXPECT_TRUE(run_until([&] { return came == sample; }));
    reads.reset();
    EXPECT_TRUE(run_until([&] { return driver->matches(kPoints).readers == 0; }));
    EXPECT_EQ(agent->matches(kPoints).writers, 0u);
  }
}

/// A driver of another type on the same topic is no match, so nothing is decoded as what it is not.
TEST_F(OnboardLinkTest, AnotherTypeDoesNotMatch) {
  const auto driver = make().value(), agent = make().value();
  Topic other = kPoints;
  other.type = "Imu";
  driver->advertise(other);
  driver->advertise({Link::kOnboard, "rt/imu", "Imu", "sensor"});
  const Handle reads = agent->subscribe(kPoints, [](const Bytes&) {});
  const Handle imu = agent->subscribe({Link::kOnboard, "rt/imu", "Imu", "sensor"}, [](const Bytes&) {});
  ASSERT_TRUE(run_until([&] {
    return driver->matches({Link::kOnboard, "rt/imu", "Imu", "sensor"}).readers == 1;
  }));
  EXPECT_EQ(driver->matches(other).readers, 0u);
  EXPECT_EQ(agent->matches(kPoints).writers, 0u);
}

TEST_F(OnboardLinkTest, AProfileThatFastDdsRefusesIsNamed) {
  replace("onboard.xml", "<kind>TRANSIENT_LOCAL</kind>", "<kind>PERSISTENT</kind>");
  const auto link = make();
  ASSERT_TRUE(link) << link.error().message;
  EXPECT_THAT(
      [&] { (*link)->advertise(kPoints); },
      ThrowsMessage<std::logic_error>(HasSubstr("onboard.xml: Fast DDS refuses the data writer profile "
                                                "\"sensor\"")));
}

TEST_F(OnboardLinkTest, AnAddressThatIsNotThereIsNamed) {
  config_.onboard.address = "192.0.2.77";
  const auto link = make();
  ASSERT_FALSE(link);
  EXPECT_THAT(link.error().message, HasSubstr("192.0.2.77"));
}

}  // namespace
}  // namespace fleetmap::bus::testing
