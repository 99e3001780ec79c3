// A request to the monitor's server, header by header: pages, submaps, WebSockets and an operator's orders.
#include <string>

#include "checks.hpp"
#include "fleetmap/monitor/request_check.hpp"
#include "monitor/connection.hpp"
#include "monitor/http_answer.hpp"
#include "monitor/viewer.hpp"

namespace fleetmap::fuzz {
namespace {

constexpr const char* kToken = "0123456789abcdef";
constexpr std::uint8_t kFile[] = {1, 2, 3};
constexpr monitor::PageFile kPage[] = {{"/index.html", "text/html", kFile}};

struct Robot {
  monitor::ServerState state{[] {
                               monitor::ServerConfig config;
                               config.token = kToken;
                               return config;
                             }(),
                             [](const NodeId&) { return Result<cloud::PointCloud>(); }, kPage};
  int orders = 0;
  Robot() {
    state.cookie = "fleetmap_80";
    state.give_order = [this](const monitor::OrderRequest&) -> Status {
      ++orders;
      return {};
    };
  }
};

/// As Connection reads it.
void ask(Robot& robot, ByteView bytes) {
  monitor::http::request_parser<monitor::http::empty_body> parser;
  parser.header_limit(monitor::Connection::kMaxHeaderBytes);
  parser.body_limit(0);
  parser.eager(true);
  monitor::error_code error;
  parser.put(monitor::net::buffer(bytes.data(), bytes.size()), error);
  if (error || !parser.is_done()) return;
  const monitor::Request request = parser.release();
  const int before = robot.orders;
  const monitor::Response response = monitor::answer(robot.state, request);
  require(response.result_int() >= 101 && response.result_int() < 600, "a status that is none");
  const bool ordered = robot.orders != before;
  require(ordered == (response.result_int() == 202), "an order whose answer tells otherwise");
  const bool has_token = text_of(bytes).find(kToken) != std::string_view::npos;
  require(has_token || response.result_int() >= 400, "answered without a token");
  require(!ordered || request.method() == monitor::http::verb::post, "an order without POST");
}

}  // namespace
}  // namespace fleetmap::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fleetmap;
  static fuzz::Robot robot;
  const ByteView bytes(data, size);
  fuzz::ask(robot, bytes);
  const std::string_view text = fuzz::text_of(bytes);
  static_cast<void>(monitor::parse_submap_request(text));
  if (const auto submaps = monitor::parse_submaps_request(text))
    fuzz::require(!submaps->hashes.empty() && submaps->hashes.size() <= monitor::kMaxSubmapsAtOnce,
                  "too many submaps");
  if (const auto order = monitor::parse_order_request(text); order && order->robot)
    fuzz::require(text.find("=" + order->robot->str()) != std::string_view::npos &&
                      (!order->to || text.ends_with("=" + order->to->str())),
                  "an order for another robot than is named");
  return 0;
}
