#include "recording/pcap_file.hpp"

#include <gmock/gmock.h>

#include <vector>

#include "pcap_bytes.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::recording {
namespace {

using fleetmap::testing::TemporaryFolder;
using ::testing::HasSubstr;
using namespace recording::testing;

constexpr Stamp kNow = stamp_from_ns(1'700'000'000'123'456'000);
const Bytes kPayload{1, 2, 3, 4, 5};

struct Read {
  std::vector<Bytes> payloads;
  std::vector<Stamp> times;
  std::string error;
};

Read read(PcapFile& file) {
  Read read;
  while (true) {
    const auto datagram = file.next();
    if (!datagram) read.error = datagram.error().message;
    if (!datagram || !*datagram) return read;
    read.payloads.emplace_back((*datagram)->payload.begin(), (*datagram)->payload.end());
    read.times.push_back((*datagram)->captured);
  }
}

Result<PcapFile> open_bytes(const TemporaryFolder& folder, const std::string& bytes) {
  folder.write("a.pcap", bytes);
  return PcapFile::open(folder.path() / "a.pcap");
}

TEST(PcapFile, IsReadInEitherByteOrderAndUnitOfTime) {
  const TemporaryFolder folder;
  for (const bool big_endian : {false, true}) {
    for (const bool nanoseconds : {false, true}) {
      const PcapFormat format{big_endian, nanoseconds};
      auto file =
          open_bytes(folder, pcap_header(format) + pcap_record(kNow, udp_frame({}, kPayload), format) +
                                 pcap_record(kNow + Duration(789), udp_frame({}, {}), format));
      ASSERT_TRUE(file) << file.error().message;
      const auto first = file->next();
      ASSERT_TRUE(first && *first);
      EXPECT_EQ((*first)->captured, kNow);
      EXPECT_EQ((*first)->source, 0xc0a801c9u);
      EXPECT_EQ((*first)->port, 2368);
      EXPECT_TRUE(std::ranges::equal((*first)->payload, kPayload));
      const auto second = file->next();
      ASSERT_TRUE(second && *second);
      EXPECT_EQ((*second)->captured, kNow + Duration(nanoseconds ? 789 : 0));
      EXPECT_TRUE((*second)->payload.empty());
      const auto end = file->next();
      EXPECT_TRUE(end && !*end);
      EXPECT_FALSE(file->ended_within_record());
    }
  }
}

TEST(PcapFile, TagsOptionsAndPaddingAreNoPartOfThePayload) {
  const TemporaryFolder folder;
  const std::string tag = number(0x8100, 2, true) + number(7, 2, true);
  const std::string outer = number(0x88a8, 2, true) + number(9, 2, true);
  std::string bytes = pcap_header();
  for (const UdpFrame& frame :
       {UdpFrame{.tags = tag}, UdpFrame{.tags = outer + tag}, UdpFrame{.ip_options = std::string(8, '\x01')}})
    bytes += pcap_record(kNow, udp_frame(frame, kPayload) + std::string(13, '\0'));
  auto file = open_bytes(folder, bytes);
  ASSERT_TRUE(file);
  EXPECT_THAT(read(*file).payloads, ::testing::ElementsAre(kPayload, kPayload, kPayload));
}

TEST(PcapFile, OtherTrafficIsPassedOver) {
  const TemporaryFolder folder;
  std::string bytes = pcap_header();
  bytes +=
      pcap_record(kNow, std::string(12, '\x11') + number(0x0806, 2, true) + std::string(28, '\0'));  // ARP
  bytes += pcap_record(kNow, udp_frame({.protocol = 6}, kPayload));                                  // TCP
  bytes += pcap_record(kNow, udp_frame({.fragment = 0x2000}, kPayload));  // the first fragment
  bytes += pcap_record(kNow, udp_frame({.fragment = 0x0010}, kPayload));  // a later one
  bytes += pcap_record(kNow, udp_frame({.fragment = 0x4000}, kPayload));  // "do not fragment"
  bytes += pcap_record(kNow, std::string(3, 'x'));
  auto file = open_bytes(folder, bytes);
  ASSERT_TRUE(file);
  EXPECT_EQ(read(*file).payloads.size(), 1u);
  EXPECT_EQ(file->frames(), 6u);
  EXPECT_EQ(file->cut_datagrams(), 1u) << "of which fragments are missing";
}

/// As a LiDAR's packet of more than 1500 bytes is sent, here the last part first.
TEST(PcapFile, FragmentsArePutTogether) {
  const TemporaryFolder folder;
  Bytes payload(4'000);
  for (std::size_t k = 0; k < payload.size(); ++k) payload[k] = static_cast<std::uint8_t>(k % 251);
  const std::vector<std::string> frames = udp_fragments({}, payload);
  ASSERT_EQ(frames.size(), 3u);
  std::string bytes = pcap_header();
  for (const std::size_t k : {2u, 0u, 1u}) bytes += pcap_record(kNow, frames[k]);
  auto file = open_bytes(folder, bytes);
  ASSERT_TRUE(file);
  const auto datagram = file->next();
  ASSERT_TRUE(datagram && *datagram);
  EXPECT_EQ((*datagram)->port, 2368);
  EXPECT_EQ(Bytes((*datagram)->payload.begin(), (*datagram)->payload.end()), payload);
  EXPECT_EQ(file->cut_datagrams(), 0u);
}

TEST(PcapFile, DatagramsThatWereCapturedInPartAreCounted) {
  const TemporaryFolder folder;
  const std::string frame = udp_frame({}, kPayload);
  std::string bytes = pcap_header();
  for (std::size_t size = 0; size <= frame.size(); ++size) bytes += pcap_record(kNow, frame.substr(0, size));
  auto file = open_bytes(folder, bytes);
  ASSERT_TRUE(file);
  EXPECT_EQ(read(*file).payloads.size(), 1u);
  // From where the IPv4 header is whole.
  EXPECT_EQ(file->cut_datagrams(), frame.size() - 14 - 20);
}

TEST(PcapFile, ThatWasCutIsReadAsFarAsItGoes) {
  const TemporaryFolder folder;
  const std::string header = pcap_header(), record = pcap_record(kNow, udp_frame({}, kPayload));
  const std::string whole = header + record + record;
  for (std::size_t size = header.size(); size <= whole.size(); ++size) {
    auto file = open_bytes(folder, whole.substr(0, size));
    ASSERT_TRUE(file) << size;
    const Read got = read(*file);
    EXPECT_EQ(got.error, "");
    EXPECT_EQ(got.payloads.size(), (size - header.size()) / record.size());
    EXPECT_EQ(file->ended_within_record(), (size - header.size()) % record.size() != 0) << size;
  }
}

TEST(PcapFile, OthersAreRefusedWithTheRemedy) {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::string& bytes) {
    auto file = open_bytes(folder, bytes);
    return file ? "opened" : file.error().message;
  };
  EXPECT_THAT(refusal(""), HasSubstr("too short for a capture"));
  EXPECT_THAT(refusal(std::string(24, 'x')), HasSubstr("a.pcap: this is no pcap file"));
  EXPECT_THAT(refusal("\x0a\x0d\x0d\x0a" + std::string(24, '\0')), HasSubstr("editcap -F pcap"));
  EXPECT_THAT(refusal(pcap_header({}, 113)), HasSubstr("link type 113"));
  EXPECT_THAT(PcapFile::open(folder.path() / "none.pcap").error().message, HasSubstr("cannot be read"));
}

TEST(PcapFile, AnAbsurdLengthIsAnErrorAndTheEnd) {
  const TemporaryFolder folder;
  const std::string good = pcap_record(kNow, udp_frame({}, kPayload));
  auto file = open_bytes(folder, pcap_header() + good + std::string(8, '\0') + std::string(8, '\xff') + good);
  ASSERT_TRUE(file);
  const Read got = read(*file);
  EXPECT_EQ(got.payloads.size(), 1u);
  EXPECT_THAT(got.error, HasSubstr("is damaged at byte " + std::to_string(24 + good.size())));
  const auto after = file->next();
  EXPECT_TRUE(after && !*after);
}

}  // namespace
}  // namespace fleetmap::recording
