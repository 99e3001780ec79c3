#include "fleetmap/sensor/mavlink_frames.hpp"

#include <gmock/gmock.h>

#include "fleetmap/sensor/mavlink_messages.hpp"
#include "mavlink_golden.hpp"

namespace fleetmap::sensor {
namespace {

using fleetmap::testing::golden_mavlink;
using ::testing::ElementsAreArray;

/// A frame whose payload has each of the bytes that begin frames.
Bytes frame(std::uint8_t sequence) {
  return mavlink_frame(kMavlinkTimesync, Bytes{0xfd, 0xfe, sequence, 4, 5, 0xfe, 7, 0xfd, 9}, sequence);
}

Bytes stream(std::size_t frames) {
  Bytes bytes;
  for (std::size_t k = 0; k < frames; ++k) {
    const Bytes next = frame(static_cast<std::uint8_t>(k));
    bytes.insert(bytes.end(), next.begin(), next.end());
  }
  return bytes;
}

/// Third bytes of the payloads, by which the frames of stream() are told apart.
std::vector<int> found_in(ByteView bytes) {
  std::vector<int> found;
  for (const MavlinkFrame& frame : MavlinkFrames().add(bytes)) found.push_back(frame.payload.at(2));
  return found;
}

std::vector<int> all_but(std::size_t frames, std::size_t missing) {
  std::vector<int> numbers;
  for (std::size_t k = 0; k < frames; ++k) {
    if (k != missing) numbers.push_back(static_cast<int>(k));
  }
  return numbers;
}

TEST(MavlinkFrames, FindsWhatAnotherImplementationWrote) {
  MavlinkFrames reader;
  std::vector<std::uint32_t> ids;
  for (const MavlinkFrame& frame : reader.add(golden_mavlink())) {
    ids.push_back(frame.id);
    EXPECT_EQ(frame.system, 7);
    EXPECT_EQ(frame.component, 1);
  }
  std::vector<std::uint32_t> expected;
  for (int protocol = 0; protocol < 3; ++protocol)
    expected.insert(expected.end(), {0, 2, 24, 31, 26, 105, 111});
  EXPECT_THAT(ids, ElementsAreArray(expected));
  EXPECT_EQ(reader.counters().others, 3u) << "VFR_HUD";
  EXPECT_EQ(reader.counters().wrong_checksums, 0u);
  EXPECT_EQ(reader.counters().skipped_bytes, 0u);
}

TEST(MavlinkFrames, BytesOneByOneAreTheSameStream) {
  const Bytes bytes = golden_mavlink();
  MavlinkFrames reader;
  std::size_t frames = 0;
  for (const std::uint8_t byte : bytes) frames += reader.add(Bytes{byte}).size();
  EXPECT_EQ(frames, 21u);
  EXPECT_EQ(reader.counters().skipped_bytes, 0u);
}

TEST(MavlinkFrames, AFlippedBitCostsItsFrameAlone) {
  constexpr std::size_t kFrames = 20;  // more bytes than the longest frame follow
  const std::size_t size = frame(0).size();
  const Bytes whole = stream(kFrames);
  for (std::size_t bit = 0; bit < 8 * size; ++bit) {
    Bytes damaged = whole;
    damaged[size + bit / 8] ^= static_cast<std::uint8_t>(1 << bit % 8);
    EXPECT_THAT(found_in(damaged), ElementsAreArray(all_but(kFrames, 1))) << "bit " << bit;
  }
}

TEST(MavlinkFrames, ACutFrameCostsItselfAlone) {
  constexpr std::size_t kFrames = 20;
  const std::size_t size = frame(0).size();
  for (std::size_t lost = 1; lost < size; ++lost) {
    Bytes end_cut = stream(kFrames), begin_cut = end_cut;
    end_cut.erase(end_cut.begin() + static_cast<std::ptrdiff_t>(2 * size - lost),
                  end_cut.begin() + static_cast<std::ptrdiff_t>(2 * size));
    EXPECT_THAT(found_in(end_cut), ElementsAreArray(all_but(kFrames, 1))) << lost << " bytes of its end";
    begin_cut.erase(begin_cut.begin(), begin_cut.begin() + static_cast<std::ptrdiff_t>(lost));
    EXPECT_THAT(found_in(begin_cut), ElementsAreArray(all_but(kFrames, 0))) << lost << " bytes of its begin";
  }
}

TEST(MavlinkFrames, NoiseBetweenFramesCostsNone) {
  Bytes bytes;
  for (int k = 0; k < 20; ++k) {
    for (int noise = 0; noise < 40; ++noise)
      bytes.push_back(static_cast<std::uint8_t>(noise % 4 == 0 ? 0xfd : noise * 37 + k));
    const Bytes next = frame(static_cast<std::uint8_t>(k));
    bytes.insert(bytes.end(), next.begin(), next.end());
  }
  bytes.resize(bytes.size() + 300);
  EXPECT_THAT(found_in(bytes), ElementsAreArray(all_but(20, 20)));
}

TEST(MavlinkFrames, DamageIsCounted) {
  Bytes bytes = stream(3);
  bytes[frame(0).size() + 12] ^= 1;
  MavlinkFrames reader;
  EXPECT_EQ(reader.add(bytes).size(), 2u);
  EXPECT_EQ(reader.counters().wrong_checksums, 1u);
  EXPECT_EQ(reader.counters().skipped_bytes, frame(1).size());
}

TEST(MavlinkFrames, UnknownFlagsAreNotRead) {
  Bytes bytes = stream(3);
  bytes[frame(0).size() + 2] = 0x04;
  MavlinkFrames reader;
  EXPECT_EQ(reader.add(bytes).size(), 2u);
  EXPECT_EQ(reader.counters().incompatible, 1u);
}

}  // namespace
}  // namespace fleetmap::sensor
