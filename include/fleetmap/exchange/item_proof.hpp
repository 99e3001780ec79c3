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

/// What the signature of an item proves.
enum class ItemProof : std::uint8_t {
  kGenuine,       ///< the robot whose name the item bears made it
  kUnsigned,      ///< nothing
  kWrong,         ///< nothing: it is of another robot, or of another content
  kUnknownMaker,  ///< nothing yet: no certificate of the maker is known
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
  /// Of an own item; what its `signature` holds is not signed.
  virtual Signature sign(const graph::Node& node) const = 0;
  virtual Signature sign(const graph::Alignment& alignment) const = 0;
  virtual ItemProof verify(const graph::Node& node) const = 0;
  virtual ItemProof verify(const graph::Alignment& alignment) const = 0;
};

/// What adopt_items() did to a store.
struct AdoptedItems {
  std::size_t signed_own = 0;
  std::size_t dropped = 0;  ///< contents of others
};
/// Makes a store of a time without keys, or of other keys, into one of this fleet: own items are signed, and
/// those of others are dropped, since nothing proves who made them; their makers sign them, and they come
/// again. An own name that was contested keeps the own content if its submap is held and no other own node
/// stands for it. In a store that was adopted before, only items without a signature are looked at.
Result<AdoptedItems> adopt_items(store::Store& store, const ItemAuthenticator& authenticator);

}  // namespace fleetmap::exchange
