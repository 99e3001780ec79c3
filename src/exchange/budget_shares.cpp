#include "budget_shares.hpp"

#include <algorithm>
#include <limits>

namespace fleetmap::exchange {
namespace {

constexpr std::size_t kMaxLoans = 4;  // in one status
/// Share of its own part that a lender always keeps, since a borrower stops only after a delay.
constexpr double kKept = 0.4;
/// A lender keeps so much more than it used of late.
constexpr double kMargin = 1.5;
/// s of a part: a backlog below the first is none, above the second others may help.
constexpr double kSmallBacklog = 1.0, kLargeBacklog = 2.0;
/// Status periods: one lost status ends no loan.
constexpr double kLoanPeriods = 2.5;
/// A status may wait in the lender's queue for so long, or for one more period.
constexpr Duration kMaxDelay = std::chrono::seconds(10);
/// Longest status period with loans. With longer ones (more than eight robots without multicast) a lender
/// would wait for a minute and more until its part is free again: ten busy robots then got 0.8 of the
/// budget.
constexpr Duration kMaxPeriod = std::chrono::seconds(15);
/// Silence after which a robot's part goes to the others, at least and in status periods.
constexpr Duration kPeerTimeout = std::chrono::seconds(60);
constexpr double kPeerTimeoutPeriods = 3.0;
/// Status periods after a robot's return in which all others are expected back: two of their statuses may be
/// lost.
constexpr double kReturnPeriods = 3.0;

Duration times(Duration period, double factor) { return from_seconds(to_seconds(period) * factor); }

}  // namespace

BudgetShares::BudgetShares(const AgentId& self, std::span<const AgentId> fleet, double fleet_bytes_per_second,
                           Duration status_period, Stamp now)
    : self_(self), budget_(fleet_bytes_per_second), period_(status_period) {
  for (const AgentId& agent : fleet) {
    if (agent != self) peers_[agent].heard = now;
  }
}

void BudgetShares::on_heard(const AgentId& peer, Stamp now) {
  const auto known = peers_.find(peer);
  if (known == peers_.end()) return;
  if (!is_present(known->second, now)) all_return_until_ = now + times(period_, kReturnPeriods);
  known->second.heard = now;
}

bool BudgetShares::is_present(const Peer& peer, Stamp now) const {
  return now - peer.heard < std::max(kPeerTimeout, times(period_, kPeerTimeoutPeriods));
}

void BudgetShares::on_status(const AgentStatus& status, Stamp now) {
  const auto known = peers_.find(status.from);
  if (known == peers_.end()) return;
  Peer& peer = known->second;
  peer.backlog = status.backlog_bytes;
  peer.status_received = now;
  peer.loan = {};
  for (const Loan& loan : status.loans) {
    if (loan.borrower != self_) continue;
    // No robot has more to lend than the even part of the smallest fleet.
    peer.loan = {std::min<double>(loan.bytes_per_second, budget_ / 2.0), now + times(period_, kLoanPeriods)};
  }
}

std::set<AgentId> BudgetShares::present(Stamp now) const {
  std::set<AgentId> present;
  for (const auto& [agent, peer] : peers_) {
    if (is_present(peer, now)) present.insert(agent);
  }
  return present;
}

double BudgetShares::part(Stamp now) const {
  const std::size_t others = now < all_return_until_ ? peers_.size() : present(now).size();
  return budget_ / static_cast<double>(others + 1);
}

bool BudgetShares::has_room(std::size_t backlog, Stamp now) const {
  const double small = kSmallBacklog * part(now);
  return static_cast<double>(backlog) <= small &&
         std::ranges::all_of(present(now), [&](const AgentId& agent) {
           return static_cast<double>(peers_.at(agent).backlog) <= small;
         });
}

std::map<AgentId, double> BudgetShares::lent(Stamp now) const {
  std::map<AgentId, double> lent;
  for (const Grant& grant : grants_) {
    if (now >= grant.until) continue;
    for (const Loan& loan : grant.loans) {
      double& max_rate = lent[loan.borrower];
      max_rate = std::max<double>(max_rate, loan.bytes_per_second);
    }
  }
  return lent;
}

double BudgetShares::rate(Stamp now) const {
  const double own = part(now);
  double rate = own;
  for (const auto& [borrower, bytes_per_second] : lent(now)) rate -= bytes_per_second;
  // When a robot returns, all parts become smaller than they were when the loans were granted.
  rate = std::max(rate, 0.1 * own);
  for (const auto& [agent, peer] : peers_) {
    if (now < peer.loan.until) rate += std::min(peer.loan.bytes_per_second, own);
  }
  return std::min(rate, budget_);
}

std::vector<Loan> BudgetShares::lend(std::size_t backlog, std::size_t sent, Stamp now) {
  std::erase_if(grants_, [now](const Grant& grant) { return now >= grant.until; });
  const double own = part(now);
  if (period_ > kMaxPeriod || static_cast<double>(backlog) > kSmallBacklog * own) return {};
  std::vector<std::pair<double, AgentId>> needy;
  for (const AgentId& agent : present(now)) {
    const Peer& peer = peers_.at(agent);
    const auto waiting = static_cast<double>(peer.backlog);
    if (waiting > kLargeBacklog * own && now - peer.status_received < times(period_, kLoanPeriods))
      needy.emplace_back(waiting, agent);
  }
  std::ranges::sort(needy, std::greater<>());
  needy.resize(std::min(needy.size(), kMaxLoans));
  if (needy.empty()) return {};
  double all_waiting = 0.0;
  for (const auto& [waiting, agent] : needy) all_waiting += waiting;

  // Bytes that borrowers may still be using are not free until their loans end.
  std::map<AgentId, double> before = lent(now);
  const double kept = std::max(kKept * own, kMargin * static_cast<double>(sent) / to_seconds(period_));
  const double lendable = std::max(own - kept, 0.0);
  double free = lendable, wanted = 0.0;
  for (const auto& [agent, bytes_per_second] : before) free -= bytes_per_second;
  const auto more = [&](double waiting, const AgentId& agent) {
    return std::max(lendable * waiting / all_waiting - before[agent], 0.0);
  };
  for (const auto& [waiting, agent] : needy) wanted += more(waiting, agent);
  const double granted = wanted > 0.0 ? std::clamp(free / wanted, 0.0, 1.0) : 0.0;
  std::vector<Loan> loans;
  for (const auto& [waiting, agent] : needy) {
    const double even = lendable * waiting / all_waiting;
    const double loan = std::min(even, before[agent] + granted * more(waiting, agent));
    constexpr double kMax = std::numeric_limits<std::uint16_t>::max();
    if (loan >= 1.0) loans.push_back({agent, static_cast<std::uint16_t>(std::min(loan, kMax))});
  }
  const Duration delay = std::max(kMaxDelay, period_);
  grants_.push_back({loans, now + times(period_, kLoanPeriods) + delay});
  return loans;
}

}  // namespace fleetmap::exchange
