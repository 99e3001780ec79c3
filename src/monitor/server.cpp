#include "fleetmap/monitor/server.hpp"

#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <optional>
#include <set>
#include <thread>

#include "content.hpp"
#include "fleetmap/monitor/request_check.hpp"

namespace fleetmap::monitor {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
namespace net = boost::asio;
namespace websocket = beast::websocket;
using boost::system::error_code;
using net::ip::tcp;

constexpr std::uint32_t kMaxHeaderBytes = 8192;
constexpr std::size_t kMaxHeardBytes = 1024;  // of a viewer, which has nothing to tell yet

using Request = http::request<http::empty_body>;
using Response = http::response<http::string_body>;

std::string_view view_of(boost::string_view text) { return {text.data(), text.size()}; }

}  // namespace

class Viewer;

struct Server::State {
  State(const ServerConfig& config_, store::SubmapLoader load, std::span<const PageFile> page)
      : config(config_), content(page, std::move(load), config_.cached_bytes) {}

  const ServerConfig config;
  std::string cookie;  ///< its name; cookies are shared by all ports of a host
  Content content;
  std::set<Viewer*> viewers;
  std::size_t connections = 0;
  std::atomic<std::uint64_t> requests{0}, refused{0}, cut{0};
  std::atomic<std::size_t> viewers_now{0};
  net::io_context io{1};
  tcp::acceptor acceptor{io};
  net::steady_timer pause{io};
  std::uint16_t port = 0;
  std::thread thread;

  void accept();
  void run();
  Response answer(const Request& request);
};

using State = Server::State;

namespace {

/// One of the connections that are counted, however it ends.
class Counted {
 public:
  explicit Counted(State& state) : state_(&state) { ++state_->connections; }
  ~Counted() { --state_->connections; }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;

 private:
  State* state_;
};

}  // namespace

/// A page that is open: it gets every state, or only the newest where it is too slow for all.
class Viewer : public std::enable_shared_from_this<Viewer> {
 public:
  Viewer(State& state, beast::tcp_stream stream, std::shared_ptr<Counted> counted)
      : state_(state), counted_(std::move(counted)), socket_(std::move(stream)) {}
  ~Viewer() {
    if (state_.viewers.erase(this) > 0) --state_.viewers_now;
  }

  void run(const Request& request) {
    // The socket's own deadline would end the WebSocket with it; this one pings.
    beast::get_lowest_layer(socket_).expires_never();
    socket_.set_option(
        websocket::stream_base::timeout{state_.config.request_timeout, state_.config.idle_timeout, true});
    socket_.read_message_max(0);  // pieces of a message are dropped as they come
    state_.viewers.insert(this);
    ++state_.viewers_now;
    socket_.async_accept(request, [self = shared_from_this()](error_code error) {
      if (error) return;
      self->open_ = true;
      self->send(self->state_.content.state());
      self->read();
    });
  }

  void send(std::shared_ptr<const std::string> text) {
    if (!open_) return;
    if (writing_) {
      next_ = std::move(text);
      return;
    }
    writing_ = std::move(text);
    socket_.text(true);
    socket_.async_write(net::buffer(*writing_), [self = shared_from_this()](error_code error, std::size_t) {
      self->writing_.reset();
      if (error) return;
      if (auto next = std::move(self->next_)) self->send(std::move(next));
    });
  }

 private:
  void read() {
    const auto on_bytes = [self = shared_from_this()](error_code error, std::size_t bytes) {
      self->buffer_.consume(self->buffer_.size());
      self->heard_ += bytes;
      if (!error && self->heard_ <= kMaxHeardBytes) return self->read();
      self->open_ = false;
      if (error != websocket::error::closed) ++self->state_.cut;
      // At once: a closing handshake would wait for one who may not answer.
      beast::get_lowest_layer(self->socket_).close();
    };
    socket_.async_read_some(buffer_, kMaxHeardBytes, on_bytes);
  }

  State& state_;
  std::shared_ptr<Counted> counted_;
  websocket::stream<beast::tcp_stream> socket_;
  beast::flat_buffer buffer_;
  std::shared_ptr<const std::string> writing_, next_;
  std::size_t heard_ = 0;
  bool open_ = false;
};

namespace {

/// Answers the requests of one connection, one after the other.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(State& state, tcp::socket socket)
      : state_(state), counted_(std::make_shared<Counted>(state)), stream_(std::move(socket)) {}

  void read() {
    parser_.emplace();
    parser_->header_limit(kMaxHeaderBytes);
    parser_->body_limit(0);
    stream_.expires_after(state_.config.request_timeout);
    http::async_read(stream_, buffer_, *parser_,
                     [self = shared_from_this()](error_code error, std::size_t) { self->on_request(error); });
  }

 private:
  void on_request(error_code error) {
    if (error == http::error::end_of_stream) return close();
    if (error == beast::error::timeout) {
      if (parser_->got_some()) ++state_.cut;
      return;
    }
    if (error == http::error::header_limit || error == http::error::buffer_overflow) {
      ++state_.cut;
      return write(failed(http::status::request_header_fields_too_large, "the request's header is too long"));
    }
    if (error) {
      ++state_.refused;
      if (error.category() != make_error_code(http::error::bad_method).category()) return;
      return write(failed(http::status::bad_request, "the request is malformed"));
    }
    ++state_.requests;
    const Request request = parser_->release();
    Response response = state_.answer(request);
    const bool opens = response.result() == http::status::switching_protocols;
    if (opens) return std::make_shared<Viewer>(state_, std::move(stream_), counted_)->run(request);
    response.version(request.version());
    response.keep_alive(request.keep_alive());
    if (request.method() == http::verb::head) {
      response.content_length(response.body().size());
      response.body().clear();
      response.keep_alive(false);
    } else {
      response.prepare_payload();
    }
    write(std::move(response));
  }

  static Response failed(http::status status, const char* text) {
    Response response(status, 11);
    response.body() = text;
    response.keep_alive(false);
    response.prepare_payload();
    return response;
  }

  void write(Response response) {
    response_ = std::move(response);
    stream_.expires_after(state_.config.answer_timeout);
    http::async_write(stream_, response_, [self = shared_from_this()](error_code error, std::size_t) {
      if (error == beast::error::timeout) ++self->state_.cut;
      if (error) return;
      if (!self->response_.keep_alive()) return self->close();
      self->read();
    });
  }

  void close() {
    error_code ignored;
    stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
  }

  State& state_;
  std::shared_ptr<Counted> counted_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{2 * kMaxHeaderBytes};
  std::optional<http::request_parser<http::empty_body>> parser_;
  Response response_;
};

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

}  // namespace

/// switching_protocols stands for a viewer that may open its WebSocket.
Response State::answer(const Request& request) {
  const std::string_view target = view_of(request.target()), host = view_of(request[http::field::host]);
  const RequestHead head{host, view_of(request[http::field::origin]), view_of(request[http::field::cookie]),
                         view_of(request[http::field::authorization])};
  Response response;
  const auto plain = [&](http::status status, std::string_view text) {
    ++refused;
    response.result(status);
    response.set(http::field::content_type, "text/plain; charset=utf-8");
    response.body() = std::string(text) + '\n';
    return response;
  };
  constexpr std::string_view kWithToken = "/?token=";
  if (!config.token.empty() && target.starts_with(kWithToken) && !refusal(head, "", "") &&
      equal_secrets(target.substr(kWithToken.size()), config.token)) {
    response.result(http::status::see_other);
    response.set(http::field::location, "/");
    response.set(http::field::set_cookie,
                 cookie + '=' + config.token + "; HttpOnly; SameSite=Strict; Path=/");
    return response;
  }
  if (const auto why = refusal(head, config.token, cookie)) return plain(http::status::forbidden, *why);
  if (request.method() != http::verb::get && request.method() != http::verb::head)
    return plain(http::status::method_not_allowed, "everything here is read only");
  if (websocket::is_upgrade(request)) {
    if (target != "/live") return plain(http::status::not_found, "the WebSocket is at /live");
    if (viewers.size() >= config.max_viewers)
      return plain(http::status::service_unavailable, "too many pages are open; close one");
    response.result(http::status::switching_protocols);
    return response;
  }
  Reply reply = content.reply(target);
  if (reply.status >= 400) ++refused;
  response.result(reply.status);
  response.set(http::field::content_type, reply.type);
  if (reply.gzip) response.set(http::field::content_encoding, "gzip");
  response.set(http::field::cache_control,
               reply.immutable ? "private, max-age=31536000, immutable" : "no-store");
  add_security_headers(response, host);
  response.body() = std::move(reply.body);
  return response;
}

void State::accept() {
  acceptor.async_accept([this](error_code error, tcp::socket socket) {
    if (error == net::error::operation_aborted) return;
    if (error) {  // as when the process has no file descriptor left
      pause.expires_after(std::chrono::milliseconds(200));
      return pause.async_wait([this](error_code) { accept(); });
    }
    if (connections < config.max_connections) {
      std::make_shared<Connection>(*this, std::move(socket))->read();
    } else {
      ++cut;  // and the socket closes
    }
    accept();
  });
}

void State::run() {
  while (true) {
    try {
      io.run();
      return;
    } catch (const std::exception&) {
      // One viewer's connection ends so; the robot and the other viewers go on.
      ++cut;
    }
  }
}

Status ServerConfig::validate() const {
  error_code error;
  net::ip::make_address(address, error);
  if (error) return failure(address + " is no IP address, as 127.0.0.1 or 0.0.0.0 are");
  if (token.empty() && !is_loopback(address))
    return failure(address + " is seen by others: a token is needed");
  if (!token.empty() && token.size() < kMinTokenLength)
    return failure("the token is shorter than " + std::to_string(kMinTokenLength) + " characters");
  if (max_viewers == 0 || max_connections == 0)
    return failure("max_viewers and max_connections must be positive");
  return {};
}

Server::Server(std::unique_ptr<State> state) : state_(std::move(state)) {}

Server::~Server() {
  state_->io.stop();
  if (state_->thread.joinable()) state_->thread.join();
}

Result<std::unique_ptr<Server>> Server::start(const ServerConfig& config, store::SubmapLoader load,
                                              std::span<const PageFile> page) {
  if (const Status valid = config.validate(); !valid) return tl::unexpected(valid.error());
  auto state = std::make_unique<State>(config, std::move(load), page);
  const tcp::endpoint endpoint(net::ip::make_address(config.address), config.port);
  error_code error;
  state->acceptor.open(endpoint.protocol(), error);
  if (!error) state->acceptor.set_option(tcp::acceptor::reuse_address(true), error);
  if (!error) state->acceptor.bind(endpoint, error);
  if (!error) state->acceptor.listen(tcp::acceptor::max_listen_connections, error);
  if (error)
    return failure(config.address + ":" + std::to_string(config.port) + ": cannot be listened on (" +
                   error.message() + "); give another port");
  state->port = state->acceptor.local_endpoint().port();
  state->cookie = "fleetmap_" + std::to_string(state->port);
  state->accept();
  State* running = state.get();
  auto server = std::unique_ptr<Server>(new Server(std::move(state)));
  running->thread = std::thread([running] { running->run(); });
  return server;
}

std::uint16_t Server::port() const { return state_->port; }

std::string Server::url() const {
  const std::string& address = state_->config.address;
  const std::string host = address.find(':') == std::string::npos ? address : "[" + address + "]";
  const std::string& token = state_->config.token;
  return "http://" + host + ":" + std::to_string(state_->port) + "/" +
         (token.empty() ? "" : "?token=" + token);
}

void Server::publish(std::shared_ptr<const FleetView> view) {
  net::post(state_->io, [state = state_.get(), view = std::move(view)] {
    state->content.show(*view);
    for (Viewer* viewer : state->viewers) viewer->send(state->content.state());
  });
}

ServerStats Server::stats() const {
  return {state_->requests, state_->refused, state_->cut, state_->viewers_now};
}

}  // namespace fleetmap::monitor
