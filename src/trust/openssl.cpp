#include "openssl.hpp"

#include <openssl/rand.h>

#include <stdexcept>
#include <string>

namespace fleetmap::trust {

void require(bool good, const char* what) {
  if (!good) throw std::runtime_error(std::string("OpenSSL: ") + what + " failed");
}

void fill_random(std::span<std::uint8_t> bytes) {
  require(RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) == 1, "random numbers");
}

KeyHandle public_key_handle(std::span<const std::uint8_t, 32> key) {
  return KeyHandle(EVP_PKEY_new_raw_public_key(EVP_PKEY_ED25519, nullptr, key.data(), key.size()));
}

}  // namespace fleetmap::trust
