#include "http_answer.hpp"

#include <boost/beast/websocket/rfc6455.hpp>
#include <string_view>

#include "fleetmap/monitor/request_check.hpp"
#include "foxglove/protocol.hpp"

namespace fleetmap::monitor {
namespace {

std::string_view view_of(boost::string_view text) { return {text.data(), text.size()}; }

void add_security_headers(Response& response, std::string_view host) {
  const std::string policy =
      "default-src 'self'; img-src 'self' data: blob:; connect-src 'self' "
      "ws://" +
      std::string(host) + "; frame-ancestors 'none'; base-uri 'none'; form-action 'none'";
  response.set("Content-Security-Policy", policy);
  response.set("X-Content-Type-Options", "nosniff");
  response.set("X-Frame-Options", "DENY");
  response.set("Referrer-Policy", "no-referrer");
  response.set("Cross-Origin-Resource-Policy", "same-origin");
}

/// An order of an operator. `head` has passed refusal().
Reply reply_to_order(ServerState& state, const RequestHead& head, std::string_view target) {
  const auto order = parse_order_request(target);
  if (!order) return {.status = 405, .body = "everything here is read only\n"};
  if (!state.operated()) return {.status = 403, .body = "read only: orders need a live robot and a token\n"};
  // Browsers name the page that posts; other programs show the token themselves.
  if (head.origin.empty() && head.authorization.empty())
    return {.status = 403, .body = "an order needs an Origin\n"};
  if (const Status ordered = state.give_order(*order); !ordered)
    return {.status = 503, .body = ordered.error().message + '\n'};
  return {.status = 202, .body = "ordered\n"};
}

Response refused(ServerState& state, http::status status, std::string_view text) {
  ++state.refused;
  Response response;
  response.result(status);
  response.set(http::field::content_type, "text/plain; charset=utf-8");
  response.body() = std::string(text) + '\n';
  return response;
}

/// Refusal of a Foxglove client, which cannot send headers: its token is in its address. Who has the token
/// has been given it, so the site that the client is from does not matter then: a browser attaches a cookie
/// to the requests of any site, but puts no token into their addresses.
std::optional<std::string_view> foxglove_refusal(const ServerState& state, const RequestHead& head,
                                                 std::string_view target) {
  const std::string& token = state.config.token;
  if (!token.empty() && equal_secrets(query_value(target, "token"), token))
    return refusal({.host = head.host, .origin = {}, .cookie = {}, .authorization = {}}, "", "");
  return refusal(head, token, state.cookie);
}

/// The subprotocol of Foxglove that a request offers; empty if it offers none.
std::string offered_subprotocol(const Request& request) {
  std::string offered;
  const auto [begin, end] = request.equal_range(http::field::sec_websocket_protocol);
  for (auto field = begin; field != end; ++field) offered += std::string(view_of(field->value())) + ',';
  return std::string(foxglove::chosen_subprotocol(offered));
}

Response answer_upgrade(ServerState& state, const Request& request, const RequestHead& head,
                        std::string_view target) {
  const std::string subprotocol = offered_subprotocol(request);
  const auto why = subprotocol.empty() ? refusal(head, state.config.token, state.cookie)
                                       : foxglove_refusal(state, head, target);
  if (why) return refused(state, http::status::forbidden, *why);
  const std::string_view path = target.substr(0, target.find('?'));
  if (subprotocol.empty() ? target != "/live" : path != "/live" && path != "/")
    return refused(state, http::status::not_found,
                   "the page's WebSocket is at /live, Foxglove's at / with subprotocol foxglove.sdk.v1");
  if (state.viewers_now >= state.config.max_viewers)
    return refused(state, http::status::service_unavailable, "too many pages are open; close one");
  Response response;
  response.result(http::status::switching_protocols);
  if (!subprotocol.empty()) response.set(http::field::sec_websocket_protocol, subprotocol);
  return response;
}

}  // namespace

Response answer(ServerState& state, const Request& request) {
  const std::string_view target = view_of(request.target()), host = view_of(request[http::field::host]);
  const RequestHead head{host, view_of(request[http::field::origin]), view_of(request[http::field::cookie]),
                         view_of(request[http::field::authorization])};
  if (beast::websocket::is_upgrade(request)) return answer_upgrade(state, request, head, target);
  Response response;
  constexpr std::string_view kWithToken = "/?token=";
  if (!state.config.token.empty() && target.starts_with(kWithToken) && !refusal(head, "", "") &&
      equal_secrets(target.substr(kWithToken.size()), state.config.token)) {
    response.result(http::status::see_other);
    response.set(http::field::location, "/");
    response.set(http::field::set_cookie,
                 state.cookie + '=' + state.config.token + "; HttpOnly; SameSite=Strict; Path=/");
    return response;
  }
  if (const auto why = refusal(head, state.config.token, state.cookie))
    return refused(state, http::status::forbidden, *why);
  const bool orders = request.method() == http::verb::post;
  if (!orders && request.method() != http::verb::get && request.method() != http::verb::head)
    return refused(state, http::status::method_not_allowed, "everything here is read only");
  Reply reply = orders ? reply_to_order(state, head, target) : state.content.reply(target);
  if (reply.status >= 400) ++state.refused;
  response.result(reply.status);
  response.set(http::field::content_type, reply.type);
  if (reply.gzip) response.set(http::field::content_encoding, "gzip");
  response.set(http::field::cache_control,
               reply.immutable ? "private, max-age=31536000, immutable" : "no-store");
  add_security_headers(response, host);
  response.body() = std::move(reply.body);
  return response;
}

}  // namespace fleetmap::monitor
