#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "fleetmap/core/time.hpp"
#include "fleetmap/messages/messages.hpp"

namespace fleetmap::exchange {

using messages::AgentStatus;
using messages::Loan;

/// What one robot may send of the budget that all robots of the fleet share, by need and without a master.
///
/// The budget is divided evenly among the robots that are heard. Who has little to send lends most of its
/// part to those whose messages wait, and says so in its status. A loan ends when the lender's status no
/// longer names it, or some status periods after it was last named; the lender counts on the latter, so the
/// rates of robots that hear each other do not add up to more than the budget, whatever is lost. Only when
/// robots come back whose parts were given to others may it be a tenth more, until loans of larger parts have
/// ended.
class BudgetShares {
 public:
  /// `status_period`: how often each robot tells its status.
  BudgetShares(const AgentId& self, std::span<const AgentId> fleet, double fleet_bytes_per_second,
               Duration status_period, Stamp now);

  void on_heard(const AgentId& peer, Stamp now);
  /// A status of another robot of the fleet.
  void on_status(const AgentStatus& status, Stamp now);
  /// Loans for the own status of `now`, where `backlog` (B) waits and `sent` (B) went since the status
  /// before.
  std::vector<Loan> lend(std::size_t backlog, std::size_t sent, Stamp now);

  /// B/s
  double rate(Stamp now) const;
  /// Neither `backlog` (B, the own) nor what the other robots told last of theirs takes a robot's part longer
  /// than a second to send.
  bool has_room(std::size_t backlog, Stamp now) const;
  /// The other robots that are there, as far as this one knows: they were heard of late, or this robot has
  /// not listened for long enough to say that they are gone.
  std::set<AgentId> present(Stamp now) const;

 private:
  struct Borrowed {
    double bytes_per_second = 0.0;
    Stamp until;
  };
  struct Peer {
    Stamp heard;
    std::size_t backlog = 0;  ///< B, as of its last status
    Stamp told;               ///< when that came
    Borrowed loan;            ///< of the peer to us
  };
  struct Given {
    std::vector<Loan> loans;
    Stamp until;  ///< borrowers may use them so long
  };
  double part(Stamp now) const;
  /// B/s that each borrower may be using, whichever of our statuses it has heard.
  std::map<AgentId, double> lent(Stamp now) const;

  AgentId self_;
  double budget_;
  Duration period_;
  std::map<AgentId, Peer> peers_;
  std::vector<Given> given_;
};

}  // namespace fleetmap::exchange
