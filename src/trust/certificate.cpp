#include "fleetmap/trust/certificate.hpp"

#include <openssl/x509v3.h>

#include <algorithm>
#include <ctime>
#include <optional>

#include "openssl.hpp"

namespace fleetmap::trust {
namespace {

constexpr long kVersion3 = 2, kVersion2 = 1;  // X.509's numbers begin at 0

void add_entry(X509_NAME* name, int field, const std::string& text) {
  require(X509_NAME_add_entry_by_NID(name, field, MBSTRING_ASC,
                                     reinterpret_cast<const unsigned char*>(text.data()),
                                     static_cast<int>(text.size()), -1, 0) == 1,
          "writing a name");
}

std::string entry(const X509_NAME* name, int field) {
  const int at = X509_NAME_get_index_by_NID(name, field, -1);
  if (at < 0) return {};
  const ASN1_STRING* text = X509_NAME_ENTRY_get_data(X509_NAME_get_entry(name, at));
  return {reinterpret_cast<const char*>(ASN1_STRING_get0_data(text)),
          static_cast<std::size_t>(ASN1_STRING_length(text))};
}

TimeHandle to_time(Stamp stamp) {
  TimeHandle time(ASN1_TIME_set(
      nullptr, std::chrono::duration_cast<std::chrono::seconds>(stamp.time_since_epoch()).count()));
  require(time != nullptr, "a time");
  return time;
}

std::optional<Stamp> to_stamp(const ASN1_TIME* time) {
  std::tm parts{};
  if (time == nullptr || ASN1_TIME_to_tm(time, &parts) != 1) return std::nullopt;
  return Stamp(std::chrono::seconds(timegm(&parts)));
}

IntegerHandle to_integer(std::uint32_t number) {
  IntegerHandle integer(ASN1_INTEGER_new());
  require(integer && ASN1_INTEGER_set_uint64(integer.get(), number) == 1, "a number");
  return integer;
}

std::optional<std::uint32_t> to_number(const ASN1_INTEGER* integer) {
  std::uint64_t number = 0;
  if (integer == nullptr || ASN1_INTEGER_get_uint64(&number, integer) != 1 || number > 0xffffffffU)
    return std::nullopt;
  return static_cast<std::uint32_t>(number);
}

template <class Object, class Encode>
Bytes to_der(Object* object, Encode encode) {
  unsigned char* data = nullptr;
  const int size = encode(object, &data);
  require(size > 0, "encoding");
  Bytes der(data, data + size);
  OPENSSL_free(data);
  return der;
}

/// Empty for what is not exactly one certificate.
X509Handle from_der(ByteView der) {
  const unsigned char* at = der.data();
  X509Handle certificate(d2i_X509(nullptr, &at, static_cast<long>(der.size())));
  if (at != der.data() + der.size()) certificate.reset();
  return certificate;
}

std::optional<PublicKey> key_of(const X509* certificate) {
  PublicKey key{};
  std::size_t size = key.size();
  const EVP_PKEY* handle = X509_get0_pubkey(certificate);
  if (handle == nullptr || EVP_PKEY_get_id(handle) != EVP_PKEY_ED25519 ||
      EVP_PKEY_get_raw_public_key(handle, key.data(), &size) != 1)
    return std::nullopt;
  return key;
}

std::string authority_name(const FleetId& fleet) {
  constexpr std::size_t kDigits = 8;
  ContentHash padded{};
  std::ranges::copy(fleet, padded.begin());
  return "fleet-" + to_hex(padded).substr(0, kDigits);
}

/// Version, names, validity and key of a certificate that is still to be signed.
X509Handle unsigned_certificate(std::uint32_t serial, const std::string& issuer, Stamp not_before,
                                Stamp not_after, EVP_PKEY* key) {
  X509Handle certificate(X509_new());
  require(certificate && X509_set_version(certificate.get(), kVersion3) == 1 &&
              X509_set_serialNumber(certificate.get(), to_integer(serial).get()) == 1 &&
              X509_set1_notBefore(certificate.get(), to_time(not_before).get()) == 1 &&
              X509_set1_notAfter(certificate.get(), to_time(not_after).get()) == 1 &&
              X509_set_pubkey(certificate.get(), key) == 1,
          "a certificate");
  add_entry(X509_get_issuer_name(certificate.get()), NID_commonName, issuer);
  return certificate;
}

}  // namespace

const char* to_string(Role role) { return role == Role::kObserver ? "observer" : "robot"; }

Result<Role> parse_role(const std::string& text) {
  for (const Role role : {Role::kRobot, Role::kObserver}) {
    if (text == to_string(role)) return role;
  }
  return failure("role is \"" + text + "\"; expected robot or observer");
}

FleetId fleet_of(const PublicKey& authority_key) {
  FleetId fleet{};
  std::copy_n(content_hash(authority_key).begin(), fleet.size(), fleet.begin());
  return fleet;
}

std::string date(Stamp stamp) {
  const std::time_t seconds =
      std::chrono::duration_cast<std::chrono::seconds>(stamp.time_since_epoch()).count();
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  char text[16] = "";
  (void)std::strftime(text, sizeof text, "%Y-%m-%d", &parts);
  return text;
}

Authority make_authority(const SigningKey& key, Stamp now) {
  constexpr auto kValid = std::chrono::days(20 * 365);
  const FleetId fleet = fleet_of(key.public_key());
  const X509Handle certificate =
      unsigned_certificate(1, authority_name(fleet), now, now + kValid, key.handle());
  add_entry(X509_get_subject_name(certificate.get()), NID_commonName, authority_name(fleet));
  X509_EXTENSION* extension =
      X509V3_EXT_conf_nid(nullptr, nullptr, NID_basic_constraints, "critical,CA:TRUE");
  const bool added = extension != nullptr && X509_add_ext(certificate.get(), extension, -1) == 1;
  X509_EXTENSION_free(extension);
  require(added && X509_sign(certificate.get(), key.handle(), nullptr) > 0, "signing a certificate");
  return {key.public_key(), fleet, now + kValid, to_der(certificate.get(), i2d_X509)};
}

Certificate issue(const Authority& authority, const SigningKey& authority_key, const AgentId& name, Role role,
                  const PublicKey& key, std::uint32_t serial, Stamp not_before, Stamp not_after) {
  const KeyHandle member = public_key_handle(key);
  const X509Handle certificate =
      unsigned_certificate(serial, authority_name(authority.fleet), not_before, not_after, member.get());
  X509_NAME* subject = X509_get_subject_name(certificate.get());
  add_entry(subject, NID_commonName, name.str());
  if (role != Role::kRobot) add_entry(subject, NID_organizationalUnitName, to_string(role));
  require(X509_sign(certificate.get(), authority_key.handle(), nullptr) > 0, "signing a certificate");
  return {name, role, serial, not_before, not_after, key, to_der(certificate.get(), i2d_X509)};
}

Bytes sign_revocations(const Authority& authority, const SigningKey& authority_key,
                       const Revocations& revocations, Stamp now) {
  const CrlHandle list(X509_CRL_new());
  const NameHandle issuer(X509_NAME_new());
  require(list && issuer, "memory");
  add_entry(issuer.get(), NID_commonName, authority_name(authority.fleet));
  require(
      X509_CRL_set_version(list.get(), kVersion2) == 1 &&
          X509_CRL_set_issuer_name(list.get(), issuer.get()) == 1 &&
          X509_CRL_set1_lastUpdate(list.get(), to_time(now).get()) == 1 &&
          X509_CRL_add1_ext_i2d(list.get(), NID_crl_number, to_integer(revocations.number).get(), 0, 0) == 1,
      "a revocation list");
  for (const std::uint32_t serial : revocations.serials) {
    RevokedHandle revoked(X509_REVOKED_new());
    require(revoked && X509_REVOKED_set_serialNumber(revoked.get(), to_integer(serial).get()) == 1 &&
                X509_REVOKED_set_revocationDate(revoked.get(), to_time(now).get()) == 1 &&
                X509_CRL_add0_revoked(list.get(), revoked.get()) == 1,
            "a revocation");
    (void)revoked.release();  // the list's now
  }
  require(X509_CRL_sign(list.get(), authority_key.handle(), nullptr) > 0, "signing a revocation list");
  return to_der(list.get(), i2d_X509_CRL);
}

Result<Authority> parse_authority(ByteView der) {
  const X509Handle certificate = from_der(der);
  const auto key = certificate ? key_of(certificate.get()) : std::nullopt;
  if (!key || X509_check_ca(certificate.get()) != 1 ||
      X509_verify(certificate.get(), X509_get0_pubkey(certificate.get())) != 1)
    return failure("is no certificate of a fleet's authority");
  const auto not_after = to_stamp(X509_get0_notAfter(certificate.get()));
  if (!not_after) return failure("has no date of expiry");
  return Authority{*key, fleet_of(*key), *not_after, {der.begin(), der.end()}};
}

Result<Certificate> parse_certificate(ByteView der, const Authority& authority) {
  const X509Handle handle = from_der(der);
  const auto key = handle ? key_of(handle.get()) : std::nullopt;
  if (!key) return failure("is no certificate of an Ed25519 key");
  const KeyHandle authority_key = public_key_handle(authority.key);
  if (X509_verify(handle.get(), authority_key.get()) != 1)
    return failure("was not signed by this fleet's authority");
  const X509_NAME* subject = X509_get_subject_name(handle.get());
  const auto name = AgentId::parse(entry(subject, NID_commonName));
  const std::string unit = entry(subject, NID_organizationalUnitName);
  const auto role = unit.empty() ? Result<Role>(Role::kRobot) : parse_role(unit);
  const auto serial = to_number(X509_get0_serialNumber(handle.get()));
  const auto not_before = to_stamp(X509_get0_notBefore(handle.get()));
  const auto not_after = to_stamp(X509_get0_notAfter(handle.get()));
  if (!name || !role || !serial || !not_before || !not_after)
    return failure("is no member's certificate: its name, role, serial number or dates are not as expected");
  return Certificate{*name, *role, *serial, *not_before, *not_after, *key, {der.begin(), der.end()}};
}

Result<Revocations> parse_revocations(ByteView der, const Authority& authority) {
  const unsigned char* at = der.data();
  const CrlHandle list(d2i_X509_CRL(nullptr, &at, static_cast<long>(der.size())));
  if (!list) return failure("is no revocation list");
  const KeyHandle authority_key = public_key_handle(authority.key);
  if (X509_CRL_verify(list.get(), authority_key.get()) != 1)
    return failure("was not signed by this fleet's authority");
  const IntegerHandle number(
      static_cast<ASN1_INTEGER*>(X509_CRL_get_ext_d2i(list.get(), NID_crl_number, nullptr, nullptr)));
  Revocations revocations{to_number(number.get()).value_or(0), {}};
  STACK_OF(X509_REVOKED)* entries = X509_CRL_get_REVOKED(list.get());
  for (int k = 0; k < sk_X509_REVOKED_num(entries); ++k) {
    if (const auto serial = to_number(X509_REVOKED_get0_serialNumber(sk_X509_REVOKED_value(entries, k))))
      revocations.serials.insert(*serial);
  }
  return revocations;
}

Status check(const Certificate& certificate, const Revocations& revocations, Stamp now) {
  if (revocations.serials.contains(certificate.serial))
    return failure("the certificate of " + certificate.name.str() + " was revoked");
  if (now > certificate.not_after) {
    return failure("the certificate of " + certificate.name.str() + " expired on " +
                   date(certificate.not_after));
  }
  if (now < certificate.not_before) {
    return failure("the certificate of " + certificate.name.str() + " is valid from " +
                   date(certificate.not_before) + ", and this machine's clock says " + date(now));
  }
  return {};
}

Fingerprint fingerprint(const Certificate& certificate) {
  Fingerprint result{};
  std::copy_n(content_hash(certificate.der).begin(), result.size(), result.begin());
  return result;
}

}  // namespace fleetmap::trust
