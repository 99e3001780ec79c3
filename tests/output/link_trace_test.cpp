#include "fleetmap/output/link_trace.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "fleetmap/output/line_file.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::output {
namespace {

LinkTraceRow heard(double time_s) {
  LinkTraceRow row{stamp_from_ns(static_cast<std::int64_t>(time_s * 10) * 100'000'000), "short_range",
                   *AgentId::parse("r2"), *AgentId::parse("r1")};
  row.loss_percent = 12.5;
  row.used_kbit_s = 138.1;
  row.messages = 7;
  return row;
}

TEST(LinkTrace, RowsComeBackAsTheyWereWritten) {
  const testing::TemporaryFolder folder;
  LinkTraceRow full = heard(1795909092.4);
  full.capacity_kbit_s = 5000.5;
  full.delay_ms = 1.6;
  const LinkTraceRow plain = heard(1795909093.0);
  EXPECT_EQ(to_line(full), "1795909092.4,short_range,r2,r1,5000.5,1.6,12.5,138.1,7");
  EXPECT_EQ(to_line(plain), "1795909093.0,short_range,r2,r1,,,12.5,138.1,7");
  folder.write("link_trace.csv",
               std::string(kLinkTraceHeader) + '\n' + to_line(full) + '\n' + to_line(plain) + '\n');
  const LinkTrace read = read_link_trace(folder.path() / kLinkTraceFile);
  EXPECT_EQ(read.damaged, 0u);
  ASSERT_EQ(read.rows.size(), 2u);
  EXPECT_EQ(to_line(read.rows[0]), to_line(full));
  EXPECT_EQ(to_line(read.rows[1]), to_line(plain));
  EXPECT_EQ(read.rows[0].time, full.time);
}

TEST(LinkTrace, LinesThatCannotBeReadAreCounted) {
  const testing::TemporaryFolder folder;
  std::string text = std::string(kLinkTraceHeader) + '\n' + to_line(heard(5.0)) + '\n';
  for (const char* damaged :
       {"17959", "nan,short_range,r2,r1,,,0.0,1.0,1", "5.0,short_range,no name,r1,,,0.0,1.0,1",
        "5.0,short_range,r2,r1,,,101.0,1.0,1", "5.0,short_range,r2,r1,,,0.0,-1.0,1",
        "5.0,short_range,r2,r1,,,0.0,1.0,1e300", "1e300,short_range,r2,r1,,,0.0,1.0,1"})
    text.append(damaged).append("\n");
  folder.write("link_trace.csv", text);
  const LinkTrace read = read_link_trace(folder.path() / kLinkTraceFile);
  EXPECT_EQ(read.rows.size(), 1u);
  EXPECT_EQ(read.damaged, 7u);
}

TEST(LinkTrace, ThePartBeforeComesFirstAndAFileThatIsNotThereHoldsNothing) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / kLinkTraceFile;
  EXPECT_TRUE(read_link_trace(file).rows.empty());
  const std::string header = std::string(kLinkTraceHeader) + '\n';
  folder.write("link_trace.csv", header + to_line(heard(9.0)) + '\n');
  std::ofstream(part_before(file)) << header << to_line(heard(5.0)) << '\n';
  const LinkTrace read = read_link_trace(file);
  ASSERT_EQ(read.rows.size(), 2u);
  EXPECT_LT(read.rows[0].time, read.rows[1].time);
}

}  // namespace
}  // namespace fleetmap::output
