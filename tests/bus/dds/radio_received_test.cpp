#include "bus/dds/radio_received.hpp"

#include <gtest/gtest.h>

#include "bus/dds/lone_radio.hpp"
#include "fleetmap/bus/wire_overhead.hpp"

namespace fleetmap::bus::testing {
namespace {

const Topic kStatus{Link::kLongRange, "fleetmap/status", "Type", "small"};

/// r1 knows r2, whose messages the test sends.
class RadioReceivedTest : public LoneRadio {
 protected:
  void SetUp() override {
    bus_ = &start(robot("r1"));
    handle_ = bus_->subscribe(kStatus, [this](const Bytes& cdr) { came_.push_back(cdr.back()); });
    Hello hello = some_hello();
    hello.link = Link::kLongRange;
    hello.address = {127, 0, 0, 1};
    hello.port = static_cast<std::uint16_t>(own_ + 2);
    ASSERT_TRUE(run_until([&] {
      send_to(own_, rtps_message(encode(hello), ++hellos_, kKnown));
      return heard(*bus_) == 1;
    })) << log_.text();
    bus_->take_heard_traffic();
  }
  /// Message `number` of a robot's writer of the topic; its last byte is the number.
  void send(std::uint8_t participant, std::uint8_t number) {
    Bytes message = rtps_message({0, 1, 0, 0, 9, 9, 9, number}, number, participant);
    const std::uint32_t writer = key_of(kStatus);
    constexpr std::size_t kWriter = 20 + 4 + 4 + 4;  // behind RTPS header, submessage header, offset, reader
    for (std::size_t k = 0; k < 3; ++k)
      message[kWriter + k] = static_cast<std::uint8_t>(writer >> (16 - 8 * k));
    send_to(own_, message);
  }
  bool came(std::uint8_t number) {
    return run_until([&] { return std::ranges::count(came_, number) > 0; });
  }

  static constexpr std::uint8_t kKnown = 2, kStranger = 3;
  DdsBus* bus_ = nullptr;
  Handle handle_;
  const std::uint16_t own_ = static_cast<std::uint16_t>(7410 + 250 * first_test_domain());
  std::uint8_t hellos_ = 0;
  std::vector<std::uint8_t> came_;
};

TEST_F(RadioReceivedTest, GapsInAWritersNumbersAreWhatTheRadioLost) {
  for (const std::uint8_t number : std::array<std::uint8_t, 4>{1, 2, 5, 9}) {
    send(kKnown, number);
    ASSERT_TRUE(came(number)) << int{number};
  }
  const auto heard = bus_->take_heard_traffic();
  ASSERT_EQ(heard.size(), 1u);
  EXPECT_EQ(heard[0].from, name("r2"));
  EXPECT_EQ(heard[0].messages, 4u);
  EXPECT_EQ(heard[0].lost, 2u + 3u);
  EXPECT_EQ(heard[0].bytes, 4 * wire_bytes(8));
  send(kKnown, 10);
  ASSERT_TRUE(came(10));
  EXPECT_EQ(bus_->take_heard_traffic().at(0).lost, 0u) << "counted once";
}

TEST_F(RadioReceivedTest, MessagesOfUnknownSendersAreDropped) {
  send(kStranger, 1);
  send(kKnown, 7);
  ASSERT_TRUE(came(7));
  EXPECT_EQ(came_, std::vector<std::uint8_t>{7});
  EXPECT_EQ(bus_->take_heard_traffic().size(), 1u);
}

}  // namespace
}  // namespace fleetmap::bus::testing
