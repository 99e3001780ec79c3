// The files of a robot's folder of keys. The first byte chooses which one the input is, or that it is a
// certificate without PEM around it.
#include "trust/key_files.hpp"

#include <array>
#include <filesystem>

#include "checks.hpp"
#include "fixed_keys.hpp"

namespace fleetmap::fuzz {
namespace {

namespace fs = std::filesystem;

struct KeyFolder {
  Folder folder;
  std::array<std::pair<const char*, std::string>, 6> files;

  KeyFolder() {
    const trust::Credentials r1 = credentials_of("r1", key_of_r1(), 1);
    files = {{{trust::file::kAuthority, trust::to_pem(r1.authority.der, trust::kCertificatePem)},
              {trust::file::kCertificate, trust::to_pem(r1.certificate.der, trust::kCertificatePem)},
              {trust::file::kKey, r1.key.to_pem()},
              {trust::file::kFleetKeys, trust::to_text(r1.fleet_keys)},
              {trust::file::kRevocations,
               trust::to_pem(trust::sign_revocations(r1.authority, authority_key(), {}, kNow),
                             trust::kRevocationsPem)},
              {trust::file::kMembers, trust::to_pem(r1.certificate.der, trust::kCertificatePem)}}};
    for (std::size_t k = 0; k < files.size(); ++k) put(k, files[k].second);
    require(trust::load_credentials(folder.path(), kNow).has_value(), "a sound folder is refused");
  }
  void put(std::size_t k, std::string_view content) const {
    fs::permissions(folder.write(files[k].first, content), fs::perms::owner_read | fs::perms::owner_write);
  }
};

void load_with(std::size_t k, std::string_view content) {
  static const KeyFolder keys;
  keys.put(k, content);
  const auto loaded = trust::load_credentials(keys.folder.path(), kNow);
  if (!loaded)
    require(loaded.error().message.starts_with(keys.folder.path().string()), "the error names no file");
  keys.put(k, keys.files[k].second);
}

void parse_der(ByteView der) {
  const trust::Authority authority = trust::make_authority(authority_key(), kNow);
  static_cast<void>(trust::parse_authority(der));
  static_cast<void>(trust::parse_certificate(der, authority));
  static_cast<void>(trust::parse_revocations(der, authority));
}

}  // namespace
}  // namespace fleetmap::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fleetmap::fuzz;
  const Input input = split(data, size);
  if (input.choice % 7 == 6) {
    parse_der(input.rest);
  } else {
    load_with(input.choice % 7, text_of(input.rest));
  }
  return 0;
}
