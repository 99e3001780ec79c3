#pragma once

#include <vector>

#include "store_state.hpp"

namespace fleetmap::store {

/// Submaps and the chunks of downloads on disk; the functions are those of Store.
Result<Put> put_submap(StoreState& s, const NodeId& id, ByteView encoded);
Result<Put> put_submap_chunk(StoreState& s, const NodeId& id, std::uint32_t chunk, ByteView bytes);
Result<Put> finish_download(StoreState& s, const NodeId& id);
Result<Bytes> contested_submap(const StoreState& s, const NodeId& id);
Result<Bytes> submap(StoreState& s, const NodeId& id);
Result<Bytes> submap_part(const StoreState& s, const NodeId& id, std::uint32_t offset, std::uint32_t length);
std::vector<std::uint32_t> missing_chunks(const StoreState& s, const NodeId& id);

}  // namespace fleetmap::store
