#include "fleetmap/trust/credentials.hpp"

#include <algorithm>

#include "key_files.hpp"

namespace fleetmap::trust {
namespace {

namespace fs = std::filesystem;

/// Puts the file in front of what is wrong with it.
template <class T>
Result<T> of_file(const fs::path& file, Result<T> result, const std::string& remedy) {
  if (result) return result;
  return wrong(file, result.error().message + "; " + remedy);
}

Result<Certificate> own_certificate(const fs::path& folder, const Authority& authority) {
  const fs::path file = folder / file::kCertificate;
  const auto der = read_pem(file, kCertificatePem);
  if (!der) return tl::unexpected(der.error());
  return of_file(file, parse_certificate(*der, authority),
                 "copy the whole folder of this robot from one fleet's keys");
}

Result<Revocations> revocations_of(const fs::path& folder, const Authority& authority) {
  const fs::path file = folder / file::kRevocations;
  const auto der = read_pem(file, kRevocationsPem);
  if (!der) return tl::unexpected(der.error());
  return of_file(file, parse_revocations(*der, authority),
                 "copy the whole folder of this robot from one fleet's keys");
}

Result<SigningKey> own_key(const fs::path& folder, const Certificate& certificate) {
  const fs::path file = folder / file::kKey;
  const auto text = read_file(file, Secrecy::kSecret);
  if (!text) return tl::unexpected(text.error());
  auto key = of_file(file, SigningKey::from_pem(*text), "copy the robot's folder anew");
  if (key && key->public_key() != certificate.key) {
    return wrong(file, "is not the key of " + std::string(file::kCertificate) +
                           " beside it; copy the robot's folder anew");
  }
  return key;
}

Result<FleetKeys> shared_keys(const fs::path& folder) {
  const fs::path file = folder / file::kFleetKeys;
  const auto text = read_file(file, Secrecy::kSecret);
  if (!text) return tl::unexpected(text.error());
  return of_file(file, parse_fleet_keys(*text), "copy the robot's folder anew");
}

/// Those that are missing or wrong cost a few bytes on the radio, and no more.
std::vector<Certificate> members_of(const fs::path& folder, const Authority& authority) {
  std::vector<Certificate> members;
  const auto text = read_file(folder / file::kMembers, Secrecy::kPublic);
  if (!text) return members;
  for (const Bytes& der : from_pem(*text, kCertificatePem)) {
    if (auto member = parse_certificate(der, authority)) members.push_back(*std::move(member));
  }
  return members;
}

}  // namespace

Result<Credentials> load_credentials(const fs::path& folder, Stamp now) {
  const auto der = read_pem(folder / file::kAuthority, kCertificatePem);
  if (!der) return tl::unexpected(der.error());
  const auto authority =
      of_file(folder / file::kAuthority, parse_authority(*der), "copy the robot's folder anew");
  if (!authority) return tl::unexpected(authority.error());
  const auto certificate = own_certificate(folder, *authority);
  if (!certificate) return tl::unexpected(certificate.error());
  const auto key = own_key(folder, *certificate);
  if (!key) return tl::unexpected(key.error());
  const auto fleet_keys = shared_keys(folder);
  if (!fleet_keys) return tl::unexpected(fleet_keys.error());
  const auto revocations = revocations_of(folder, *authority);
  if (!revocations) return tl::unexpected(revocations.error());
  if (const Status valid = check(*certificate, *revocations, now); !valid) {
    return wrong(folder / file::kCertificate,
                 valid.error().message + "; set the clock, or make new keys with `fleetmap keys add " +
                     certificate->name.str() + "` and copy its folder");
  }
  return Credentials{*authority,  *certificate, *key,
                     *fleet_keys, *revocations, members_of(folder, *authority)};
}

void LearnedCertificates::add(const Certificate& certificate) {
  const std::scoped_lock lock(mutex_);
  const auto same = [&](const Certificate& other) { return other.der == certificate.der; };
  if (certificates_.size() < kMax && std::ranges::none_of(certificates_, same))
    certificates_.push_back(certificate);
}

std::vector<Certificate> LearnedCertificates::all() const {
  const std::scoped_lock lock(mutex_);
  return certificates_;
}

}  // namespace fleetmap::trust
