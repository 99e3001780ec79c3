#include "monitor/foxglove/cdr_writer.hpp"

#include <gtest/gtest.h>

#include "monitor/foxglove/cdr_reader.hpp"

namespace fleetmap::monitor::foxglove {
namespace {

TEST(CdrWriter, aligns_numbers_from_the_end_of_the_header) {
  CdrWriter cdr;
  cdr.flag(true);
  cdr.number(std::uint16_t{0x0203});
  cdr.text("ab");
  cdr.number(std::uint64_t{5});
  const Bytes expected = {0, 1, 0, 0,               // CDR_LE
                          1, 0, 3, 2,               // flag, padding, number
                          3, 0, 0, 0, 'a', 'b', 0,  // text with its zero
                          0, 0, 0, 0, 0,            // padding to 16
                          5, 0, 0, 0, 0,   0,   0, 0};
  EXPECT_EQ(std::move(cdr).message(), expected);
}

TEST(CdrWriter, fast_cdr_reads_what_it_wrote) {
  enum class Kind { none, one, two };
  CdrWriter cdr;
  cdr.text("");
  cdr.number(-1.5);
  cdr.flag(true);
  cdr.number(2.5f);
  cdr.octets(Bytes{7, 8, 9});
  cdr.enumerator(Kind::two);
  cdr.flag(false);
  cdr.number(std::int32_t{-3});
  cdr.text("r1");
  cdr.count(2);
  cdr.number(1e300);
  testing::CdrReader read(std::move(cdr).message());
  EXPECT_EQ(read.text(), "");
  EXPECT_EQ(read.number<double>(), -1.5);
  EXPECT_TRUE(read.flag());
  EXPECT_EQ(read.number<float>(), 2.5f);
  EXPECT_EQ(read.octets(), (Bytes{7, 8, 9}));
  EXPECT_EQ(read.number<std::uint32_t>(), 2u);
  EXPECT_FALSE(read.flag());
  EXPECT_EQ(read.number<std::int32_t>(), -3);
  EXPECT_EQ(read.text(), "r1");
  EXPECT_EQ(read.count(), 2u);
  EXPECT_EQ(read.number<double>(), 1e300);
  EXPECT_TRUE(read.at_end());
}

}  // namespace
}  // namespace fleetmap::monitor::foxglove
