#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fleetmap/core/ids.hpp"

namespace fleetmap::monitor {

/// The headers that decide whether a request is answered; absent ones are empty.
struct RequestHead {
  std::string_view host, origin, cookie, authorization;
};

/// The name is an IP address or localhost, with any port. Browsers send the name of a page's own site, so a
/// foreign name that was made to resolve to this machine (DNS rebinding) is refused.
bool is_own_host(std::string_view host);
/// No Origin, or that of this server: a page of another site may not read or open anything here.
bool is_own_origin(std::string_view origin, std::string_view host);
/// The address is one of IPv4 or IPv6, also with a zone: "fe80::1%wlan0".
bool is_ip_address(const std::string& address);
/// The address is one of this machine alone.
bool is_loopback(std::string_view address);

/// "Cookie: a=b; NAME=VALUE" -> VALUE.
std::string_view cookie_value(std::string_view cookie, std::string_view name);
/// "/path?a=b&NAME=VALUE" -> VALUE.
std::string_view query_value(std::string_view target, std::string_view name);
/// Takes as long whatever the first difference is.
bool equal_secrets(std::string_view a, std::string_view b);
/// 32 random hexadecimal digits.
std::string random_token();
inline constexpr std::size_t kMinTokenLength = 16;

/// Empty if the request may be answered, else why not. An empty `token` asks for none.
std::optional<std::string_view> refusal(const RequestHead& head, std::string_view token,
                                        std::string_view cookie_name);

/// Part of a submap: "/submap/HASH?from=N&count=N", where HASH has 32 hexadecimal digits.
struct SubmapRequest {
  std::string hash;
  std::size_t from = 0, count = 0;
};
std::optional<SubmapRequest> parse_submap_request(std::string_view target);

/// Some first points of several submaps: "/submaps?from=N&count=N&of=HASH,HASH", at most kMaxSubmapsAtOnce.
struct SubmapsRequest {
  std::vector<std::string> hashes;
  std::size_t from = 0, count = 0;  ///< of each
};
inline constexpr std::size_t kMaxSubmapsAtOnce = 128;
std::optional<SubmapsRequest> parse_submaps_request(std::string_view target);

/// An operator's order: "/operator/hold", "/operator/resume" and "/operator/home", of all robots or with
/// "?robot=NAME" of one; "/operator/give?robot=NAME&row=N", to any other robot or with "&to=NAME" to one.
struct OrderRequest {
  enum class Kind { kHold, kResume, kHome, kGive };
  Kind kind = Kind::kHold;
  std::optional<AgentId> robot;  ///< empty: all
  std::uint32_t row = 0;         ///< of kGive, its id
  std::optional<AgentId> to;     ///< of kGive; empty: any other robot
};
std::optional<OrderRequest> parse_order_request(std::string_view target);

}  // namespace fleetmap::monitor
