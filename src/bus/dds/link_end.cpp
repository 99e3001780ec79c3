#include "link_end.hpp"

#include <optional>
#include <stdexcept>
#include <utility>

namespace fleetmap::bus {

LinkEnd::LinkEnd(Link link, const DdsLinkConfig& config, std::shared_ptr<Executor> executor)
    : link_(link), config_(config), executor_(std::move(executor)) {}

void LinkEnd::forget_topics() {
  const std::scoped_lock lock(mutex_);
  topics_.clear();
}

LinkEnd::Entry& LinkEnd::entry_of(const Topic& topic) {
  const auto known = topics_.find(topic.name);
  if (known != topics_.end()) {
    const Topic& other = known->second.topic;
    if (other.type == topic.type && other.profile == topic.profile) return known->second;
    throw std::logic_error("topic " + topic.name + " is used with two types or profiles");
  }
  Entry entry;
  entry.topic = topic;
  entry.inbox = std::make_shared<Inbox>(config_.queue_messages, config_.queue_bytes);
  entry.end = make(topic, entry.inbox);
  return topics_.emplace(topic.name, std::move(entry)).first->second;
}

Work LinkEnd::dispatcher(const std::string& topic) {
  return {"topic " + topic, [link = weak_from_this(), topic] {
            if (const auto alive = link.lock()) alive->dispatch(topic);
          }};
}

void LinkEnd::advertise(const Topic& topic) {
  const std::scoped_lock lock(mutex_);
  entry_of(topic).end->open_writer();
}

void LinkEnd::publish(const Topic& topic, const Bytes& cdr) {
  const std::scoped_lock lock(mutex_);
  Entry& entry = entry_of(topic);
  entry.end->open_writer();
  ++entry.sent_messages;
  entry.sent_bytes += cdr.size();
  entry.refused += !entry.end->write(cdr);
}

Handle LinkEnd::subscribe(const Topic& topic, Bus::OnMessage on_message) {
  auto subscription = std::make_shared<Subscription>(Subscription{std::move(on_message)});
  const std::scoped_lock lock(mutex_);
  Entry& entry = entry_of(topic);
  entry.subscriptions.push_back(subscription);
  entry.end->open_reader();
  return Handle([link = weak_from_this(), name = topic.name, subscription] {
    subscription->active = false;
    if (const auto alive = link.lock()) alive->cancel(name, subscription);
  });
}

void LinkEnd::cancel(const std::string& topic, const std::shared_ptr<Subscription>& subscription) {
  const std::scoped_lock lock(mutex_);
  Entry& entry = topics_.at(topic);
  std::erase(entry.subscriptions, subscription);
  if (entry.subscriptions.empty()) entry.end->close_reader();
}

void LinkEnd::dispatch(const std::string& topic) {
  std::vector<std::shared_ptr<Subscription>> subscriptions;
  std::optional<Inbox::Message> message;
  {
    const std::scoped_lock lock(mutex_);
    const Entry& entry = topics_.at(topic);
    subscriptions = entry.subscriptions;  // a callback may subscribe or cancel
    message = entry.inbox->take();
    if (message) sender_ = robot_of(message->sender);
  }
  if (!message) return;
  for (const auto& subscription : subscriptions) {
    if (subscription->active) subscription->on_message(message->cdr);
  }
  sender_.reset();
}

DdsBus::Matches LinkEnd::matches(const Topic& topic) const {
  const std::scoped_lock lock(mutex_);
  const auto entry = topics_.find(topic.name);
  return entry == topics_.end() ? DdsBus::Matches{} : entry->second.end->matches();
}

void LinkEnd::add_stats(std::vector<TopicStats>& all) const {
  const std::scoped_lock lock(mutex_);
  for (const auto& [name, entry] : topics_) {
    TopicStats stats;
    stats.topic = name;
    stats.link = link_;
    stats.sent_messages = entry.sent_messages;
    stats.sent_bytes = entry.sent_bytes;
    stats.dropped_messages = entry.refused;
    entry.inbox->add_to(stats);
    all.push_back(std::move(stats));
  }
}

}  // namespace fleetmap::bus
