#include "registration_jobs.hpp"

#include <gtest/gtest.h>

namespace fleetmap::fault_injection {
namespace {

RegistrationJob job(const std::string& robot, int due_ns, std::uint16_t session) {
  return {stamp_from_ns(due_ns), AgentId::parse(robot).value(), session, {}};
}

std::vector<std::uint16_t> sessions(const std::vector<RegistrationJob>& jobs) {
  std::vector<std::uint16_t> all;
  for (const RegistrationJob& each : jobs) all.push_back(each.session);
  return all;
}

TEST(RegistrationJobs, EndWhenTheyAreDueInTheOrderInWhichTheyBegan) {
  RegistrationJobs jobs;
  jobs.add(job("r1", 30, 1));
  jobs.add(job("r2", 20, 2));
  jobs.add(job("r1", 10, 3));
  EXPECT_EQ(sessions(jobs.take_due(stamp_from_ns(20))), (std::vector<std::uint16_t>{2, 3}));
  EXPECT_FALSE(jobs.empty());
  EXPECT_EQ(sessions(jobs.take_due(stamp_from_ns(29))), std::vector<std::uint16_t>{});
  EXPECT_EQ(sessions(jobs.take_due(stamp_from_ns(30))), (std::vector<std::uint16_t>{1}));
  EXPECT_TRUE(jobs.empty());
}

TEST(RegistrationJobs, ThoseOfAKilledRobotAreDropped) {
  RegistrationJobs jobs;
  jobs.add(job("r1", 10, 1));
  jobs.add(job("r2", 10, 2));
  jobs.drop(AgentId::parse("r1").value());
  EXPECT_EQ(sessions(jobs.take_due(stamp_from_ns(10))), (std::vector<std::uint16_t>{2}));
}

}  // namespace
}  // namespace fleetmap::fault_injection
