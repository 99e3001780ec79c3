#include "fleetmap/trust/introduction.hpp"

#include <algorithm>
#include <array>

#include "joined.hpp"

namespace fleetmap::trust {
namespace {

enum Flag : std::uint8_t { kKnowsYou = 1, kKnowsAnother = 2, kLacks = 4, kSigned = 8, kCertificate = 16 };
constexpr std::size_t kFixed = 1 + sizeof(Fingerprint), kSize = 2;

std::uint8_t to_byte(const Introducer::Flags& flags) {
  return static_cast<std::uint8_t>((flags.names_you ? kKnowsYou : 0) |
                                   (flags.names_another ? kKnowsAnother : 0) |
                                   (flags.lacks_certificate ? kLacks : 0));
}

}  // namespace

std::optional<Introduction> parse_introduction(ByteView bytes) {
  if (bytes.size() < kSize) return std::nullopt;
  const std::size_t size = std::size_t{bytes[bytes.size() - 2]} << 8 | bytes[bytes.size() - 1];
  if (size < kFixed + kSize || size > bytes.size()) return std::nullopt;
  const ByteView text = bytes.first(bytes.size() - size);
  ByteView rest = bytes.subspan(text.size(), size - kSize);
  const std::uint8_t flags = rest[0];
  Introduction result;
  result.text.assign(text.begin(), text.end());
  result.names_you = (flags & kKnowsYou) != 0;
  result.names_another = (flags & kKnowsAnother) != 0;
  result.lacks_certificate = (flags & kLacks) != 0;
  std::copy_n(rest.begin() + 1, result.fingerprint.size(), result.fingerprint.begin());
  rest = rest.subspan(kFixed);
  if ((flags & kSigned) != 0) {
    if (rest.size() < sizeof(Signature)) return std::nullopt;
    std::copy_n(rest.begin(), sizeof(Signature), result.signature.emplace().begin());
    rest = rest.subspan(sizeof(Signature));
  }
  if (((flags & kCertificate) != 0) == rest.empty()) return std::nullopt;
  result.certificate.assign(rest.begin(), rest.end());
  return result;
}

Introducer::Introducer(const Credentials& credentials, std::uint8_t radio, const Session& session)
    : authority_(credentials.authority),
      certificate_(credentials.certificate),
      key_(credentials.key),
      revocations_(credentials.revocations),
      radio_(radio),
      session_(session),
      learned_(credentials.learned) {
  for (const Certificate& member : credentials.members) members_.emplace(fingerprint(member), member);
}

Bytes Introducer::signed_bytes(ByteView text, std::uint8_t flags, const Session& sender) const {
  const std::array<std::uint8_t, 2> numbers{radio_, flags};
  return joined({bytes_of("fleetmap greeting 1"), authority_.fleet, numbers, sender, text});
}

Bytes Introducer::introduce(ByteView text, Flags flags, bool sign, bool with_certificate) const {
  const std::uint8_t plain = to_byte(flags);
  const auto all_flags =
      static_cast<std::uint8_t>(plain | (sign ? kSigned : 0) | (with_certificate ? kCertificate : 0));
  Signature signature{};
  if (sign) signature = key_.sign(signed_bytes(text, plain, session_));
  const ByteView shown_signature = ByteView(signature).first(sign ? signature.size() : 0);
  const ByteView shown_certificate =
      ByteView(certificate_.der).first(with_certificate ? certificate_.der.size() : 0);
  const std::size_t size = kFixed + shown_signature.size() + shown_certificate.size() + kSize;
  const std::array<std::uint8_t, kSize> end{static_cast<std::uint8_t>(size >> 8),
                                            static_cast<std::uint8_t>(size)};
  return joined({text, {&all_flags, 1}, fingerprint(certificate_), shown_signature, shown_certificate, end});
}

Result<Certificate> Introducer::verify(const Introduction& introduction, const Session& sender, Stamp now) {
  auto known = members_.find(introduction.fingerprint);
  if (known == members_.end() && !introduction.certificate.empty()) {
    auto certificate = parse_certificate(introduction.certificate, authority_);
    if (!certificate) return failure("its certificate " + certificate.error().message);
    if (fingerprint(*certificate) != introduction.fingerprint)
      return failure("its certificate is another one");
    if (members_.size() >= kMaxMembers) return failure("the fleet has too many certificates");
    learned_->add(*certificate);
    known = members_.emplace(introduction.fingerprint, *std::move(certificate)).first;
  }
  if (known == members_.end()) return failure("its certificate is still to come");
  const Certificate& certificate = known->second;
  if (Status valid = check(certificate, revocations_, now); !valid) return tl::unexpected(valid.error());
  const std::uint8_t flags =
      to_byte({introduction.names_you, introduction.names_another, introduction.lacks_certificate});
  if (!introduction.signature ||
      !trust::verify(certificate.key, signed_bytes(introduction.text, flags, sender),
                     *introduction.signature))
    return failure("its signature is not that of " + certificate.name.str());
  return certificate;
}

bool Introducer::was_revoked(const AgentId& name) const {
  bool any = false;
  for (const auto& [id, member] : members_) {
    if (member.name != name) continue;
    if (!revocations_.serials.contains(member.serial)) return false;
    any = true;
  }
  return any;
}

}  // namespace fleetmap::trust
