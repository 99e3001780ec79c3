#include "health/sensor_settings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::HasSubstr;

TEST(SensorSettings, TheCommandLineOverridesTheFile) {
  const testing::TemporaryFolder folder;
  const std::string file = folder.write("r1.yaml", "id: r1\nlidar: {model: vlp16, max_range: 80}\n").string();
  const auto of_file = sensor_settings(file, {}), set = sensor_settings(file, {"lidar.model=os1-64"});
  ASSERT_TRUE(of_file) << of_file.error().error.message;
  ASSERT_TRUE(set) << set.error().error.message;
  EXPECT_EQ(of_file->agent.perception.lidar.name, "vlp16");
  EXPECT_EQ(set->agent.perception.lidar.name, "os1-64");
}

TEST(SensorSettings, WrongOptionsAndWrongFilesHaveCodesOfTheirOwn) {
  EXPECT_TRUE(sensor_settings("", {}));
  const auto option = sensor_settings("", {"lidar"});
  ASSERT_FALSE(option);
  EXPECT_EQ(option.error().code, kUsage);
  const auto file = sensor_settings("none.yaml", {});
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().code, kBadConfiguration);
  EXPECT_THAT(file.error().error.message, HasSubstr("none.yaml"));
}

}  // namespace
}  // namespace fleetmap::apps
