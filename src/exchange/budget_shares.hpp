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

/// Share of one robot of the budget that all robots of the fleet have together, by need and without a
/// master.
///
/// The budget is divided evenly among the robots that are heard. A robot with a small backlog lends most of
/// its part to those whose messages wait, and announces that in its status. A loan ends when the lender's
/// status no longer names it, or some status periods after it was last named; the lender assumes the latter,
/// so the rates of robots that hear each other never add up to more than the budget, whichever messages are
/// lost. Only when robots return whose parts were lent to others may the sum be a tenth more, until the
/// loans of larger parts have ended.
///
/// Parts of a fleet that do not hear each other divide the whole budget each. A robot that is heard again
/// announces that a part returns: all robots count as present from then on until they had time to be heard,
/// so the sum exceeds the budget only until one message of the other part has arrived.
class BudgetShares {
 public:
  /// `status_period`: period of each robot's status messages.
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
  /// True if no backlog, own (`backlog`, B) or reported by another robot, takes a robot's part longer than a
  /// second to send.
  bool has_room(std::size_t backlog, Stamp now) const;
  /// The other robots that are present: heard within the timeout, or not yet silent for that long since the
  /// start.
  std::set<AgentId> present(Stamp now) const;

 private:
  struct Borrowed {
    double bytes_per_second = 0.0;
    Stamp until;
  };
  struct Peer {
    Stamp heard;
    std::size_t backlog = 0;  ///< B, as of its last status
    Stamp status_received;    ///< when its last status arrived
    Borrowed loan;            ///< of the peer to us
  };
  struct Grant {
    std::vector<Loan> loans;
    Stamp until;  ///< borrowers may use them so long
  };
  double part(Stamp now) const;
  bool is_present(const Peer& peer, Stamp now) const;
  /// B/s that each borrower may be using, whichever of our statuses it has heard.
  std::map<AgentId, double> lent(Stamp now) const;

  AgentId self_;
  double budget_;
  Duration period_;
  std::map<AgentId, Peer> peers_;
  std::vector<Grant> grants_;
  Stamp all_return_until_;  ///< until then the parts are those of the whole fleet
};

}  // namespace fleetmap::exchange
