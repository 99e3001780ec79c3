#include "subscriptions.hpp"

#include <algorithm>

namespace fleetmap::monitor::foxglove {
namespace {

/// Keeps the first problem; the others are counted by the caller.
struct Problems {
  std::string first;
  std::size_t count = 0;

  void add(std::string problem) {
    if (problem.empty()) return;
    if (count++ == 0) first = std::move(problem);
  }
  std::string text() const {
    return count < 2 ? first : first + "; " + std::to_string(count - 1) + " more of this request failed";
  }
};

}  // namespace

std::string Subscriptions::apply(const ClientRequest& request, std::span<const Channel> channels) {
  Problems problems;
  if (const auto* wanted = std::get_if<Subscribe>(&request)) {
    for (const Subscription& one : wanted->subscriptions) problems.add(subscribe(one, channels));
  } else if (const auto* unwanted = std::get_if<Unsubscribe>(&request)) {
    for (const std::uint32_t id : unwanted->ids) problems.add(unsubscribe(id));
  } else {
    problems.add("operation \"" + std::get<NotOffered>(request).operation +
                 "\" is not offered here: channels can only be subscribed to");
  }
  return problems.text();
}

std::string Subscriptions::subscribe(const Subscription& wanted, std::span<const Channel> channels) {
  if (wanted.channel == 0 || wanted.channel > channels.size())
    return "channel " + std::to_string(wanted.channel) + " does not exist";
  const auto in_use =
      std::ranges::find(by_channel_, wanted.id, [](const auto& one) { return one.second.id; });
  if (in_use != by_channel_.end())
    return "subscription " + std::to_string(wanted.id) + " exists already, to channel " +
           std::to_string(in_use->first);
  if (!by_channel_.try_emplace(wanted.channel, Entry{wanted.id, 0}).second)
    return "channel " + std::to_string(wanted.channel) + " is subscribed to already";
  return {};
}

std::string Subscriptions::unsubscribe(std::uint32_t id) {
  const auto erased = std::erase_if(by_channel_, [&](const auto& one) { return one.second.id == id; });
  return erased > 0 ? std::string() : "subscription " + std::to_string(id) + " does not exist";
}

std::optional<Subscription> Subscriptions::next_due(std::span<const Channel> channels) {
  auto at = by_channel_.upper_bound(last_);
  for (std::size_t k = 0; k < by_channel_.size(); ++k, ++at) {
    if (at == by_channel_.end()) at = by_channel_.begin();
    auto& [channel, entry] = *at;
    const std::uint64_t revision = channels[channel - 1].revision;
    if (revision <= entry.sent_revision) continue;
    entry.sent_revision = revision;
    last_ = channel;
    return Subscription{entry.id, channel};
  }
  return std::nullopt;
}

}  // namespace fleetmap::monitor::foxglove
