#include "cloud_exchange.hpp"

#include <utility>

namespace fleetmap::exchange {

CloudExchange::CloudExchange(const CloudTransferConfig& config, const store::Store& store,
                             CloudClient& cloud_client, SendQueue& queue, std::vector<Event>& events)
    : self_(store.self()),
      config_(config),
      store_(store),
      cloud_client_(cloud_client),
      queue_(queue),
      events_(events),
      sender_(self_, config),
      receiver_(self_, config) {}

Status CloudExchange::provide(const NodeId& node, Bytes cloud, Stamp now) {
  const auto needed = needed_.find(node);
  const auto recipients = needed == needed_.end() ? std::map<AgentId, float>() : needed->second.by;
  if (needed != needed_.end()) needed_.erase(needed);
  if (auto status = sender_.offer(node, std::move(cloud), now); !status) return status;
  for (const auto& [recipient, information] : recipients) {
    if (auto fragments = sender_.answer({recipient, self_, node, {}, information}, now))
      send(std::move(*fragments), information);
  }
  return {};
}

void CloudExchange::on_own_alignment(const graph::Alignment& alignment) {
  if (alignment.best().rmse > graph::kGoodRmse || !config_.cancel_when_aligned) return;
  // The peer will stop its requests when it receives this alignment.
  const bool i_is_ours = alignment.i.agent == self_;
  queue_.cancel_cloud(i_is_ours ? alignment.j.agent : alignment.i.agent,
                      i_is_ours ? alignment.i : alignment.j);
}

void CloudExchange::on_fragment(const CloudFragment& fragment, Stamp now) {
  auto cloud = receiver_.add(fragment, now);
  if (cloud) cloud_client_.on_cloud(fragment.node, std::move(*cloud));
}

void CloudExchange::on_request(const CloudRequest& request, Stamp now) {
  if (request.node.agent != self_ || !store_.node(request.node)) {
    ++bad_requests_;
    return;
  }
  cloud_client_.on_cloud_request(request.from, request.node);
  if (auto fragments = sender_.answer(request, now)) return send(std::move(*fragments), request.information);
  const auto [needed, is_new] = needed_.try_emplace(request.node);
  needed->second.by[request.from] = request.information;
  if (!is_new && now - needed->second.notified < config_.first_timeout) return;
  needed->second.notified = now;
  events_.push_back(CloudNeeded{request.node, request.from});
}

void CloudExchange::send(std::vector<CloudFragment> fragments, float information) {
  if (config_.order == CloudOrder::kFirstCome) information = 0.0f;
  for (CloudFragment& fragment : fragments) queue_.push_fragment(std::move(fragment), information);
}

void CloudExchange::tick(bool radio_has_room, Stamp now) {
  auto demand = cloud_client_.tick(now, radio_has_room);
  for (const NodePair& pair : demand.withdrawn) {
    if (!cloud_client_.wants(pair.theirs)) receiver_.cancel(pair.theirs);
    queue_.cancel_cloud(pair.theirs.agent, pair.ours);
  }
  for (ProximityMatch& match : demand.matches) queue_.push(Priority::kControl, std::move(match));
  for (const auto& [node, information] : demand.wanted) {
    if (!receiver_.want(node, now, information)) cloud_client_.on_cloud_lost(node, now);
  }
  auto due = receiver_.tick(now);
  for (CloudRequest& request : due.requests) queue_.push(Priority::kControl, std::move(request));
  for (const NodeId& node : due.abandoned) cloud_client_.on_cloud_lost(node, now);
}

}  // namespace fleetmap::exchange
