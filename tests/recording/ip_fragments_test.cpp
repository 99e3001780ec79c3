#include "ip_fragments.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "pcap_bytes.hpp"

namespace fleetmap::recording {
namespace {

using namespace recording::testing;

constexpr std::size_t kEthernet = 14;

/// Fragments of a datagram of so many bytes, behind their Ethernet headers.
std::vector<Bytes> fragments_of(std::size_t size, std::uint32_t source = 7) {
  Bytes payload(size);
  for (std::size_t k = 0; k < size; ++k) payload[k] = static_cast<std::uint8_t>(k * 7 + source);
  std::vector<Bytes> parts;
  for (const std::string& frame : udp_fragments({.source = source}, payload))
    parts.emplace_back(frame.begin() + kEthernet, frame.end());
  return parts;
}

Bytes datagram_of(std::size_t size, std::uint32_t source = 7) {
  Bytes whole;
  for (const Bytes& part : fragments_of(size, source))
    whole.insert(whole.end(), part.begin() + 20, part.end());
  return whole;
}

TEST(IpFragments, AreJoinedInAnyOrderAndIfRepeated) {
  std::vector<Bytes> parts = fragments_of(24'896);
  ASSERT_EQ(parts.size(), 17u);
  std::mt19937 random(1);
  for (int round = 0; round < 20; ++round) {
    IpFragments fragments;
    std::ranges::shuffle(parts, random);
    fragments.add(parts[5]);
    std::optional<Bytes> whole;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      EXPECT_FALSE(whole) << "before the last came";
      whole = fragments.add(parts[k]);
    }
    ASSERT_TRUE(whole);
    EXPECT_EQ(*whole, datagram_of(24'896));
    EXPECT_EQ(fragments.incomplete(), 0u);
  }
}

TEST(IpFragments, OfSeveralSendersAreKeptApart) {
  IpFragments fragments;
  const auto first = fragments_of(4'000, 1), second = fragments_of(4'000, 2);
  for (std::size_t k = 0; k + 1 < first.size(); ++k) {
    EXPECT_FALSE(fragments.add(first[k]));
    EXPECT_FALSE(fragments.add(second[k]));
  }
  EXPECT_EQ(fragments.incomplete(), 2u);
  EXPECT_EQ(fragments.add(first.back()), datagram_of(4'000, 1));
  EXPECT_EQ(fragments.add(second.back()), datagram_of(4'000, 2));
}

TEST(IpFragments, TheOldestGivesWayToNewOnes) {
  IpFragments fragments;
  const auto first = fragments_of(4'000, 0);
  for (std::uint32_t source = 0; source < 40; ++source) fragments.add(fragments_of(4'000, source)[0]);
  EXPECT_EQ(fragments.incomplete(), 40u);
  EXPECT_FALSE(fragments.add(first[1]));
  EXPECT_FALSE(fragments.add(first[2])) << "its first part is forgotten";
}

TEST(IpFragments, HeadersThatContradictTheBytesAreIgnored) {
  IpFragments fragments;
  const Bytes part = fragments_of(4'000)[0];
  for (std::size_t size = 0; size < 20; ++size) EXPECT_FALSE(fragments.add(ByteView(part).first(size)));
  Bytes beyond = fragments_of(4'000)[2];
  beyond[6] = 0x1f;  // offset of nearly 64 KiB
  beyond[7] = 0xff;
  EXPECT_FALSE(fragments.add(beyond));
  EXPECT_EQ(fragments.incomplete(), 0u);
}

TEST(IpFragments, ThoseThatTheCaptureCutAreCounted) {
  IpFragments fragments;
  const Bytes part = fragments_of(4'000)[0];
  for (std::size_t size = 20; size < 40; ++size) EXPECT_FALSE(fragments.add(ByteView(part).first(size)));
  EXPECT_EQ(fragments.incomplete(), 20u);
}

TEST(IpFragments, ANumberThatRecursJoinsNoFragmentsOfTwoPackets) {
  IpFragments fragments;
  const auto lost = fragments_of(4'000, 1), between = fragments_of(4'000, 2);
  for (std::size_t k = 1; k < lost.size(); ++k) fragments.add(lost[k]);  // the first never comes
  for (int k = 0; k < 2'000; ++k) {
    for (const Bytes& part : between) fragments.add(part);
  }
  EXPECT_EQ(fragments.incomplete(), 1u);
  EXPECT_FALSE(fragments.add(lost[0])) << "of the next packet with this number";
  for (std::size_t k = 1; k + 1 < lost.size(); ++k) EXPECT_FALSE(fragments.add(lost[k]));
  EXPECT_EQ(fragments.add(lost.back()), datagram_of(4'000, 1));
}

TEST(IpFragments, RepeatedForEverTheyAreGivenUp) {
  IpFragments fragments;
  for (int k = 0; k < 1'000; ++k) EXPECT_FALSE(fragments.add(fragments_of(4'000)[0]));
  EXPECT_EQ(fragments.incomplete(), 4u);
}

}  // namespace
}  // namespace fleetmap::recording
