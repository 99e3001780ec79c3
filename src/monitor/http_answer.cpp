#include "http_answer.hpp"

#include <memory>
#include <string_view>

#include "fleetmap/monitor/request_check.hpp"
#include "foxglove/client_session.hpp"
#include "foxglove/protocol.hpp"
#include "viewer.hpp"

namespace fleetmap::monitor {
namespace {

void add_security_headers(HttpResponse& response, std::string_view host) {
  const std::string policy =
      "default-src 'self'; img-src 'self' data: blob:; connect-src 'self' "
      "ws://" +
      std::string(host) + "; frame-ancestors 'none'; base-uri 'none'; form-action 'none'";
  response.headers.emplace_back("Content-Security-Policy", policy);
  response.headers.emplace_back("X-Content-Type-Options", "nosniff");
  response.headers.emplace_back("X-Frame-Options", "DENY");
  response.headers.emplace_back("Referrer-Policy", "no-referrer");
  response.headers.emplace_back("Cross-Origin-Resource-Policy", "same-origin");
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

HttpResponse refused(ServerState& state, unsigned status, std::string_view text) {
  ++state.counters.refused;
  return {.status = status,
          .headers = {{"Content-Type", "text/plain; charset=utf-8"}},
          .body = std::string(text) + '\n'};
}

/// Refusal of a Foxglove client, which cannot send headers: its token is in its address. The site
/// of a client with the token does not matter, since a browser attaches a cookie to the requests of any site,
/// but puts no token into their addresses.
std::optional<std::string_view> foxglove_refusal(const ServerState& state, const RequestHead& head,
                                                 std::string_view target) {
  const std::string& token = state.config.token;
  if (!token.empty() && equal_secrets(query_value(target, "token"), token))
    return refusal({.host = head.host, .origin = {}, .cookie = {}, .authorization = {}}, "", "");
  return refusal(head, token, state.cookie);
}

constexpr std::string_view kTooMany = "too many pages are open; close one";

bool is_full(const ServerState& state) { return state.counters.viewers >= state.config.max_viewers; }

HttpResponse answer_upgrade(ServerState& state, const HttpRequest& request, const RequestHead& head) {
  const std::string subprotocol(foxglove::accepted_subprotocol(request.subprotocols));
  const std::string_view target = request.target;
  const auto why = subprotocol.empty() ? refusal(head, state.config.token, state.cookie)
                                       : foxglove_refusal(state, head, target);
  if (why) return refused(state, 403, *why);
  const std::string_view path = target.substr(0, target.find('?'));
  if (subprotocol.empty() ? target != "/live" : path != "/live" && path != "/")
    return refused(state, 404,
                   "the page's WebSocket is at /live, Foxglove's at / with subprotocol foxglove.sdk.v1");
  if (is_full(state)) return refused(state, 503, kTooMany);
  HttpResponse response{.status = 101};
  if (subprotocol.empty()) {
    response.session = std::make_unique<Viewer>(state);
  } else {
    response.headers.emplace_back("Sec-WebSocket-Protocol", subprotocol);
    response.session = std::make_unique<foxglove::ClientSession>(state);
  }
  return response;
}

/// The page's address with the right token: the page follows, and its browser keeps the token as a cookie.
bool exchanges_token(const ServerState& state, const RequestHead& head, std::string_view target) {
  constexpr std::string_view kWithToken = "/?token=";
  return !state.config.token.empty() && target.starts_with(kWithToken) && !refusal(head, "", "") &&
         equal_secrets(target.substr(kWithToken.size()), state.config.token);
}

HttpResponse response_of(Reply reply, std::string_view host) {
  HttpResponse response{.status = reply.status, .headers = {{"Content-Type", reply.type}}};
  if (reply.gzip) response.headers.emplace_back("Content-Encoding", "gzip");
  response.headers.emplace_back("Cache-Control",
                                reply.immutable ? "private, max-age=31536000, immutable" : "no-store");
  add_security_headers(response, host);
  response.body = std::move(reply.body);
  return response;
}

}  // namespace

HttpResponse answer(ServerState& state, const HttpRequest& request) {
  using Method = HttpRequest::Method;
  const RequestHead head{request.host, request.origin, request.cookie, request.authorization};
  if (request.upgrade) return answer_upgrade(state, request, head);
  if (exchanges_token(state, head, request.target)) {
    // Not Strict: the page that a link of another site opens would come without the cookie, and be refused. A
    // browser adds a Lax cookie to no other request of another site.
    const std::string cookie = state.cookie + '=' + state.config.token;
    return {.status = 303,
            .headers = {{"Location", "/"}, {"Set-Cookie", cookie + "; HttpOnly; SameSite=Lax; Path=/"}}};
  }
  if (const auto why = refusal(head, state.config.token, state.cookie)) return refused(state, 403, *why);
  // A browser does not show its pages why a WebSocket was refused: they ask again without an upgrade.
  if (request.method == Method::get && request.target == "/live")
    return is_full(state) ? refused(state, 503, kTooMany)
                          : refused(state, 426, "this is the page's WebSocket");
  if (request.method == Method::other) return refused(state, 405, "everything here is read only");
  Reply reply = request.method == Method::post ? reply_to_order(state, head, request.target)
                                               : state.content.reply(request.target);
  if (reply.status >= 400) ++state.counters.refused;
  return response_of(std::move(reply), request.host);
}

}  // namespace fleetmap::monitor
