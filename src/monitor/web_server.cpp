#include "web_server.hpp"

#include <algorithm>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <list>
#include <memory>
#include <string>
#include <utility>

namespace fleetmap::monitor {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
namespace net = boost::asio;
namespace websocket = beast::websocket;
using boost::system::error_code;
using net::ip::tcp;

using Request = http::request<http::empty_body>;
using Response = http::response<http::string_body>;
using Parser = http::request_parser<http::empty_body>;

class Connection;

/// Shared by the connections of one server.
struct Shared {
  const ServerConfig& config;
  ServerCounters& counters;
  WebServer::Answer answer;
  std::list<std::weak_ptr<Connection>> connections = {};  ///< of HTTP, the oldest first
};

/// Counts a connection until the last one who holds this ends, however that is.
std::shared_ptr<void> count_connection(ServerCounters& counters) {
  ++counters.connections;
  return {&counters, [](ServerCounters* all) { --all->connections; }};
}

void set_limits(Parser& parser) {
  parser.header_limit(WebServer::kMaxHeaderBytes);
  parser.body_limit(0);
}

HttpRequest::Method method_of(http::verb verb) {
  using enum HttpRequest::Method;
  if (verb == http::verb::get) return get;
  if (verb == http::verb::head) return head;
  return verb == http::verb::post ? post : other;
}

/// Empty if it names two hosts: it is for either of them, and a check of one would pass the other.
std::optional<HttpRequest> plain(const Request& request) {
  if (request.count(http::field::host) > 1) return std::nullopt;
  const auto header = [&](http::field name) {
    const auto value = request[name];
    return std::string(value.data(), value.size());
  };
  HttpRequest asked{.method = method_of(request.method()),
                    .target = std::string(request.target().data(), request.target().size()),
                    .host = header(http::field::host),
                    .origin = header(http::field::origin),
                    .cookie = header(http::field::cookie),
                    .authorization = header(http::field::authorization),
                    .upgrade = websocket::is_upgrade(request),
                    .subprotocols = {}};
  const auto [begin, end] = request.equal_range(http::field::sec_websocket_protocol);
  for (auto field = begin; field != end; ++field)
    asked.subprotocols += std::string(field->value().data(), field->value().size()) + ',';
  return asked;
}

Response failed(http::status status, const char* text) {
  Response response(status, 11);
  response.body() = text;
  response.keep_alive(false);
  response.prepare_payload();
  return response;
}

/// The WebSocket of one session, which it owns.
class OpenWebSocket : public WebSocket, public std::enable_shared_from_this<OpenWebSocket> {
 public:
  OpenWebSocket(Shared& shared, beast::tcp_stream stream, std::shared_ptr<void> counted,
                std::unique_ptr<WebSocketSession> session)
      : shared_(shared),
        counted_(std::move(counted)),
        socket_(std::move(stream)),
        session_(std::move(session)) {}

  /// Accepts the WebSocket that `request` opens.
  void open(const Request& request, const std::string& subprotocol) {
    // The stream's own deadline would end the WebSocket with it; the WebSocket's timeout pings instead.
    beast::get_lowest_layer(socket_).expires_never();
    socket_.set_option(
        websocket::stream_base::timeout{shared_.config.request_timeout, shared_.config.idle_timeout, true});
    if (!subprotocol.empty()) {
      socket_.set_option(websocket::stream_base::decorator([subprotocol](websocket::response_type& response) {
        response.set(http::field::sec_websocket_protocol, subprotocol);
      }));
    }
    socket_.read_message_max(session_->limits().message_bytes);
    socket_.write_buffer_bytes(session_->limits().frame_bytes);
    socket_.async_accept(request, [self = shared_from_this()](error_code error) {
      if (error) return;
      self->session_->on_open(*self);
      self->read();
    });
  }

  void write(Kind kind, Parts parts) override {
    socket_.text(kind == Kind::text);
    const std::array<net::const_buffer, 2> buffers{net::buffer(parts[0].data(), parts[0].size()),
                                                   net::buffer(parts[1].data(), parts[1].size())};
    socket_.async_write(buffers, [self = shared_from_this()](error_code error, std::size_t) {
      if (!error) self->session_->on_written();
    });
  }
  void cut() override {
    cut_ = true;
    beast::get_lowest_layer(socket_).close();
  }

 private:
  void read() {
    socket_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
      if (error) {
        if (error != websocket::error::closed && !self->cut_) ++self->shared_.counters.cut;
        self->session_->on_closed();
        return self->cut();
      }
      const auto bytes = self->buffer_.data();
      self->session_->on_message(self->socket_.got_text() ? Kind::text : Kind::binary,
                                 {static_cast<const char*>(bytes.data()), bytes.size()});
      self->buffer_.consume(self->buffer_.size());
      if (!self->cut_) self->read();
    });
  }

  Shared& shared_;
  std::shared_ptr<void> counted_;
  websocket::stream<beast::tcp_stream> socket_;
  beast::flat_buffer buffer_;
  bool cut_ = false;
  std::unique_ptr<WebSocketSession> session_;  ///< last: it is destroyed first
};

/// Answers the requests of one HTTP connection, one after the other.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(Shared& shared, tcp::socket socket)
      : shared_(shared), counted_(count_connection(shared.counters)), stream_(std::move(socket)) {}

  /// Reads the next request and answers it.
  void read() {
    reads_ = true;
    set_limits(parser_.emplace());
    stream_.expires_after(shared_.config.request_timeout);
    http::async_read(stream_, buffer_, *parser_,
                     [self = shared_from_this()](error_code error, std::size_t) { self->on_request(error); });
  }

  /// Ends it if it waits for a request; false: it does not.
  bool give_way() {
    if (!reads_) return false;
    stream_.close();
    return std::exchange(reads_, false);
  }

 private:
  void on_request(error_code error) {
    reads_ = false;
    if (error == net::error::operation_aborted) return;  // it gave way
    if (error == http::error::end_of_stream) return close();
    if (error == beast::error::timeout) return void(shared_.counters.cut += parser_->got_some());
    if (error == http::error::header_limit || error == http::error::buffer_overflow) {
      ++shared_.counters.cut;
      return write(failed(http::status::request_header_fields_too_large, "the request's header is too long"));
    }
    if (error) {
      ++shared_.counters.refused;
      if (error.category() != make_error_code(http::error::bad_method).category()) return;
      return write(failed(http::status::bad_request, "the request is malformed"));
    }
    ++shared_.counters.requests;
    const Request request = parser_->release();
    const std::optional<HttpRequest> asked = plain(request);
    if (!asked) {
      ++shared_.counters.refused;
      return write(failed(http::status::bad_request, "the request names more than one host"));
    }
    HttpResponse answered = shared_.answer(*asked);
    if (answered.session) return open(request, std::move(answered));
    write(response_to(request, std::move(answered)));
  }

  static Response response_to(const Request& request, HttpResponse answered) {
    Response response(http::int_to_status(answered.status), request.version());
    for (const auto& [name, value] : answered.headers) response.set(name, value);
    response.body() = std::move(answered.body);
    response.keep_alive(request.keep_alive());
    if (request.method() == http::verb::head) {
      response.content_length(response.body().size());
      response.body().clear();
      response.keep_alive(false);
    } else {
      response.prepare_payload();
    }
    return response;
  }

  void open(const Request& request, HttpResponse answered) {
    const std::string subprotocol(answered.header("Sec-WebSocket-Protocol"));
    std::make_shared<OpenWebSocket>(shared_, std::move(stream_), counted_, std::move(answered.session))
        ->open(request, subprotocol);
  }

  void write(Response response) {
    response_ = std::move(response);
    stream_.expires_after(shared_.config.answer_timeout);
    http::async_write(stream_, response_, [self = shared_from_this()](error_code error, std::size_t) {
      if (error == beast::error::timeout) ++self->shared_.counters.cut;
      if (error) return;
      if (!self->response_.keep_alive()) return self->close();
      self->read();
    });
  }

  void close() {
    error_code ignored;
    stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
  }

  Shared& shared_;
  std::shared_ptr<void> counted_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{2 * WebServer::kMaxHeaderBytes};
  std::optional<Parser> parser_;
  Response response_;
  bool reads_ = false;  ///< waits for a request
};

/// Whether one more connection may be. Where there are too many, the one that has waited for a request for
/// longest gives way, so that who opens many and says nothing keeps nobody out.
bool has_room(Shared& shared) {
  std::erase_if(shared.connections, [](const auto& one) { return one.expired(); });
  if (shared.counters.connections < shared.config.max_connections) return true;
  ++shared.counters.cut;
  return std::ranges::any_of(shared.connections, [](const auto& one) {
    const auto connection = one.lock();
    return connection && connection->give_way();
  });
}

}  // namespace

struct WebServer::Impl {
  Shared shared;
  net::io_context io{1};
  tcp::acceptor acceptor{io};
  net::steady_timer pause{io};

  Status listen();
  void accept();
};

Status WebServer::Impl::listen() {
  const ServerConfig& config = shared.config;
  error_code error;
  const tcp::endpoint endpoint(net::ip::make_address(config.address, error), config.port);
  if (!error) acceptor.open(endpoint.protocol(), error);
  if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(tcp::acceptor::max_listen_connections, error);
  if (error)
    return failure(config.address + ":" + std::to_string(config.port) + ": cannot be listened on (" +
                   error.message() + "); give another port");
  return {};
}

void WebServer::Impl::accept() {
  acceptor.async_accept([this](error_code error, tcp::socket socket) {
    if (error == net::error::operation_aborted) return;
    if (error) {  // as when the process has no file descriptor left
      pause.expires_after(std::chrono::milliseconds(200));
      return pause.async_wait([this](error_code) { accept(); });
    }
    if (has_room(shared)) {
      const auto connection = std::make_shared<Connection>(shared, std::move(socket));
      shared.connections.push_back(connection);
      connection->read();
    }  // else the socket closes
    accept();
  });
}

WebServer::WebServer(const ServerConfig& config, ServerCounters& counters)
    : impl_(new Impl{.shared = {config, counters, nullptr}}) {}

WebServer::~WebServer() = default;

Status WebServer::listen(Answer answer) {
  impl_->shared.answer = std::move(answer);
  if (Status opened = impl_->listen(); !opened) return opened;
  impl_->accept();
  return {};
}

std::uint16_t WebServer::port() const { return impl_->acceptor.local_endpoint().port(); }

void WebServer::run() {
  while (true) {
    try {
      impl_->io.run();
      return;
    } catch (const std::exception&) {
      // One connection ends so; the robot and the other viewers go on.
      ++impl_->shared.counters.cut;
    }
  }
}

void WebServer::stop() { impl_->io.stop(); }

void WebServer::post(Task task) { net::post(impl_->io, std::move(task)); }

void WebServer::post_at(Clock::time_point time, Task task) {
  auto timer = std::make_shared<net::steady_timer>(impl_->io, time);
  timer->async_wait([timer, task = std::move(task)](error_code error) {
    if (!error) task();
  });
}

std::optional<HttpRequest> parse_request(std::string_view bytes) {
  Parser parser;
  set_limits(parser);
  parser.eager(true);
  error_code error;
  parser.put(net::buffer(bytes.data(), bytes.size()), error);
  if (error || !parser.is_done()) return std::nullopt;
  return plain(parser.release());
}

}  // namespace fleetmap::monitor
