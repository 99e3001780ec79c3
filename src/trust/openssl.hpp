#pragma once

#include <openssl/bio.h>
#include <openssl/evp.h>
#include <openssl/x509.h>

#include <memory>
#include <span>

#include "fleetmap/core/bytes.hpp"

namespace fleetmap::trust {

template <auto kFree>
struct Free {
  template <class T>
  void operator()(T* object) const {
    kFree(object);
  }
};
using X509Handle = std::unique_ptr<X509, Free<X509_free>>;
using CrlHandle = std::unique_ptr<X509_CRL, Free<X509_CRL_free>>;
using RevokedHandle = std::unique_ptr<X509_REVOKED, Free<X509_REVOKED_free>>;
using NameHandle = std::unique_ptr<X509_NAME, Free<X509_NAME_free>>;
using IntegerHandle = std::unique_ptr<ASN1_INTEGER, Free<ASN1_INTEGER_free>>;
using TimeHandle = std::unique_ptr<ASN1_TIME, Free<ASN1_TIME_free>>;
using KeyHandle = std::unique_ptr<EVP_PKEY, Free<EVP_PKEY_free>>;
using KeyContextHandle = std::unique_ptr<EVP_PKEY_CTX, Free<EVP_PKEY_CTX_free>>;
using DigestHandle = std::unique_ptr<EVP_MD_CTX, Free<EVP_MD_CTX_free>>;
using CipherHandle = std::unique_ptr<EVP_CIPHER_CTX, Free<EVP_CIPHER_CTX_free>>;
using BioHandle = std::unique_ptr<BIO, Free<BIO_free_all>>;

/// Throws if `good` is false: what OpenSSL does only without memory or entropy.
void require(bool good, const char* what);
/// From OpenSSL's generator.
void fill_random(std::span<std::uint8_t> bytes);
KeyHandle public_key_handle(std::span<const std::uint8_t, 32> key);

}  // namespace fleetmap::trust
