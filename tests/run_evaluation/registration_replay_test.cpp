#include "registration_replay.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace fleetmap::run_evaluation {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A run whose robots, r1 and r2, each logged one registration, or have no log where `method` is empty.
class RegistrationLogsTest : public ::testing::Test {
 protected:
  RegistrationLogs logs_of(const std::vector<std::string>& methods) const {
    RunFolder run;
    for (std::size_t k = 0; k < methods.size(); ++k) {
      const std::string name = "r" + std::to_string(k + 1);
      AgentFolder agent;
      agent.id = AgentId::parse(name).value();
      agent.directory = folder_.path() / name;
      std::filesystem::remove_all(agent.directory);
      std::filesystem::create_directories(agent.directory);
      if (!methods[k].empty()) write_log(agent, methods[k]);
      run.agents.push_back(agent);
    }
    return read_registration_logs(run);
  }

  testing::TemporaryFolder folder_;

 private:
  static void write_log(const AgentFolder& agent, const std::string& method) {
    store::LoggedRegistration one;
    one.target = {agent.id, 1};
    one.source = {agent.id, 2};
    one.method = method;
    one.target_cloud = one.source_cloud = Bytes(30, 1);
    auto log = store::RegistrationLog::open(agent.directory / store::kRegistrationLogFile);
    ASSERT_TRUE(log) << log.error().message;
    ASSERT_TRUE(log->add(one));
  }
};

TEST_F(RegistrationLogsTest, TheMethodIsThatOfTheRobots) {
  const RegistrationLogs paper = logs_of({"paper", "paper"});
  EXPECT_EQ(paper.method, registration::Method::paper);
  EXPECT_THAT(paper.notes, IsEmpty());
  ASSERT_EQ(paper.by_agent.size(), 2u);
  EXPECT_EQ(paper.by_agent[1].second.size(), 1u);
  EXPECT_EQ(logs_of({"correlation", "correlation"}).method, registration::Method::correlation);
  EXPECT_EQ(logs_of({"paper", "correlation"}).method, registration::Method::paper);
}

TEST_F(RegistrationLogsTest, AMissingLogIsANote) {
  const RegistrationLogs logs = logs_of({"", "paper"});
  EXPECT_EQ(logs.method, registration::Method::paper);
  EXPECT_THAT(logs.notes, ElementsAre(AllOf(HasSubstr("r1"), HasSubstr("is missing"))));
}

TEST_F(RegistrationLogsTest, AMethodThatThisProgramDoesNotHaveIsANote) {
  const RegistrationLogs logs = logs_of({"ndt"});
  EXPECT_EQ(logs.method, registration::Method::correlation);
  EXPECT_THAT(logs.notes, ElementsAre(AllOf(HasSubstr("r1"), HasSubstr("found 'ndt'"))));
}

}  // namespace
}  // namespace fleetmap::run_evaluation
