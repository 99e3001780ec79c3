#include "fleetmap/monitor/request_check.hpp"

#include <gtest/gtest.h>

namespace fleetmap::monitor {
namespace {

TEST(RequestCheck, hosts_are_addresses_or_localhost) {
  for (const char* own :
       {"localhost", "localhost:8080", "127.0.0.1:8080", "192.168.1.5", "[::1]:8080", "[fe80::1]"})
    EXPECT_TRUE(is_own_host(own)) << own;
  for (const char* foreign : {"", "evil.example", "evil.example:8080", "localhost.evil.example",
                              "127.0.0.1.evil.example", "127.0.0.1:8080.evil.example", "127.0.0.1:", "[::1",
                              "[evil]", "[::1]evil", "::1", "localhost:80:80", "2130706433", "a@127.0.0.1"})
    EXPECT_FALSE(is_own_host(foreign)) << foreign;
}

TEST(RequestCheck, addresses_are_of_ipv4_or_ipv6) {
  for (const char* address : {"0.0.0.0", "192.168.1.5", "::", "fe80::1", "fe80::1%wlan0"})
    EXPECT_TRUE(is_ip_address(address)) << address;
  for (const char* none : {"", "localhost", "1.2.3", "1.2.3.4:80", "1.2.3.4%eth0", "[::1]", "::1%"})
    EXPECT_FALSE(is_ip_address(none)) << none;
}

TEST(RequestCheck, only_the_own_page_may_ask) {
  EXPECT_TRUE(is_own_origin("", "127.0.0.1:8080"));
  EXPECT_TRUE(is_own_origin("http://127.0.0.1:8080", "127.0.0.1:8080"));
  for (const char* foreign :
       {"http://evil.example", "http://127.0.0.1:8081", "http://127.0.0.1", "https://127.0.0.1:8080", "null"})
    EXPECT_FALSE(is_own_origin(foreign, "127.0.0.1:8080")) << foreign;
}

TEST(RequestCheck, loopback_is_this_machine_alone) {
  EXPECT_TRUE(is_loopback("127.0.0.1"));
  EXPECT_TRUE(is_loopback("127.9.9.9"));
  EXPECT_TRUE(is_loopback("::1"));
  for (const char* open : {"0.0.0.0", "::", "192.168.1.5", "127.evil", "128.0.0.1"})
    EXPECT_FALSE(is_loopback(open)) << open;
}

TEST(RequestCheck, a_token_is_taken_from_the_cookie_or_the_header_and_from_nowhere_else) {
  const std::string token = random_token();
  ASSERT_EQ(token.size(), 32u);
  EXPECT_NE(random_token(), token);
  const std::string cookie = "a=b; fleetmap_80=" + token + "; c=d", bearer = "Bearer " + token;
  RequestHead head{.host = "10.0.0.1", .origin = "", .cookie = "", .authorization = ""};
  EXPECT_TRUE(refusal(head, token, "fleetmap_80"));
  EXPECT_FALSE(refusal(head, "", "fleetmap_80"));
  head.cookie = cookie;
  EXPECT_FALSE(refusal(head, token, "fleetmap_80"));
  EXPECT_TRUE(refusal(head, token, "fleetmap_8")) << "another port's cookie";
  EXPECT_TRUE(refusal(head, token + "0", "fleetmap_80"));
  head.cookie = "";
  head.authorization = bearer;
  EXPECT_FALSE(refusal(head, token, "fleetmap_80"));
  head.host = "evil.example";
  EXPECT_TRUE(refusal(head, token, "fleetmap_80"));
}

TEST(RequestCheck, a_query_has_values_by_name) {
  EXPECT_EQ(query_value("/?token=abc", "token"), "abc");
  EXPECT_EQ(query_value("/live?a=b&token=abc&c=d", "token"), "abc");
  for (const char* without :
       {"", "/", "/?", "?", "/token=abc", "/?mytoken=abc", "/?token", "/?a=token=abc", "/?&&"})
    EXPECT_EQ(query_value(without, "token"), "") << without;
}

TEST(RequestCheck, submaps_are_asked_for_by_hash_alone) {
  const auto request = parse_submap_request("/submap/0123456789abcdef0123456789abcdef?from=4096&count=100");
  ASSERT_TRUE(request);
  EXPECT_EQ(request->hash, "0123456789abcdef0123456789abcdef");
  EXPECT_EQ(request->from, 4096u);
  EXPECT_EQ(request->count, 100u);
  for (const char* wrong :
       {"/submap/", "/submap/../../etc/passwd?from=0&count=1",
        "/submap/0123456789abcdef0123456789abcdeg?from=0&count=1", "/submap/0123456789abcdef0123456789abcdef",
        "/submap/0123456789abcdef0123456789abcdef?from=-1&count=1",
        "/submap/0123456789abcdef0123456789abcdef?from=0&count=1&x=1",
        "/submap/0123456789abcdef0123456789abcdef?from=0",
        "/submap/0123456789abcdef0123456789abcdef?from=99999999999999999999999&count=1"})
    EXPECT_FALSE(parse_submap_request(wrong)) << wrong;
}

TEST(RequestCheck, several_submaps_are_asked_for_by_their_hashes) {
  const std::string a(32, 'a'), b(32, '0');
  const auto request = parse_submaps_request("/submaps?from=64&count=150&of=" + a + "," + b);
  ASSERT_TRUE(request);
  EXPECT_EQ(request->from, 64u);
  EXPECT_EQ(request->count, 150u);
  EXPECT_EQ(request->hashes, (std::vector{a, b}));
  std::string longest = "/submaps?from=0&count=1&of=" + a;
  for (std::size_t k = 1; k < kMaxSubmapsAtOnce; ++k) longest += "," + b;
  ASSERT_TRUE(parse_submaps_request(longest));
  EXPECT_EQ(parse_submaps_request(longest)->hashes.size(), kMaxSubmapsAtOnce);
  for (const std::string& wrong : std::initializer_list<std::string>{
           longest + "," + a, "/submaps", "/submaps?", "/submaps?of=" + a, "/submaps?count=1&of=" + a,
           "/submaps?from=0&of=" + a, "/submaps?from=-1&count=1&of=" + a, "/submaps?from=0&count=&of=" + a,
           "/submaps?from=0&count=1&of=", "/submaps?from=0&count=1&of=" + a + ",",
           "/submaps?from=0&count=1&of=" + a + b, "/submaps?from=0&count=1&of=" + a + ",," + b,
           "/submaps?from=0&count=1&of=" + a.substr(1), "/submaps?from=0&count=-1&of=" + a,
           "/submaps?from=0&count=1&of=" + std::string(32, 'g')})
    EXPECT_FALSE(parse_submaps_request(wrong)) << wrong;
}

TEST(RequestCheck, orders_are_for_one_robot_or_for_all) {
  const auto all = parse_order_request("/operator/hold");
  ASSERT_TRUE(all);
  EXPECT_EQ(all->kind, OrderRequest::Kind::kHold);
  EXPECT_FALSE(all->robot);
  const auto one = parse_order_request("/operator/resume?robot=r2");
  ASSERT_TRUE(one);
  EXPECT_EQ(one->kind, OrderRequest::Kind::kResume);
  EXPECT_EQ(one->robot->str(), "r2");
  EXPECT_EQ(parse_order_request("/operator/home?robot=r2")->kind, OrderRequest::Kind::kHome);
  EXPECT_FALSE(parse_order_request("/operator/home")->robot);
  for (const char* wrong : {"", "/operator", "/operator/", "/operator/holdall", "/operator/hold?", "/hold",
                            "/operator/hold?robot=", "/operator/hold?robot=a/b", "/operator/hold?name=r2",
                            "/operator/hold?robot=r2&robot=r1"})
    EXPECT_FALSE(parse_order_request(wrong)) << wrong;
}

TEST(RequestCheck, a_row_is_given_by_one_robot_to_another_or_to_any) {
  const auto any = parse_order_request("/operator/give?robot=r1&row=17");
  ASSERT_TRUE(any);
  EXPECT_EQ(any->kind, OrderRequest::Kind::kGive);
  EXPECT_EQ(any->robot->str(), "r1");
  EXPECT_EQ(any->row, 17u);
  EXPECT_FALSE(any->to);
  const auto one = parse_order_request("/operator/give?robot=r1&row=0&to=r2");
  ASSERT_TRUE(one);
  EXPECT_EQ(one->to->str(), "r2");
  for (const char* wrong : {"/operator/give", "/operator/give?robot=r1", "/operator/give?row=7",
                            "/operator/give?robot=r1&row=", "/operator/give?robot=r1&row=-1",
                            "/operator/give?robot=r1&row=4294967296",
                            "/operator/give?robot=r1&row=7&to=", "/operator/give?robot=r1&row=7&to=r2&to=r3",
                            "/operator/give?robot=&row=7", "/operator/hold?robot=r1&row=7"})
    EXPECT_FALSE(parse_order_request(wrong)) << wrong;
}

}  // namespace
}  // namespace fleetmap::monitor
