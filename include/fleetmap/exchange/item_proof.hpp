#pragma once

#include <cstddef>
#include <cstdint>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/core/signature.hpp"
#include "fleetmap/graph/alignment.hpp"
#include "fleetmap/graph/node.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::exchange {

/// Result of the verification of an item's signature.
enum class ItemProof : std::uint8_t {
  kGenuine,       ///< the robot whose name the item bears made it
  kUnsigned,      ///< nothing
  kWrong,         ///< nothing: it is of another robot, or of another content
  kUnknownMaker,  ///< not verified: no certificate of the maker is available yet
};
inline constexpr std::size_t kItemProofs = 4;
const char* to_string(ItemProof proof);

/// Signs own items and verifies those of others. Items travel through third robots, so that who hands one
/// over proves nothing about who made it.
class ItemAuthenticator {
 public:
  virtual ~ItemAuthenticator() = default;
  /// Names the fleet whose members' signatures count.
  virtual Bytes fleet() const = 0;
  /// Signs an own item; its field `signature` is not part of the signed bytes.
  virtual Signature sign(const graph::Node& node) const = 0;
  virtual Signature sign(const graph::Alignment& alignment) const = 0;
  virtual ItemProof verify(const graph::Node& node) const = 0;
  virtual ItemProof verify(const graph::Alignment& alignment) const = 0;
};

/// Changes that adopt_items() made to a store.
struct AdoptedItems {
  std::size_t signed_own = 0;
  std::size_t dropped = 0;  ///< contents of others
};
/// Converts a store without signatures, or with those of other keys, to this fleet's keys. Own items are
/// signed. Items of others are dropped, since nothing proves who made them; their makers sign them and send
/// them again. A contested own name keeps the own content if its submap is held and no other own node has
/// the same content. In a store that was converted before, only items without a signature are processed.
Result<AdoptedItems> adopt_items(store::Store& store, const ItemAuthenticator& authenticator);

}  // namespace fleetmap::exchange
