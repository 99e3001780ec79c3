#include "fleetmap/monitor/server.hpp"

#include "fleetmap/monitor/request_check.hpp"
#include "http_answer.hpp"
#include "server_state.hpp"
#include "viewer.hpp"

namespace fleetmap::monitor {

Server::Server(std::unique_ptr<State> state) : state_(std::move(state)) {}

Server::~Server() {
  state_->web.stop();
  if (state_->thread.joinable()) state_->thread.join();
}

Result<std::unique_ptr<Server>> Server::start(const ServerConfig& config, LoadSubmap load,
                                              std::span<const PageFile> page) {
  if (const Status valid = config.validate(); !valid) return tl::unexpected(valid.error());
  auto state = std::make_unique<State>(config, std::move(load), page);
  const auto answers = [state = state.get()](const HttpRequest& request) { return answer(*state, request); };
  if (const Status opened = state->web.listen(answers); !opened) return tl::unexpected(opened.error());
  state->cookie = "fleetmap_" + std::to_string(state->web.port());
  State* running = state.get();
  auto server = std::unique_ptr<Server>(new Server(std::move(state)));
  running->thread = std::thread([running] { running->web.run(); });
  return server;
}

std::uint16_t Server::port() const { return state_->web.port(); }

std::string Server::url() const {
  const std::string& address = state_->config.address;
  const std::string host = address.find(':') == std::string::npos ? address : "[" + address + "]";
  const std::string& token = state_->config.token;
  return "http://" + host + ":" + std::to_string(port()) + "/" + (token.empty() ? "" : "?token=" + token);
}

void Server::publish(std::shared_ptr<const FleetView> view) {
  state_->web.post([state = state_.get(), view = std::move(view)] {
    state->content.show(*view);
    state->previews.refresh();
    for (Viewer* viewer : state->viewers) viewer->send(Viewer::kState, state->content.state());
    state->feed.show(view);
  });
}

void Server::publish(std::shared_ptr<const LiveStatus> status) {
  if (!state_->live.put(std::move(status))) return;
  state_->web.post([state = state_.get()] {
    const auto status = state->live.take();
    if (!status) return;
    state->content.show(*status, state->operated());
    for (Viewer* viewer : state->viewers) viewer->send(Viewer::kLive, state->content.live());
    state->feed.show(status);
  });
}

void Server::set_operator(GiveOrder give_order) {
  state_->web.post(
      [state = state_.get(), give_order = std::move(give_order)] { state->give_order = give_order; });
}

ServerStats Server::stats() const {
  const ServerCounters& counters = state_->counters;
  return {counters.requests, counters.refused, counters.cut, counters.viewers};
}

}  // namespace fleetmap::monitor
