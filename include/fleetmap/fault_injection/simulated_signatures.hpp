#pragma once

#include <cstdint>

#include "fleetmap/exchange/item_proof.hpp"

namespace fleetmap::fault_injection {

/// Signatures of a simulated fleet, one object for all its robots: a keyed hash instead of Ed25519, which
/// takes a hundredth of the time and distinguishes the same items as long as no attacker calls sign().
class SimulatedSignatures final : public exchange::ItemAuthenticator {
 public:
  explicit SimulatedSignatures(std::uint64_t secret) : secret_(secret) {}

  Bytes fleet() const override;
  Signature sign(const graph::Node& node) const override;
  Signature sign(const graph::Alignment& alignment) const override;
  exchange::ItemProof verify(const graph::Node& node) const override;
  exchange::ItemProof verify(const graph::Alignment& alignment) const override;

 private:
  std::uint64_t secret_;
};

}  // namespace fleetmap::fault_injection
