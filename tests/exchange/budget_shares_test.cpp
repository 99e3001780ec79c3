#include "budget_shares.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "exchange/robots.hpp"
#include "exchange/sim_fleet.hpp"

namespace fleetmap::exchange {
namespace {

using testing::agent;

constexpr double kBudget = 18'000.0;  // B/s
constexpr Duration kPeriod = std::chrono::seconds(5);

/// Robots that tell each other their status, which may get lost and be late. Only backlogs are made up.
class Fleet {
 public:
  Fleet(std::size_t robots, std::uint32_t seed, double loss) : random_(seed), loss_(loss) {
    for (std::size_t k = 1; k <= robots; ++k) names_.push_back(agent("r" + std::to_string(k)));
    for (const AgentId& name : names_)
      robots_.emplace(name, Robot{BudgetShares(name, names_, kBudget, kPeriod, now_), 0, {}, true});
    for (auto& [name, robot] : robots_) robot.next = now_ + std::chrono::milliseconds(random_() % 5000);
  }

  void run_for(Duration time, const std::function<void()>& each = {}) {
    for (const Stamp end = now_ + time; now_ < end; now_ += std::chrono::milliseconds(100)) {
      for (auto& [name, robot] : robots_) {
        if (!robot.there || now_ < robot.next) continue;
        robot.next = now_ + kPeriod;
        AgentStatus status;
        status.from = name;
        status.backlog_bytes = static_cast<std::uint32_t>(robot.backlog);
        status.loans = robot.shares.lend(robot.backlog, robot.sent, now_);
        for (const AgentId& to : names_) {
          if (to == name || chance(loss_)) continue;
          flights_.emplace(now_ + std::chrono::milliseconds(random_() % 4000), std::pair(to, status));
        }
      }
      while (!flights_.empty() && flights_.begin()->first <= now_) {
        const auto& [to, status] = flights_.begin()->second;
        Robot& robot = robots_.at(to);
        if (robot.there) {
          robot.shares.on_heard(status.from, now_);
          robot.shares.on_status(status, now_);
        }
        flights_.erase(flights_.begin());
      }
      if (each) each();
    }
  }
  double rate(const std::string& name) const { return robots_.at(agent(name)).shares.rate(now_); }
  /// Sum over all robots that are there.
  double sum() const {
    double sum = 0.0;
    for (const auto& [name, robot] : robots_) sum += robot.there ? robot.shares.rate(now_) : 0.0;
    return sum;
  }
  void set_backlog(const std::string& name, std::size_t bytes, std::size_t sent = 0) {
    robots_.at(agent(name)).backlog = bytes;
    robots_.at(agent(name)).sent = sent;
  }
  void set_there(const std::string& name, bool there) { robots_.at(agent(name)).there = there; }
  bool chance(double p) { return std::uniform_real_distribution<double>()(random_) < p; }
  std::mt19937& random() { return random_; }

 private:
  struct Robot {
    BudgetShares shares;
    std::size_t backlog = 0;
    Stamp next;
    bool there = true;
    std::size_t sent = 0;
  };
  std::mt19937 random_;
  double loss_;
  Stamp now_ = kStart;
  std::vector<AgentId> names_;
  std::map<AgentId, Robot> robots_;
  std::multimap<Stamp, std::pair<AgentId, AgentStatus>> flights_;
};

TEST(BudgetShares, the_sum_never_exceeds_the_budget_whatever_is_lost_and_whoever_has_need) {
  double max_rate = 0.0;
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    const std::size_t robots = 2 + seed % 9;
    Fleet fleet(robots, seed, 0.05 * (seed % 10));
    for (int k = 0; k < 60; ++k) {
      const std::string name = "r" + std::to_string(1 + fleet.random()() % robots);
      const bool needs = fleet.chance(0.5);
      fleet.set_backlog(name, needs ? 60'000 : 0, needs ? 9'000 : fleet.random()() % 4'000);
      fleet.run_for(std::chrono::milliseconds(fleet.random()() % 20'000),
                    [&] { ASSERT_LE(fleet.sum(), kBudget * 1.000001) << "seed " << seed; });
      max_rate = std::max(max_rate, fleet.rate(name));
    }
  }
  EXPECT_GT(max_rate, 0.5 * kBudget) << "something was lent";
}

TEST(BudgetShares, unused_shares_go_to_robots_in_need_and_return) {
  Fleet fleet(5, 1, 0.1);
  fleet.set_backlog("r1", 80'000);
  fleet.run_for(std::chrono::seconds(30));
  EXPECT_GT(fleet.rate("r1"), 0.6 * kBudget);
  EXPECT_GE(fleet.rate("r2"), 0.39 * kBudget / 5.0) << "a lender keeps what one cloud in half a minute needs";
  fleet.set_backlog("r2", 80'000);
  fleet.run_for(std::chrono::seconds(40));
  EXPECT_NEAR(fleet.rate("r1"), fleet.rate("r2"), 0.1 * kBudget) << "equal need";
  EXPECT_GT(fleet.rate("r1"), 0.3 * kBudget);
  fleet.set_backlog("r1", 0);
  fleet.set_backlog("r2", 0);
  fleet.run_for(std::chrono::seconds(40));
  for (const char* name : {"r1", "r2", "r3"}) EXPECT_DOUBLE_EQ(fleet.rate(name), kBudget / 5.0) << name;
}

TEST(BudgetShares, a_lender_keeps_what_it_uses) {
  Fleet fleet(2, 3, 0.0);
  fleet.set_backlog("r1", 80'000);
  fleet.set_backlog("r2", 0, 30'000);  // 6 kB/s of its 9
  fleet.run_for(std::chrono::seconds(30));
  EXPECT_DOUBLE_EQ(fleet.rate("r1"), kBudget / 2.0) << "half as much again as it used is all it has";
}

TEST(BudgetShares, the_part_of_a_robot_that_is_gone_goes_to_the_others_until_it_is_heard_again) {
  Fleet fleet(3, 5, 0.1);
  fleet.run_for(std::chrono::seconds(10));
  fleet.set_there("r3", false);
  fleet.run_for(std::chrono::seconds(30));
  EXPECT_DOUBLE_EQ(fleet.rate("r1"), kBudget / 3.0) << "it may only be quiet";
  fleet.run_for(std::chrono::seconds(40));
  EXPECT_DOUBLE_EQ(fleet.rate("r1"), kBudget / 2.0);
  fleet.set_there("r3", true);
  fleet.run_for(std::chrono::seconds(15));
  EXPECT_DOUBLE_EQ(fleet.rate("r1"), kBudget / 3.0);
  EXPECT_DOUBLE_EQ(fleet.rate("r2"), kBudget / 3.0);
}

TEST(BudgetShares, a_robot_that_returns_makes_room_for_all_that_may_return_with_it) {
  std::vector<AgentId> names;
  for (int k = 1; k <= 10; ++k) names.push_back(agent("r" + std::to_string(k)));
  BudgetShares shares(names[0], names, kBudget, kPeriod, kStart);
  Stamp now = kStart;
  const auto run_for = [&](Duration time, const std::vector<std::size_t>& heard) {
    for (const Stamp end = now + time; now < end; now += std::chrono::seconds(1))
      for (const std::size_t peer : heard) shares.on_heard(names[peer], now);
  };
  run_for(std::chrono::seconds(70), {1});
  EXPECT_DOUBLE_EQ(shares.rate(now), kBudget / 2.0);
  shares.on_heard(names[7], now);
  EXPECT_DOUBLE_EQ(shares.rate(now), kBudget / 10.0) << "the other eight may be as near as this one";
  run_for(3 * kPeriod, {1, 7});
  EXPECT_DOUBLE_EQ(shares.rate(now), kBudget / 3.0) << "none of them was heard";
}

TEST(BudgetShares, loans_of_strangers_to_others_and_beyond_the_budget_are_worth_nothing) {
  const std::vector<AgentId> names = {agent("r1"), agent("r2"), agent("r3")};
  BudgetShares shares(names[0], names, kBudget, kPeriod, kStart);
  AgentStatus status;
  status.from = agent("x");
  status.loans = {{names[0], 60'000}};
  shares.on_status(status, kStart);
  status.from = names[1];
  status.loans = {{names[2], 5'000}};
  shares.on_status(status, kStart);
  EXPECT_DOUBLE_EQ(shares.rate(kStart), kBudget / 3.0);
  status.loans = {{names[0], 60'000}};
  shares.on_status(status, kStart);
  EXPECT_LE(shares.rate(kStart), kBudget);
  status.loans.clear();
  shares.on_status(status, kStart);
  EXPECT_DOUBLE_EQ(shares.rate(kStart), kBudget / 3.0) << "a loan that is not named ends";
}

}  // namespace
}  // namespace fleetmap::exchange
