// Items that a robot has acknowledged to another one are still in its store after a power cut.
#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

#include "exchange/robots.hpp"
#include "exchange/sim_fleet.hpp"
#include "store/power_cut_disk.hpp"

namespace fleetmap::exchange {
namespace {

using messages::Digest;
using messages::Hold;
using messages::SubmapDigest;
using testing::agent;
using testing::PowerCutDisk;
using testing::SimFleet;

constexpr int kFleets = 30, kCutsOfAFleet = 10;

void insert_all(store::SeqSet& set, const std::vector<SeqRange>& ranges) {
  for (const SeqRange& range : ranges) set.insert(range);
}

/// The items that one robot's messages acknowledge.
struct Acknowledged {
  store::SeqSet nodes, alignments, submaps;
  std::optional<Stamp> order;

  void add(const Message& message) {
    if (const auto* digest = std::get_if<Digest>(&message)) {
      insert_all(nodes, digest->nodes);
      insert_all(alignments, digest->alignments);
    } else if (const auto* submap_digest = std::get_if<SubmapDigest>(&message)) {
      insert_all(submaps, submap_digest->submaps);
    } else if (const auto* node = std::get_if<graph::Node>(&message); node && node->id.agent == kSelf) {
      nodes.insert(kSelf, node->id.seq);
      submaps.insert(kSelf, node->id.seq);
    } else if (const auto* hold = std::get_if<Hold>(&message)) {
      for (const HoldOrder& one : hold->orders) order = std::max(order.value_or(one.stamp), one.stamp);
    }
  }
};

/// Two robots beside each other, of which `r1` loses its power now and then.
class PoweredFleet {
 public:
  explicit PoweredFleet(std::uint32_t seed)
      : random_(seed), disk_(seed), fleet_({"r1", "r2"}, {}, seed, [](ExchangeConfig& config) {
          config.reconcile.digest_min_period = std::chrono::seconds(1);
        }) {
    fleet_.reachable = [](const AgentId&, const AgentId&, Reach) { return true; };
    fleet_.register_clouds = false;
    fleet_.put_on_disk("r1", disk_.name());
    fleet_.start("r2");
    fleet_.start("r1", session_);
  }
  // The store uses the disk until it is closed.
  ~PoweredFleet() { fleet_.kill("r1"); }
  PoweredFleet(const PoweredFleet&) = delete;
  PoweredFleet& operator=(const PoweredFleet&) = delete;

  void run_until_cut() {
    disk_.cut_after(1 + random_() % 400);
    for (int step = 0; !disk_.is_cut(); ++step) {
      if (step % 40 == 0) map();
      fleet_.forget_sent();
      fleet_.step();
      // All writes of a step come before what it sends.
      if (disk_.is_cut()) break;
      for (const SimFleet::Sent& sent : fleet_.sent()) {
        if (sent.from == kSelf) acknowledged_.add(sent.outgoing.message);
      }
    }
  }

  void come_back() {
    fleet_.kill("r1");
    disk_.restore_power();
    fleet_.start("r1", ++session_);
  }

  void expect_all_acknowledged() {
    auto& robot = fleet_.robot("r1");
    const store::Store& store = *robot.store;
    EXPECT_TRUE(acknowledged_.nodes.minus(store.node_set()).empty());
    EXPECT_TRUE(acknowledged_.alignments.minus(store.alignment_set()).empty());
    EXPECT_TRUE(acknowledged_.submaps.minus(store.submap_set()).empty());
    const auto order = robot.exchange->hold_in_force();
    EXPECT_GE(order ? order->stamp : Stamp{}, acknowledged_.order.value_or(Stamp{}));
    EXPECT_TRUE(store.damage().empty());
  }

 private:
  void map() {
    const auto theirs = fleet_.add_node("r2", 3.0 * ++made_, 20'000);
    fleet_.add_alignment("r2", {.ours = theirs.id, .theirs = {kSelf, 0}}, 0.2);
    if (made_ % 3 == 0)
      fleet_.forge("r1", Hold{agent("operator"),
                              Hold::Driving::kNoRobot,
                              {{fleet_.now(), {}, agent("operator"), HoldOrder::Kind::kHold}}});
    try {
      if (made_ % 2 == 0) fleet_.add_node("r1", 3.0 * made_, 20'000);
    } catch (const std::runtime_error&) {
      EXPECT_TRUE(disk_.is_cut()) << "its own node is refused";
    }
  }

  std::mt19937 random_;
  PowerCutDisk disk_;
  SimFleet fleet_;
  Acknowledged acknowledged_;
  std::uint16_t session_ = 0;
  int made_ = 0;
};

TEST(PowerCut, NothingThatAnotherRobotWasToldIsMissing) {
  for (std::uint32_t seed = 0; seed < kFleets && !HasFailure(); ++seed) {
    PoweredFleet fleet(seed);
    for (int cut = 0; cut < kCutsOfAFleet && !HasFailure(); ++cut) {
      SCOPED_TRACE("fleet " + std::to_string(seed) + ", cut " + std::to_string(cut));
      fleet.run_until_cut();
      fleet.come_back();
      fleet.expect_all_acknowledged();
    }
  }
}

}  // namespace
}  // namespace fleetmap::exchange
