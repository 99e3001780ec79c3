#include "fleetmap/monitor/server.hpp"

#include <boost/asio/post.hpp>

#include "connection.hpp"
#include "fleetmap/monitor/request_check.hpp"
#include "server_state.hpp"
#include "viewer.hpp"

namespace fleetmap::monitor {

void ServerState::accept() {
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

void ServerState::run() {
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
    state->previews.refresh();
    for (Viewer* viewer : state->viewers) viewer->send(Viewer::kState, state->content.state());
    state->feed.show(view);
  });
}

void Server::publish(std::shared_ptr<const LiveStatus> status) {
  if (!state_->live.put(std::move(status))) return;
  net::post(state_->io, [state = state_.get()] {
    const auto status = state->live.take();
    if (!status) return;
    state->content.show(*status, state->operated());
    for (Viewer* viewer : state->viewers) viewer->send(Viewer::kLive, state->content.live());
    state->feed.show(status);
  });
}

void Server::set_operator(GiveOrder give_order) {
  net::post(state_->io, [state = state_.get(), give_order = std::move(give_order)]() mutable {
    state->give_order = std::move(give_order);
  });
}

ServerStats Server::stats() const {
  return {state_->requests, state_->refused, state_->cut, state_->viewers_now};
}

}  // namespace fleetmap::monitor
