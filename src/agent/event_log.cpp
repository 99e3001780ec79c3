#include "event_log.hpp"

#include <spdlog/spdlog.h>

#include <optional>
#include <string>
#include <variant>

namespace fleetmap::agent {
namespace {

const char* item(bool alignment) { return alignment ? "alignment" : "node"; }

std::string handed_over(messages::Reach link, const std::optional<AgentId>& from) {
  const std::string over = link == messages::Reach::kLongRange ? "over the radio" : "over the Wi-Fi";
  return from ? over + " from " + from->str() : over;
}

const char* misbehaviour(exchange::SenderMisbehaved::Kind kind) {
  using Kind = exchange::SenderMisbehaved::Kind;
  switch (kind) {
    case Kind::kForeignName:
      return "a message of another robot";
    case Kind::kDigest:
      return "a digest or a request that contradicts the rules";
    case Kind::kCloud:
      return "a piece of a cloud that contradicts the others or their hash";
    case Kind::kSubmap:
      return "a submap digest or chunk that contradicts the rules, its node or its hash";
  }
  return "";
}

struct Log {
  const AgentId& self;

  void operator()(const exchange::PeerStatus& status) const {
    spdlog::debug("{}: {} holds {} nodes, {} submaps", self.str(), status.status.from.str(),
                  status.status.nodes, status.status.submaps);
  }
  void operator()(const exchange::AlignmentAdded& added) const {
    spdlog::debug("{}: alignment {}/{} added", self.str(), added.id.computed_by.str(), added.id.seq);
  }
  void operator()(const exchange::MapComplete& complete) const {
    spdlog::debug("{}: caught up with the fleet: {} nodes, {} alignments", self.str(), complete.nodes,
                  complete.alignments);
  }
  void operator()(const exchange::ItemConflict& conflict) const {
    const bool own = conflict.id.agent == self;
    const std::string maker = conflict.id.agent.str();
    const std::string why =
        conflict.signed_twice
            ? maker +
                  " signed both: its keys are on a second machine, as after a copy of its disk, or its "
                  "program was changed; if nobody knows of a second one, revoke " +
                  maker
            : "a robot bears the id of another one, or an item is forged";
    spdlog::error("{}: another {} came {} under the name {}, which counts no more{}: {}", self.str(),
                  item(conflict.alignment), handed_over(conflict.link, conflict.from), to_string(conflict.id),
                  own ? "; the own one is told under another name" : "", why);
  }
  void operator()(const exchange::ItemRefused& refused) const {
    if (refused.proof == exchange::ItemProof::kUnknownMaker) {
      return spdlog::warn(
          "{}: {} {} came {} and is refused until the certificate of {} comes with a greeting, or "
          "with a new copy of this robot's folder of keys",
          self.str(), item(refused.alignment), to_string(refused.id), handed_over(refused.link, refused.from),
          refused.id.agent.str());
    }
    spdlog::error(
        "{}: {} {} came {} and is refused: {}; the robot that handed it over is compromised, damages "
        "what it stores, or has no keys yet (others of that kind are counted in report.json)",
        self.str(), item(refused.alignment), to_string(refused.id), handed_over(refused.link, refused.from),
        to_string(refused.proof));
  }
  void operator()(const exchange::ItemsAdopted& adopted) const {
    spdlog::warn(
        "{}: the store is of a time without keys, or of other keys: {} own items are signed now, {} "
        "contents without a signature that counts were dropped and are fetched again once their makers "
        "have signed them",
        self.str(), adopted.items.signed_own, adopted.items.dropped);
  }
  void operator()(const exchange::OfferUndelivered& offer) const {
    spdlog::warn(
        "{}: {} offers {} nodes and {} alignments and does not deliver them: its link works one way, or its "
        "digests are "
        "forged; they are not waited for until one comes",
        self.str(), offer.peer.str(), offer.nodes, offer.alignments);
  }
  void operator()(const exchange::OwnItemsElsewhere& found) const {
    spdlog::warn(
        "{}: {} holds {} nodes and {} alignments of this robot that its own store lacks: the store was lost, "
        "restored or replaced (they are fetched, and new ones bear other numbers), or another robot bears "
        "this name",
        self.str(), found.peer.str(), found.nodes, found.alignments);
  }
  void operator()(const exchange::SenderMisbehaved& report) const {
    const std::string sender = report.from.value_or(report.name).str();
    const std::string under = report.from == report.name ? "" : " under the name " + report.name.str();
    spdlog::error(
        "{}: {} sent {}{}: it is compromised, holds forged items, or damages what it stores{} (its messages "
        "of that kind are counted in "
        "report.json)",
        self.str(), report.from ? sender : "an unknown robot", misbehaviour(report.kind), under,
        report.from ? "" : ", or the message is forged");
  }
  void operator()(const exchange::StrangerHeard& stranger) const {
    spdlog::warn(
        "{}: heard {}, which is not of this fleet; if it should be, name it in `fleet` of every robot's file",
        self.str(), stranger.name.str());
  }
  void operator()(const exchange::RowsOrdered& ordered) const {
    for (const messages::RowOrder& order : ordered.orders) {
      spdlog::info("{}: row {} is given by {} to {} by order of {}", self.str(), order.row, order.robot.str(),
                   order.to.empty() ? "another robot" : order.to.str(), order.issuer.str());
    }
  }
  template <class Other>
  void operator()(const Other&) const {}  // logged by its handler, or of no interest
};

}  // namespace

void log_event(const AgentId& self, const exchange::Event& event) { std::visit(Log{self}, event); }

}  // namespace fleetmap::agent
