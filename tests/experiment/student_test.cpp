#include "student.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fleetmap::experiment {
namespace {

TEST(Student, AgreesWithTables) {
  EXPECT_NEAR(student_tail(0.0, 3.0), 0.5, 1e-9);
  EXPECT_NEAR(student_tail(12.706, 1.0), 0.025, 1e-5);
  EXPECT_NEAR(student_tail(4.303, 2.0), 0.025, 1e-5);
  EXPECT_NEAR(student_tail(2.145, 14.0), 0.025, 2e-5);
  EXPECT_NEAR(student_tail(-1.7613, 14.0), 0.95, 2e-5);
  EXPECT_NEAR(student_quantile(0.025, 14.0), 2.1448, 1e-4);
  EXPECT_TRUE(std::isnan(student_tail(std::nan(""), 2.0)));
}

}  // namespace
}  // namespace fleetmap::experiment
