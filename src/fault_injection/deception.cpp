#include "deception.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>

namespace fleetmap::fault_injection {
namespace {

constexpr std::uint64_t kDeceptionStream = 9;
constexpr double kLies = 0.3;  ///< share of messages
/// Per second.
constexpr double kInvented = 0.5, kClaims = 0.5, kOfOthers = 0.3, kRequests = 10.0;

}  // namespace

Deception::Deception(std::uint64_t seed, const exchange::ExchangeConfig& config)
    : draws_(seed, kDeceptionStream), config_(&config) {}

bool Deception::lies() { return draws_.chance(kLies); }

bool Deception::invents(Duration step) { return draws_.chance(kInvented * to_seconds(step)); }

Attacker::Injected Deception::request() {
  const AgentId to = anyone();
  std::vector<SeqRange> all;
  for (const AgentId& agent : config_->fleet) all.push_back({agent, 0, kEndOfSeqs});
  return {to, messages::Reach::kLongRange,
          std::make_shared<const messages::Message>(messages::ItemRequest{anyone(), to, all, all})};
}

std::vector<Attacker::Injected> Deception::to_all_others(const AgentId& self,
                                                         const messages::Message& message) const {
  std::vector<Attacker::Injected> all;
  const auto shared = std::make_shared<const messages::Message>(message);
  for (const AgentId& to : config_->fleet)
    if (to != self) all.push_back({to, messages::Reach::kLongRange, shared});
  return all;
}

std::vector<Attacker::Injected> Deception::messages_of(CompromisedRobot& robot, const store::Store& store,
                                                       const SyntheticSurvey& survey, Attacker& attacker,
                                                       Duration step) {
  std::vector<Attacker::Injected> sent;
  if (draws_.chance(kRequests * to_seconds(step))) sent.push_back(request());
  if (draws_.chance(kClaims * to_seconds(step)))
    if (auto claim = attacker.forged_claim()) sent.push_back(std::move(*claim));
  if (!draws_.chance(kOfOthers * to_seconds(step))) return sent;
  auto alignment = robot.of_others(store, survey);
  if (!alignment) return sent;
  if (config_->authenticator) alignment->signature = config_->authenticator->sign(*alignment);
  auto all = to_all_others(robot.self(), *alignment);
  std::ranges::move(all, std::back_inserter(sent));
  return sent;
}

}  // namespace fleetmap::fault_injection
