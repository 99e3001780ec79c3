#include "monitor/http_message.hpp"

#include <gtest/gtest.h>

namespace fleetmap::monitor {
namespace {

TEST(HttpResponse, a_header_is_found_by_its_name) {
  const HttpResponse response{.headers = {{"A", "1"}, {"B", "2"}, {"A", "3"}}};
  EXPECT_EQ(response.header("B"), "2");
  EXPECT_EQ(response.header("A"), "1") << "the first one";
  EXPECT_EQ(response.header("C"), "");
}

}  // namespace
}  // namespace fleetmap::monitor
