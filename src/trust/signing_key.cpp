#include "fleetmap/trust/signing_key.hpp"

#include <openssl/pem.h>

#include "openssl.hpp"

namespace fleetmap::trust {

SigningKey SigningKey::generate() {
  EVP_PKEY* key = EVP_PKEY_Q_keygen(nullptr, nullptr, "ED25519");
  require(key != nullptr, "key generation");
  return SigningKey({key, EVP_PKEY_free});
}

Result<SigningKey> SigningKey::from_pem(const std::string& pem) {
  const BioHandle bio(BIO_new_mem_buf(pem.data(), static_cast<int>(pem.size())));
  require(bio != nullptr, "memory");
  // Without a callback OpenSSL would request a passphrase on the terminal.
  const auto no_passphrase = [](char*, int, int, void*) { return -1; };
  std::shared_ptr<EVP_PKEY> key(PEM_read_bio_PrivateKey(bio.get(), nullptr, no_passphrase, nullptr),
                                EVP_PKEY_free);
  if (!key || EVP_PKEY_get_id(key.get()) != EVP_PKEY_ED25519)
    return failure("is no Ed25519 private key in PEM");
  return SigningKey(std::move(key));
}

std::string SigningKey::to_pem() const {
  const BioHandle bio(BIO_new(BIO_s_mem()));
  require(bio && PEM_write_bio_PrivateKey(bio.get(), key_.get(), nullptr, nullptr, 0, nullptr, nullptr) == 1,
          "writing a key");
  char* text = nullptr;
  const long size = BIO_get_mem_data(bio.get(), &text);
  return {text, static_cast<std::size_t>(size)};
}

PublicKey SigningKey::public_key() const {
  PublicKey key{};
  std::size_t size = key.size();
  require(EVP_PKEY_get_raw_public_key(key_.get(), key.data(), &size) == 1, "reading a key");
  return key;
}

Signature SigningKey::sign(ByteView message) const {
  Signature signature{};
  std::size_t size = signature.size();
  const DigestHandle digest(EVP_MD_CTX_new());
  require(digest && EVP_DigestSignInit(digest.get(), nullptr, nullptr, nullptr, key_.get()) == 1 &&
              EVP_DigestSign(digest.get(), signature.data(), &size, message.data(), message.size()) == 1,
          "signing");
  return signature;
}

bool verify(const PublicKey& key, ByteView message, const Signature& signature) {
  const KeyHandle handle = public_key_handle(key);
  const DigestHandle digest(EVP_MD_CTX_new());
  return handle && digest &&
         EVP_DigestVerifyInit(digest.get(), nullptr, nullptr, nullptr, handle.get()) == 1 &&
         EVP_DigestVerify(digest.get(), signature.data(), signature.size(), message.data(), message.size()) ==
             1;
}

}  // namespace fleetmap::trust
