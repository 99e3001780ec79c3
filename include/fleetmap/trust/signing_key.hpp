#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/core/signature.hpp"

struct evp_pkey_st;  // OpenSSL's key

namespace fleetmap::trust {

using PublicKey = std::array<std::uint8_t, 32>;  ///< Ed25519

using fleetmap::Signature;

/// An Ed25519 private key.
class SigningKey {
 public:
  static SigningKey generate();
  static Result<SigningKey> from_pem(const std::string& pem);
  std::string to_pem() const;
  PublicKey public_key() const;
  Signature sign(ByteView message) const;
  evp_pkey_st* handle() const { return key_.get(); }

 private:
  explicit SigningKey(std::shared_ptr<evp_pkey_st> key) : key_(std::move(key)) {}
  std::shared_ptr<evp_pkey_st> key_;
};

bool verify(const PublicKey& key, ByteView message, const Signature& signature);

}  // namespace fleetmap::trust
