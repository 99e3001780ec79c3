#include "robot/link_log.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <iterator>

#include "support/robots.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::apps {
namespace {

using fleetmap::testing::kPeer;
using fleetmap::testing::kSelf;
using ::testing::ElementsAre;
using namespace std::chrono_literals;

constexpr Stamp kOpened{1000s};

std::vector<std::string> lines_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

class LinkLogTest : public ::testing::Test {
 protected:
  /// Without the line of the columns.
  std::vector<std::string> rows() const {
    auto lines = lines_of(folder_.path() / "link_trace.csv");
    lines.erase(lines.begin());
    return lines;
  }
  static bus::HeardTraffic traffic(bus::Link link, std::uint64_t messages, std::uint64_t bytes,
                                   std::uint64_t lost = 0) {
    return {link, kPeer, messages, 0, bytes, lost, messages, 20ms};
  }

  testing::TemporaryFolder folder_;
  LinkLog log_ = LinkLog::open(folder_.path(), kSelf).value();
};

TEST_F(LinkLogTest, ARowIsOfOneSecondAndOneRobot) {
  log_.add_traffic({traffic(bus::Link::kLongRange, 5, 1000)}, {}, kOpened);  // since when is not known
  log_.add_traffic({traffic(bus::Link::kLongRange, 5, 1250)}, {}, kOpened + 1s);
  log_.add_traffic({traffic(bus::Link::kLongRange, 9, 2500, 1)}, {}, kOpened + 3s);
  EXPECT_THAT(rows(), ElementsAre("1000.0,long_range,r2,r1,,20.0,0.0,10.0,5",
                                  "1001.0,long_range,r2,r1,,20.0,10.0,10.0,9"));
}

TEST_F(LinkLogTest, ADelayIsOfMessagesThatCarryATime) {
  bus::HeardTraffic untimed = traffic(bus::Link::kLongRange, 5, 1250);
  untimed.timed = 0;
  untimed.delay = Duration::zero();
  log_.add_traffic({}, {}, kOpened);
  log_.add_traffic({untimed}, {}, kOpened + 1s);
  EXPECT_THAT(rows(), ElementsAre("1000.0,long_range,r2,r1,,,0.0,10.0,5"));
}

TEST_F(LinkLogTest, CapacityOfTheLinkIsKnownWhileSubmapsFillIt) {
  log_.add_traffic({}, {}, kOpened);
  log_.add_traffic({traffic(bus::Link::kShortRange, 100, 500'000)}, {kPeer},
                   kOpened + 1s);  // begun within it
  log_.add_traffic({traffic(bus::Link::kShortRange, 200, 1'000'000)}, {kPeer}, kOpened + 2s);
  EXPECT_THAT(rows(), ElementsAre("1000.0,short_range,r2,r1,,20.0,0.0,4000.0,100",
                                  "1001.0,short_range,r2,r1,8000.0,20.0,0.0,8000.0,200"));
}

TEST_F(LinkLogTest, ARobotThatFallsSilentIsSaidToBeOutOfReachOnce) {
  log_.add_traffic({}, {}, kOpened);
  log_.add_traffic({traffic(bus::Link::kShortRange, 1, 125)}, {}, kOpened + 1s);
  for (int k = 2; k < 20; ++k) log_.add_traffic({}, {}, kOpened + k * 1s);
  // The loss meanwhile is not counted again.
  log_.add_traffic({traffic(bus::Link::kShortRange, 1, 125, 60)}, {}, kOpened + 20s);
  EXPECT_THAT(rows(), ElementsAre("1000.0,short_range,r2,r1,,20.0,0.0,1.0,1",
                                  "1001.0,short_range,r2,r1,,,100.0,0.0,0",
                                  "1019.0,short_range,r2,r1,,20.0,0.0,1.0,1"));
}

TEST_F(LinkLogTest, ARobotThatSaysHelloIsThere) {
  log_.add_traffic({}, {}, kOpened);
  log_.add_traffic({traffic(bus::Link::kLongRange, 1, 125)}, {}, kOpened + 1s);
  bus::HeardTraffic hello = traffic(bus::Link::kLongRange, 0, 0);
  hello.hellos = 1;
  for (int k = 1; k < 10; ++k) log_.add_traffic({hello}, {}, kOpened + k * 20s);
  EXPECT_EQ(rows().size(), 1u);
  log_.add_traffic({}, {}, kOpened + 246s);
  EXPECT_THAT(rows(), ElementsAre(::testing::_, "1180.0,long_range,r2,r1,,,100.0,0.0,0"));
}

TEST_F(LinkLogTest, KeepsWhenARobotWasLastHeardOnEachLink) {
  log_.add_traffic({}, {}, kOpened);
  log_.add_traffic({traffic(bus::Link::kShortRange, 1, 125), traffic(bus::Link::kLongRange, 1, 125)}, {},
                   kOpened + 1s);
  log_.add_traffic({traffic(bus::Link::kLongRange, 1, 125)}, {}, kOpened + 9s);
  const auto& heard = log_.last_heard();
  ASSERT_EQ(heard.size(), 2u);
  const LinkLog::Heard near = heard.at({bus::Link::kShortRange, kPeer});
  EXPECT_EQ(near.at, kOpened + 1s);
  EXPECT_TRUE(near.silent);
  EXPECT_EQ(heard.at({bus::Link::kLongRange, kPeer}).at, kOpened + 9s);
  EXPECT_FALSE(heard.at({bus::Link::kLongRange, kPeer}).silent);
}

TEST_F(LinkLogTest, ALineThatWasCutOffIsEnded) {
  const auto file = folder_.path() / "link_trace.csv";
  std::ofstream(file, std::ios::app) << "1005.0,long_ra";
  LinkLog later = LinkLog::open(folder_.path(), kSelf).value();
  later.add_traffic({}, {}, kOpened);
  later.add_traffic({traffic(bus::Link::kLongRange, 5, 1250)}, {}, kOpened + 1s);
  EXPECT_THAT(rows(), ElementsAre("1005.0,long_ra", "1000.0,long_range,r2,r1,,20.0,0.0,10.0,5"));
}

TEST_F(LinkLogTest, EachNodeIsWrittenOnceAndALaterStartGoesOn) {
  const NodeId first{kSelf, 0}, second{kPeer, 3};
  store::SeqSet nodes;
  nodes.insert(first.agent, first.seq);
  log_.add_nodes(nodes, kOpened);
  nodes.insert(second.agent, second.seq);
  log_.add_nodes(nodes, kOpened + 1s);
  log_.add_nodes(nodes, kOpened + 2s);
  const auto file = folder_.path() / "node_times.csv";
  EXPECT_THAT(lines_of(file), ElementsAre("time_ns,node", "1000000000000," + to_string(first),
                                          "1001000000000," + to_string(second)));
  ASSERT_TRUE(LinkLog::open(folder_.path(), kSelf));
  EXPECT_EQ(lines_of(file).size(), 3u);
}

TEST(LinkLogFile, AFolderThatIsNotThereIsNamed) {
  const auto log = LinkLog::open("/no/such/folder", kSelf);
  ASSERT_FALSE(log);
  EXPECT_THAT(log.error().message, ::testing::HasSubstr("/no/such/folder/link_trace.csv"));
}

}  // namespace
}  // namespace fleetmap::apps
