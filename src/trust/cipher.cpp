#include "fleetmap/trust/cipher.hpp"

#include <openssl/core_names.h>
#include <openssl/kdf.h>

#include <algorithm>

#include "joined.hpp"
#include "openssl.hpp"

namespace fleetmap::trust {
namespace {

constexpr std::size_t kNonceBytes = 12;

std::array<std::uint8_t, kNonceBytes> nonce_of(std::uint64_t counter) {
  std::array<std::uint8_t, kNonceBytes> nonce{};
  for (std::size_t k = 0; k < sizeof(counter); ++k)
    nonce[kNonceBytes - 1 - k] = static_cast<std::uint8_t>(counter >> (8 * k));
  return nonce;
}

}  // namespace

struct Cipher::State {
  CipherHandle sealing{EVP_CIPHER_CTX_new()}, opening{EVP_CIPHER_CTX_new()};
};

Cipher::Cipher(const SecretKey& key) : state_(std::make_unique<State>()) {
  require(state_->sealing && state_->opening &&
              EVP_EncryptInit_ex(state_->sealing.get(), EVP_chacha20_poly1305(), nullptr, key.data(),
                                 nullptr) == 1 &&
              EVP_DecryptInit_ex(state_->opening.get(), EVP_chacha20_poly1305(), nullptr, key.data(),
                                 nullptr) == 1,
          "a cipher");
}
Cipher::~Cipher() = default;
Cipher::Cipher(Cipher&&) noexcept = default;
Cipher& Cipher::operator=(Cipher&&) noexcept = default;

void Cipher::seal(std::uint64_t counter, Bytes& header, ByteView message) {
  EVP_CIPHER_CTX* context = state_->sealing.get();
  const auto nonce = nonce_of(counter);
  const std::size_t begin = header.size();
  header.resize(begin + message.size() + kTagBytes);
  std::uint8_t* out = header.data() + begin;
  int size = 0;
  require(EVP_EncryptInit_ex(context, nullptr, nullptr, nullptr, nonce.data()) == 1 &&
              EVP_EncryptUpdate(context, nullptr, &size, header.data(), static_cast<int>(begin)) == 1 &&
              EVP_EncryptUpdate(context, out, &size, message.data(), static_cast<int>(message.size())) == 1 &&
              EVP_EncryptFinal_ex(context, out + size, &size) == 1 &&
              EVP_CIPHER_CTX_ctrl(context, EVP_CTRL_AEAD_GET_TAG, kTagBytes, out + message.size()) == 1,
          "sealing");
}

std::optional<Bytes> Cipher::open(std::uint64_t counter, ByteView header, ByteView sealed) {
  if (sealed.size() < kTagBytes) return std::nullopt;
  EVP_CIPHER_CTX* context = state_->opening.get();
  const auto nonce = nonce_of(counter);
  const ByteView text = sealed.first(sealed.size() - kTagBytes);
  std::array<std::uint8_t, kTagBytes> tag{};
  std::ranges::copy(sealed.last(kTagBytes), tag.begin());
  Bytes message(text.size());
  std::uint8_t none = 0;
  std::uint8_t* out = message.empty() ? &none : message.data();
  int size = 0;
  const bool good =
      EVP_DecryptInit_ex(context, nullptr, nullptr, nullptr, nonce.data()) == 1 &&
      EVP_DecryptUpdate(context, nullptr, &size, header.data(), static_cast<int>(header.size())) == 1 &&
      EVP_DecryptUpdate(context, out, &size, text.data(), static_cast<int>(text.size())) == 1 &&
      EVP_CIPHER_CTX_ctrl(context, EVP_CTRL_AEAD_SET_TAG, kTagBytes, tag.data()) == 1 &&
      EVP_DecryptFinal_ex(context, out + size, &size) == 1;
  return good ? std::optional(std::move(message)) : std::nullopt;
}

Session draw_session(const std::array<std::uint8_t, 2>& first) {
  Session session{};
  fill_random(session);
  std::ranges::copy(first, session.begin());
  return session;
}

SecretKey session_key(const SecretKey& fleet_key, const FleetId& fleet, std::uint16_t epoch,
                      std::uint8_t radio, const Session& session) {
  const std::array<std::uint8_t, 3> numbers{static_cast<std::uint8_t>(epoch >> 8),
                                            static_cast<std::uint8_t>(epoch), radio};
  const Bytes info = joined({bytes_of("fleetmap radio 1"), fleet, numbers});
  const KeyContextHandle context(EVP_PKEY_CTX_new_id(EVP_PKEY_HKDF, nullptr));
  SecretKey key{};
  std::size_t size = key.size();
  require(
      context && EVP_PKEY_derive_init(context.get()) == 1 &&
          EVP_PKEY_CTX_set_hkdf_md(context.get(), EVP_sha256()) == 1 &&
          EVP_PKEY_CTX_set1_hkdf_key(context.get(), fleet_key.data(), static_cast<int>(fleet_key.size())) ==
              1 &&
          EVP_PKEY_CTX_set1_hkdf_salt(context.get(), session.data(), static_cast<int>(session.size())) == 1 &&
          EVP_PKEY_CTX_add1_hkdf_info(context.get(), info.data(), static_cast<int>(info.size())) == 1 &&
          EVP_PKEY_derive(context.get(), key.data(), &size) == 1,
      "deriving a key");
  return key;
}

}  // namespace fleetmap::trust
