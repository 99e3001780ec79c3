#include "fleetmap/config/experiment_config.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace fleetmap::config {
namespace {

TEST(ExperimentConfig, FindsAMetricByItsWholeName) {
  ExperimentConfig config;
  config.metrics = {{"map.rmse", "error", "m"}, {"map", "points", ""}};
  ASSERT_NE(config.metric("map"), nullptr);
  EXPECT_EQ(config.metric("map")->title, "points");
  ASSERT_NE(config.metric("map.rmse"), nullptr);
  EXPECT_EQ(config.metric("map.rmse")->title, "error");
  EXPECT_EQ(config.metric("map.r"), nullptr);
  EXPECT_EQ(config.metric(""), nullptr);
}

TEST(ExperimentConfig, EachShapeHasANameOfItsOwn) {
  std::set<std::string> names;
  for (const Shape shape : {Shape::kFalls, Shape::kRises, Shape::kFallsLessThanLinearly, Shape::kDoesNotRise,
                            Shape::kDoesNotFall}) {
    EXPECT_FALSE(std::string(to_string(shape)).empty());
    names.insert(to_string(shape));
  }
  EXPECT_EQ(names.size(), 5u);
}

}  // namespace
}  // namespace fleetmap::config
