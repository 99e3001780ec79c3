#include "virtual_page.hpp"

#include <utility>

#include "report/report.hpp"

namespace fleetmap::apps {
namespace {

constexpr std::size_t kMaxOrders = 64;  // that wait for the fleet's thread

}  // namespace

void VirtualPage::show(const Shown& robot) {
  const auto post = [this, generation = generation_](std::function<void()> work) {
    const std::lock_guard lock(mutex_);
    if (orders_.size() >= kMaxOrders) return false;
    orders_.push_back({generation, std::move(work)});
    return true;
  };
  // Nobody else is on simulated radios.
  publisher_.emplace(*robot.agent, *robot.bus, server_, who_may_join(true), post);
}

void VirtualPage::forget_agents() {
  publisher_.reset();
  last_heard_.clear();
  ++generation_;
}

void VirtualPage::carry_out_orders() {
  std::vector<Order> orders;
  {
    const std::lock_guard lock(mutex_);
    orders.swap(orders_);
  }
  for (const Order& order : orders)
    if (order.generation == generation_) order.carry_out();
}

std::vector<bus::HeardTraffic> VirtualPage::take_heard(const AgentId& robot) {
  std::vector<bus::HeardTraffic> all;
  for (const bus::HeardCopies& heard : network_.take_heard(robot)) {
    bus::HeardTraffic traffic{heard.link,  heard.from, heard.messages, 0,
                              heard.bytes, heard.lost, heard.messages};
    if (heard.messages > 0) {
      traffic.delay = heard.delay / static_cast<std::int64_t>(heard.messages);
      last_heard_[{heard.link, heard.from}] = {network_.now(), false};
    }
    all.push_back(std::move(traffic));
  }
  return all;
}

void VirtualPage::update(const std::vector<Shown>& fleet) {
  carry_out_orders();
  if (fleet.empty()) return;
  if (!publisher_) show(fleet.front());
  std::vector<const agent::Agent*> others;
  for (std::size_t k = 1; k < fleet.size(); ++k) others.push_back(fleet[k].agent);
  publisher_->publish(take_heard(fleet.front().agent->config().id), last_heard_, others);
}

}  // namespace fleetmap::apps
