#include "row_hash.hpp"

namespace fleetmap::store {
namespace {

ContentHash hash_of_both(ByteView first, ByteView second) {
  Bytes all(first.begin(), first.end());
  all.insert(all.end(), second.begin(), second.end());
  return content_hash(all);
}

}  // namespace

ContentHash row_hash(ByteView item, ByteView signature) {
  return signature.empty() ? content_hash(item) : hash_of_both(item, signature);
}

ContentHash value_hash(std::string_view key, ByteView value) {
  // The zero keeps (ab, c) and (a, bc) apart.
  Bytes name(key.begin(), key.end());
  name.push_back(0);
  return hash_of_both(name, value);
}

}  // namespace fleetmap::store
