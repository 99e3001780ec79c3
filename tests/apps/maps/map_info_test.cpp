// Scripts compare robots by what `fleetmap map info --json` prints of their stores.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "fleetmap/store/store.hpp"
#include "store/items.hpp"
#include "support/command_line.hpp"
#include "support/process.hpp"

namespace fleetmap {
namespace {

using testing::agent;

/// The items of two robots: three nodes with submaps each, and two alignments.
struct Items {
  std::vector<std::pair<graph::Node, Bytes>> nodes;
  std::vector<graph::Alignment> alignments;

  Items() {
    for (const char* name : {"r1", "r2"}) {
      for (std::uint32_t seq = 0; seq < 3; ++seq) {
        Bytes submap = testing::random_bytes(20'000 + 1000 * seq, seq + static_cast<std::uint32_t>(name[1]));
        const graph::Node node = testing::make_node(agent(name), seq, submap, 5.0 * seq);
        nodes.emplace_back(node, std::move(submap));
      }
    }
    for (std::uint32_t seq = 0; seq < 2; ++seq)
      alignments.push_back(testing::make_alignment({agent("r1"), seq}, {agent("r2"), seq}, agent("r2"), seq));
  }
};

class MapInfo : public testing::CommandLineTest {
 protected:
  /// Writes the store of a robot that received the items in this order, without the submap of the last one if
  /// `lacks_a_submap`.
  std::string write_store(const std::string& robot, bool backwards, std::size_t alignments,
                          bool lacks_a_submap) {
    const std::filesystem::path file = folder_ / (robot + std::to_string(++stores_) + ".db");
    store::Store store = store::Store::open(file, agent(robot)).value();
    std::vector<std::pair<graph::Node, Bytes>> nodes = items_.nodes;
    if (backwards) std::ranges::reverse(nodes);
    for (const auto& [node, submap] : nodes) {
      const bool lacks = lacks_a_submap && node.id == items_.nodes.back().first.id;
      EXPECT_TRUE(lacks ? store.put_node(node) : store.put_node_with_submap(node, submap));
    }
    for (std::size_t k = 0; k < alignments; ++k) EXPECT_TRUE(store.put_alignment(items_.alignments[k]));
    return file.string();
  }
  nlohmann::json info(const std::string& file) {
    run({"map", "info", "--json", file});
    EXPECT_EQ(exit_code_, 0) << output_;
    return nlohmann::json::parse(output_, nullptr, false);
  }

  Items items_;
  int stores_ = 0;
};

TEST_F(MapInfo, RobotsThatHoldTheSameHaveTheSameHashHoweverItCame) {
  const nlohmann::json first = info(write_store("r1", false, 2, false));
  const nlohmann::json second = info(write_store("r2", true, 2, false));
  EXPECT_EQ(first.at("store_of"), "r1");
  EXPECT_EQ(second.at("store_of"), "r2");
  EXPECT_EQ(first.at("hash"), second.at("hash"));
  EXPECT_EQ(first.at("robots"), second.at("robots"));
  EXPECT_EQ(first.at("nodes"), 6);
  EXPECT_EQ(first.at("submaps"), 6);
  EXPECT_EQ(first.at("alignments"), 2);
  EXPECT_EQ(first.at("submap_bytes"), 2 * (20'000 + 21'000 + 22'000));
  EXPECT_EQ(first.at("robots").at("r1").at("nodes"), 3);
  EXPECT_EQ(first.at("robots").at("r1").at("alignments"), 0) << "r2 computed them";
  EXPECT_EQ(first.at("robots").at("r2").at("alignments"), 2);
  EXPECT_EQ(first.at("robots").at("r1").at("sessions"), 1);
}

TEST_F(MapInfo, MissingItemsChangeTheHash) {
  const nlohmann::json whole = info(write_store("r1", false, 2, false));
  const nlohmann::json without_submap = info(write_store("r1", false, 2, true));
  const nlohmann::json without_alignment = info(write_store("r1", false, 1, false));
  EXPECT_NE(whole.at("hash"), without_submap.at("hash"));
  EXPECT_NE(whole.at("hash"), without_alignment.at("hash"));
  EXPECT_EQ(without_submap.at("nodes"), 6);
  EXPECT_EQ(without_submap.at("submaps"), 5);
  EXPECT_EQ(without_submap.at("robots").at("r2").at("submaps"), 2);
  EXPECT_EQ(without_alignment.at("alignments"), 1);
}

TEST_F(MapInfo, NodesWithoutSubmapAreNamedByTheirRobot) {
  const std::string file = write_store("r1", false, 2, true);
  run({"map", "info", file});
  EXPECT_EQ(exit_code_, 0) << output_;
  EXPECT_NE(output_.find("1 of 6 nodes have no submap in this store (r2: 1 of 3)"), std::string::npos)
      << output_;
}

TEST_F(MapInfo, CountsWhatIsHeld) {
  run({"map", "info", write_store("r1", false, 2, true)});
  EXPECT_EQ(exit_code_, 0) << output_;
  EXPECT_NE(output_.find("store of r1\nnodes 6, submaps held 5, alignments 2 ("), std::string::npos)
      << output_;
  EXPECT_NE(output_.find("\norigin "), std::string::npos) << output_;
}

TEST_F(MapInfo, NamesTheRobotThatContradictsTheFleet) {
  for (int seed = 1; seed < 40; ++seed) {
    const std::string stores = (folder_ / std::to_string(seed)).string();
    run({"fuzz-fleet", "--replay", std::to_string(seed), "--robots", "4", "--faults", "compromised",
         "--mapping", "80", "--stores", stores});
    const std::string trace = output_;
    const std::string deceives = " deceives by scheme garbage";
    const std::size_t at = trace.find(deceives);
    if (at == std::string::npos) continue;
    const std::string robot = trace.substr(at - 2, 2);
    run({"map", "info", stores + (robot == "r1" ? "/r2.db" : "/r1.db")});
    EXPECT_NE(output_.find(robot + " contradicts the fleet: "), std::string::npos) << output_;
    EXPECT_NE(output_.find("\naligned together: r"), std::string::npos) << output_;
    EXPECT_NE(output_.find("--without " + robot), std::string::npos) << output_;
    return;
  }
  FAIL() << "a quarter of the seeds should send garbage";
}

}  // namespace
}  // namespace fleetmap
