#include "fleetmap/registration/registration_method.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace fleetmap::registration {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(RegistrationMethod, NamesOfConfigurationsAreThoseOfMethods) {
  for (const auto& [name, method] :
       {std::pair{"correlation", Method::correlation}, {"paper", Method::paper}}) {
    EXPECT_STREQ(to_string(method), name);
    const auto known = registration_method(name);
    ASSERT_TRUE(known) << known.error().message;
    EXPECT_EQ(*known, method);
  }
}

TEST(RegistrationMethod, UnknownNamesAreRefusedWithThoseThatExist) {
  for (const char* name : {"", "fpfh", "Paper", "paper "}) {
    const auto method = registration_method(name);
    ASSERT_FALSE(method) << name;
    EXPECT_THAT(method.error().message, AllOf(HasSubstr("'paper'"), HasSubstr("'correlation'"),
                                              HasSubstr("found '" + std::string(name) + "'")));
  }
}

TEST(RegistrationMethod, ThePapersUsesNoPrior) {
  EXPECT_TRUE(uses_prior(Method::correlation));
  EXPECT_FALSE(uses_prior(Method::paper));
}

}  // namespace
}  // namespace fleetmap::registration
