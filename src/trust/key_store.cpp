#include "fleetmap/trust/key_store.hpp"

#include <algorithm>
#include <system_error>

#include "fleetmap/core/paths.hpp"
#include "key_files.hpp"
#include "openssl.hpp"

namespace fleetmap::trust {
namespace {

namespace fs = std::filesystem;

constexpr const char* kAuthorityKey = "ca.key";
constexpr const char* kIssued = "issued";
/// A robot's clock may be behind the operator's.
constexpr auto kClockAllowance = std::chrono::days(1);
constexpr auto kRenewal = std::chrono::days(30);

Status make_folder(const fs::path& folder, fs::perms permissions) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error) fs::permissions(folder, permissions, error);
  return error ? Status(wrong(folder, "cannot be made: " + error.message())) : Status();
}

std::uint32_t random_number() {
  std::array<std::uint8_t, 4> bytes{};
  fill_random(bytes);
  constexpr std::uint32_t kMax = 0x7fffffff;
  return ((std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 | std::uint32_t{bytes[2]} << 8 |
           bytes[3]) &
          kMax) |
         1U;
}

fs::path issued_file(const fs::path& folder, const Certificate& certificate) {
  return folder / kIssued / (certificate.name.str() + "-" + std::to_string(certificate.serial) + ".pem");
}

}  // namespace

Result<KeyStore> KeyStore::init(const fs::path& folder, Stamp now) {
  if (is_there(folder / kAuthorityKey))
    return wrong(folder, "holds the keys of a fleet already; give another folder, or add robots to it");
  if (const Status made = make_folder(folder / kIssued, fs::perms::owner_all); !made)
    return tl::unexpected(made.error());
  if (const Status made = make_folder(folder, fs::perms::owner_all); !made)
    return tl::unexpected(made.error());
  SigningKey key = SigningKey::generate();
  Authority authority = make_authority(key, now);
  KeyStore store(folder, std::move(key), std::move(authority));
  store.keys_ = with_new_epoch({});
  if (const Status saved = store.save(now); !saved) return tl::unexpected(saved.error());
  // The last, so that a fleet that was made half is no fleet.
  if (const Status saved = write_file(folder / kAuthorityKey, store.key_.to_pem(), Secrecy::kSecret); !saved)
    return tl::unexpected(saved.error());
  return store;
}

Result<KeyStore> KeyStore::open(const fs::path& folder) {
  if (!is_there(folder / kAuthorityKey))
    return wrong(folder,
                 "holds no fleet's keys; make them with `fleetmap keys init --dir " + folder.string() + "`");
  const auto text = read_file(folder / kAuthorityKey, Secrecy::kSecret);
  if (!text) return tl::unexpected(text.error());
  auto key = SigningKey::from_pem(*text);
  if (!key) return wrong(folder / kAuthorityKey, key.error().message);
  const auto der = read_pem(folder / file::kAuthority, kCertificatePem);
  if (!der) return tl::unexpected(der.error());
  auto authority = parse_authority(*der);
  if (!authority) return wrong(folder / file::kAuthority, authority.error().message);
  if (authority->key != key->public_key())
    return wrong(folder / kAuthorityKey, "is not the key of " + std::string(file::kAuthority));
  KeyStore store(folder, *std::move(key), *std::move(authority));
  const auto keys_text = read_file(folder / file::kFleetKeys, Secrecy::kSecret);
  if (!keys_text) return tl::unexpected(keys_text.error());
  auto keys = parse_fleet_keys(*keys_text);
  if (!keys) return wrong(folder / file::kFleetKeys, keys.error().message);
  store.keys_ = *std::move(keys);
  const auto list = read_pem(folder / file::kRevocations, kRevocationsPem);
  if (!list) return tl::unexpected(list.error());
  auto revocations = parse_revocations(*list, store.authority_);
  if (!revocations) return wrong(folder / file::kRevocations, revocations.error().message);
  store.revocations_ = *std::move(revocations);
  if (const Status read = store.read_issued(); !read) return tl::unexpected(read.error());
  return store;
}

Status KeyStore::read_issued() {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder_ / kIssued, error)) {
    if (entry.path().extension() != ".pem") continue;
    const auto der = read_pem(entry.path(), kCertificatePem);
    if (!der) return tl::unexpected(der.error());
    auto certificate = parse_certificate(*der, authority_);
    if (!certificate) return wrong(entry.path(), certificate.error().message);
    const bool revoked = revocations_.serials.contains(certificate->serial);
    members_.push_back({*std::move(certificate), revoked});
  }
  if (error) return wrong(folder_ / kIssued, error.message());
  std::ranges::sort(members_, {}, [](const Member& member) {
    return std::pair(member.certificate.name, member.certificate.serial);
  });
  return {};
}

Status KeyStore::refresh(const fs::path& member_folder) const {
  std::string members;
  for (const Member& member : members_) members += to_pem(member.certificate.der, kCertificatePem);
  for (const auto& [name, text] : {std::pair{file::kAuthority, to_pem(authority_.der, kCertificatePem)},
                                   std::pair{file::kMembers, members}}) {
    if (Status written = write_file(member_folder / name, text, Secrecy::kPublic); !written) return written;
  }
  return {};
}

Status KeyStore::save(Stamp now) const {
  const std::string keys = to_text(keys_);
  const std::string list = to_pem(sign_revocations(authority_, key_, revocations_, now), kRevocationsPem);
  std::vector<fs::path> folders{folder_};
  for (const Member& member : members_) {
    const fs::path folder = folder_ / member.certificate.name.str();
    if (!member.revoked && is_folder(folder)) folders.push_back(folder);
  }
  for (const fs::path& folder : folders) {
    if (Status written = write_file(folder / file::kFleetKeys, keys, Secrecy::kSecret); !written)
      return written;
    if (Status written = write_file(folder / file::kRevocations, list, Secrecy::kPublic); !written)
      return written;
    if (Status written = refresh(folder); !written) return written;
  }
  return {};
}

Result<Certificate> KeyStore::add(const AgentId& name, Role role, std::chrono::days valid, Stamp now) {
  if (name.str() == kIssued)
    return failure(name.str() + " is the folder of all certificates; choose another name");
  for (const Member& member : members_) {
    if (member.certificate.name != name || member.revoked || member.certificate.not_after < now + kRenewal)
      continue;
    return failure(name.str() + " has keys that are valid until " + date(member.certificate.not_after) +
                   "; if they were lost or stolen, revoke them first");
  }
  const fs::path folder = folder_ / name.str();
  if (const Status made = make_folder(folder, fs::perms::owner_all); !made)
    return tl::unexpected(made.error());
  const SigningKey key = SigningKey::generate();
  const Certificate certificate = issue(authority_, key_, name, role, key.public_key(), random_number(),
                                        now - kClockAllowance, now + valid);
  const std::string pem = to_pem(certificate.der, kCertificatePem);
  for (const Status& written : {write_file(issued_file(folder_, certificate), pem, Secrecy::kPublic),
                                write_file(folder / file::kCertificate, pem, Secrecy::kPublic),
                                write_file(folder / file::kKey, key.to_pem(), Secrecy::kSecret)}) {
    if (!written) return tl::unexpected(written.error());
  }
  members_.push_back({certificate, false});
  if (const Status saved = save(now); !saved) return tl::unexpected(saved.error());
  return certificate;
}

Status KeyStore::revoke(const AgentId& name, Stamp now) {
  bool any = false;
  for (Member& member : members_) {
    if (member.certificate.name != name || member.revoked) continue;
    any = member.revoked = true;
    revocations_.serials.insert(member.certificate.serial);
  }
  if (!any) return failure(name.str() + " has no certificate here that is not revoked already");
  ++revocations_.number;
  keys_ = with_new_epoch(std::move(keys_));
  std::error_code error;
  fs::remove_all(folder_ / name.str(), error);
  return save(now);
}

}  // namespace fleetmap::trust
