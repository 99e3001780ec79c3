#include "fleetmap/monitor/request_check.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <random>
#include <utility>

namespace fleetmap::monitor {
namespace {

bool is_ip(const std::string& address, int family) {
  std::array<unsigned char, sizeof(in6_addr)> parsed{};
  return inet_pton(family, address.c_str(), parsed.data()) == 1;
}

bool all_digits(std::string_view text) {
  return !text.empty() && text.size() <= 5 &&
         std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

/// "[::1]:80" -> "::1", "a:80" -> "a"; empty if it is neither.
std::string without_port(std::string_view host) {
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    if (end == std::string_view::npos) return {};
    const std::string_view rest = host.substr(end + 1);
    if (!rest.empty() && !(rest.front() == ':' && all_digits(rest.substr(1)))) return {};
    const std::string address(host.substr(1, end - 1));
    return is_ip(address, AF_INET6) ? address : std::string();
  }
  const std::size_t colon = host.find(':');
  if (colon == std::string_view::npos) return std::string(host);
  return all_digits(host.substr(colon + 1)) ? std::string(host.substr(0, colon)) : std::string();
}

std::optional<std::size_t> number_after(std::string_view text, std::string_view name) {
  if (!text.starts_with(name)) return std::nullopt;
  text.remove_prefix(name.size());
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// The first point and the number of points in "from=N&count=N".
std::optional<std::pair<std::size_t, std::size_t>> points_in(std::string_view query) {
  const std::size_t between = std::min(query.find('&'), query.size());
  const auto from = number_after(query.substr(0, between), "from=");
  const auto count = number_after(query.substr(between), "&count=");
  if (!from || !count) return std::nullopt;
  return std::pair(*from, *count);
}

/// Takes "NAME=ROBOT" off the front of `query`; nothing if that is not there.
std::optional<AgentId> take_agent(std::string_view& query, std::string_view name) {
  if (!query.starts_with(name)) return std::nullopt;
  const std::string_view value = query.substr(name.size(), query.find('&', 1) - name.size());
  const auto agent = AgentId::parse(std::string(value));
  if (!agent || agent->empty()) return std::nullopt;
  query.remove_prefix(name.size() + value.size());
  return *agent;
}

constexpr std::size_t kHashDigits = 32;

bool is_hash(std::string_view text) {
  const auto is_hex = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
  return text.size() == kHashDigits && std::ranges::all_of(text, is_hex);
}

}  // namespace

bool is_ip_address(const std::string& address) {
  const std::size_t zone = address.find('%');
  return is_ip(address, AF_INET) || (is_ip(address.substr(0, zone), AF_INET6) &&
                                     (zone == std::string::npos || zone + 1 < address.size()));
}

bool is_own_host(std::string_view host) {
  const std::string name = without_port(host);
  return name == "localhost" || is_ip(name, AF_INET) || (host.starts_with('[') && !name.empty());
}

bool is_own_origin(std::string_view origin, std::string_view host) {
  return origin.empty() || origin == "http://" + std::string(host);
}

bool is_loopback(std::string_view address) {
  const std::string text(address);
  return text == "::1" || (text.starts_with("127.") && is_ip(text, AF_INET));
}

std::string_view cookie_value(std::string_view cookie, std::string_view name) {
  while (!cookie.empty()) {
    const std::size_t end = std::min(cookie.find(';'), cookie.size());
    std::string_view one = cookie.substr(0, end);
    cookie.remove_prefix(std::min(end + 1, cookie.size()));
    one.remove_prefix(std::min(one.find_first_not_of(' '), one.size()));
    if (one.starts_with(name) && one.substr(name.size()).starts_with('=')) return one.substr(name.size() + 1);
  }
  return {};
}

std::string_view query_value(std::string_view target, std::string_view name) {
  target.remove_prefix(std::min(target.find('?'), target.size()));
  while (!target.empty()) {
    target.remove_prefix(1);
    const std::string_view one = target.substr(0, target.find('&'));
    target.remove_prefix(one.size());
    if (one.starts_with(name) && one.substr(name.size()).starts_with('=')) return one.substr(name.size() + 1);
  }
  return {};
}

bool equal_secrets(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    difference |= static_cast<unsigned>(static_cast<unsigned char>(a[k]) ^ static_cast<unsigned char>(b[k]));
  return difference == 0;
}

std::string random_token() {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::random_device source;
  std::string token;
  for (int k = 0; k < 32; ++k) token.push_back(kDigits[source() % kDigits.size()]);
  return token;
}

std::optional<std::string_view> refusal(const RequestHead& head, std::string_view token,
                                        std::string_view cookie_name) {
  if (!is_own_host(head.host)) return "the Host is no address of this program";
  if (!is_own_origin(head.origin, head.host)) return "pages of other sites are not answered";
  if (token.empty()) return std::nullopt;
  constexpr std::string_view kBearer = "Bearer ";
  const std::string_view bearer = head.authorization.starts_with(kBearer)
                                      ? head.authorization.substr(kBearer.size())
                                      : std::string_view{};
  if (equal_secrets(cookie_value(head.cookie, cookie_name), token) || equal_secrets(bearer, token))
    return std::nullopt;
  return "a token is needed: open the address that the program printed";
}

std::optional<SubmapRequest> parse_submap_request(std::string_view target) {
  constexpr std::string_view kStart = "/submap/";
  if (!target.starts_with(kStart)) return std::nullopt;
  target.remove_prefix(kStart.size());
  const std::size_t question = target.find('?');
  if (question != kHashDigits) return std::nullopt;
  const std::string_view hash = target.substr(0, question), query = target.substr(question + 1);
  const auto points = points_in(query);
  if (!is_hash(hash) || !points) return std::nullopt;
  return SubmapRequest{std::string(hash), points->first, points->second};
}

std::optional<SubmapsRequest> parse_submaps_request(std::string_view target) {
  constexpr std::string_view kStart = "/submaps?";
  if (!target.starts_with(kStart)) return std::nullopt;
  target.remove_prefix(kStart.size());
  const std::size_t between = target.find("&of=");
  if (between == std::string_view::npos) return std::nullopt;
  const auto points = points_in(target.substr(0, between));
  if (!points) return std::nullopt;
  SubmapsRequest request{{}, points->first, points->second};
  for (std::string_view left = target.substr(between + 4);;) {
    const std::string_view hash = left.substr(0, kHashDigits);
    if (!is_hash(hash) || request.hashes.size() == kMaxSubmapsAtOnce) return std::nullopt;
    request.hashes.emplace_back(hash);
    left.remove_prefix(kHashDigits);
    if (left.empty()) return request;
    if (left.front() != ',') return std::nullopt;
    left.remove_prefix(1);
  }
}

std::optional<OrderRequest> parse_order_request(std::string_view target) {
  using Kind = OrderRequest::Kind;
  constexpr std::array<std::pair<std::string_view, Kind>, 4> kPaths{{{"/operator/hold", Kind::kHold},
                                                                     {"/operator/resume", Kind::kResume},
                                                                     {"/operator/home", Kind::kHome},
                                                                     {"/operator/give", Kind::kGive}}};
  const std::string_view path = target.substr(0, target.find('?'));
  const auto found = std::ranges::find(kPaths, path, &std::pair<std::string_view, Kind>::first);
  if (found == kPaths.end()) return std::nullopt;
  OrderRequest order{found->second, std::nullopt, 0, std::nullopt};
  std::string_view query = target.substr(path.size());
  if (order.kind != Kind::kGive && query.empty()) return order;
  order.robot = take_agent(query, "?robot=");
  if (!order.robot) return std::nullopt;
  if (order.kind == Kind::kGive) {
    const std::string_view field = query.substr(0, query.find('&', 1));
    const auto row = number_after(field, "&row=");
    if (!row || *row > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
    order.row = static_cast<std::uint32_t>(*row);
    query.remove_prefix(field.size());
    if (!query.empty() && !(order.to = take_agent(query, "&to="))) return std::nullopt;
  }
  return query.empty() ? std::optional(order) : std::nullopt;
}

}  // namespace fleetmap::monitor
