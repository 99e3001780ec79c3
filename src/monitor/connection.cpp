#include "connection.hpp"

#include "foxglove/client_session.hpp"
#include "http_answer.hpp"
#include "viewer.hpp"

namespace fleetmap::monitor {
namespace {

Response failed(http::status status, const char* text) {
  Response response(status, 11);
  response.body() = text;
  response.keep_alive(false);
  response.prepare_payload();
  return response;
}

}  // namespace

void Connection::read() {
  parser_.emplace();
  parser_->header_limit(kMaxHeaderBytes);
  parser_->body_limit(0);
  stream_.expires_after(state_.config.request_timeout);
  http::async_read(stream_, buffer_, *parser_,
                   [self = shared_from_this()](error_code error, std::size_t) { self->on_request(error); });
}

void Connection::on_request(error_code error) {
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
  Response response = answer(state_, request);
  if (response.result() == http::status::switching_protocols) return open(request, response);
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

void Connection::open(const Request& request, const Response& response) {
  const auto granted = response[http::field::sec_websocket_protocol];
  const std::string subprotocol(granted.data(), granted.size());
  if (subprotocol.empty())
    return std::make_shared<Viewer>(state_, std::move(stream_), counted_)->run(request);
  std::make_shared<foxglove::ClientSession>(state_, std::move(stream_), counted_)->run(request, subprotocol);
}

void Connection::write(Response response) {
  response_ = std::move(response);
  stream_.expires_after(state_.config.answer_timeout);
  http::async_write(stream_, response_, [self = shared_from_this()](error_code error, std::size_t) {
    if (error == beast::error::timeout) ++self->state_.cut;
    if (error) return;
    if (!self->response_.keep_alive()) return self->close();
    self->read();
  });
}

void Connection::close() {
  error_code ignored;
  stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
}

}  // namespace fleetmap::monitor
