// A request to the monitor's server, header by header: pages, submaps, WebSockets and an operator's orders.
#include <string>

#include "checks.hpp"
#include "fleetmap/monitor/request_check.hpp"
#include "monitor/http_answer.hpp"
#include "monitor/web_server.hpp"

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
                             [](const NodeId&, const ContentHash&) { return Result<cloud::PointCloud>(); },
                             kPage};
  int orders = 0;
  Robot() {
    state.cookie = "fleetmap_80";
    state.give_order = [this](const monitor::OrderRequest&) -> Status {
      ++orders;
      return {};
    };
  }
};

void ask(Robot& robot, ByteView bytes) {
  const auto request = monitor::parse_request(text_of(bytes));
  if (!request) return;
  const int before = robot.orders;
  const monitor::HttpResponse response = monitor::answer(robot.state, *request);
  require(response.status >= 101 && response.status < 600, "a status that is none");
  require((response.status == 101) == (response.session != nullptr), "a WebSocket without session");
  const bool ordered = robot.orders != before;
  require(ordered == (response.status == 202), "an order whose answer tells otherwise");
  const bool has_token = text_of(bytes).find(kToken) != std::string_view::npos;
  require(has_token || response.status >= 400, "answered without a token");
  require(!ordered || request->method == monitor::HttpRequest::Method::post, "an order without POST");
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
