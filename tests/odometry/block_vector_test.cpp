#include "fleetmap/odometry/block_vector.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>

namespace fleetmap::odometry {
namespace {

BlockVector<std::uint64_t> counted(std::size_t size) {
  BlockVector<std::uint64_t> numbers;
  for (std::size_t i = 0; i < size; ++i) numbers.push_back(3 * i);
  return numbers;
}

TEST(BlockVector, HoldsWhatWasAddedInOrder) {
  const BlockVector<std::uint64_t> numbers = counted(5000);
  ASSERT_EQ(numbers.size(), 5000u);
  for (std::size_t i = 0; i < 5000; ++i) ASSERT_EQ(numbers[i], 3 * i);
  EXPECT_EQ(BlockVector<int>().size(), 0u);
  EXPECT_EQ(BlockVector<int>().bytes(), 0u);
}

TEST(BlockVector, ElementsStayWhereTheyAreWhileItGrows) {
  BlockVector<std::uint64_t> numbers = counted(10);
  std::uint64_t& seventh = numbers[7];
  std::uint64_t& last = numbers.push_back(99);
  for (std::uint64_t i = 0; i < 20'000; ++i) numbers.push_back(i);
  EXPECT_EQ(&numbers[7], &seventh);
  EXPECT_EQ(&numbers[10], &last);
  EXPECT_EQ(last, 99u);
  seventh = 5;
  EXPECT_EQ(numbers[7], 5u);
}

TEST(BlockVector, AnElementOfItsOwnCanBeAddedAgain) {
  BlockVector<std::uint64_t> numbers = counted(1);
  for (int k = 0; k < 12; ++k) {
    for (std::size_t i = 0, size = numbers.size(); i < size; ++i) numbers.push_back(numbers[i]);
    numbers.push_back(numbers[0] + 1);
  }
  EXPECT_EQ(numbers.size(), 8191u);
  EXPECT_EQ(numbers[8190], 1u);
  EXPECT_EQ(numbers[8189], 1u) << "the half before ends alike";
}

TEST(BlockVector, ShrinkingKeepsTheFirstAndGivesTheRestOfTheMemoryBack) {
  BlockVector<std::uint64_t> numbers = counted(100'000);
  EXPECT_GE(numbers.bytes(), 100'000 * sizeof(std::uint64_t));
  EXPECT_LT(numbers.bytes(), 103'000 * sizeof(std::uint64_t)) << "never twice what is held";
  numbers.shrink(1025);
  ASSERT_EQ(numbers.size(), 1025u);
  EXPECT_EQ(numbers[1024], 3 * 1024u);
  EXPECT_LT(numbers.bytes(), 4'000 * sizeof(std::uint64_t));
  numbers.push_back(42);
  EXPECT_EQ(numbers[1025], 42u);
  EXPECT_EQ(numbers.size(), 1026u);
  numbers.shrink(0);
  EXPECT_EQ(numbers.size(), 0u);
  EXPECT_EQ(numbers.bytes(), 0u);
  EXPECT_EQ(numbers.push_back(7), 7u);
}

}  // namespace
}  // namespace fleetmap::odometry
