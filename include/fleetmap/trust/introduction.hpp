#pragma once

#include <map>
#include <optional>

#include "fleetmap/trust/credentials.hpp"
#include "fleetmap/trust/datagram.hpp"

namespace fleetmap::trust {

/// The part of a greeting behind its text: the sender's identity and the proof of it. The text holds the
/// challenge, which is the session of its recipient, in a place that the caller reads.
///
///   flags 1, fingerprint of the sender's certificate 4, [signature 64], [certificate], size of all this 2
struct Introduction {
  Bytes text;
  bool names_you = false;          ///< else the challenge in the text answers a claim that is not proved yet
  bool names_another = false;      ///< at the receiver's place
  bool lacks_certificate = false;  ///< the receiver's, which is to come with the answer
  Fingerprint fingerprint{};
  std::optional<Signature> signature;
  Bytes certificate;
};
/// Empty for what is none.
std::optional<Introduction> parse_introduction(ByteView bytes);

/// Signs a robot's introductions on one radio and checks those of others.
class Introducer {
 public:
  Introducer(const Credentials& credentials, std::uint8_t radio, const Session& session);

  struct Flags {
    bool names_you = false, names_another = false, lacks_certificate = false;
  };
  /// A signature counts only in an answer to a challenge; the certificate is sent to robots that lack it.
  Bytes introduce(ByteView text, Flags flags, bool sign, bool with_certificate) const;

  bool has_certificate(const Fingerprint& fingerprint) const { return members_.contains(fingerprint); }
  /// Verifies the signature of `sender` and its certificate, which is kept, in the credentials as well. Fails
  /// with the reason.
  Result<Certificate> verify(const Introduction& introduction, const Session& sender, Stamp now);
  /// Every certificate of that name which is known was revoked.
  bool was_revoked(const AgentId& name) const;

 private:
  Bytes signed_bytes(ByteView text, std::uint8_t flags, const Session& sender) const;

  static constexpr std::size_t kMaxMembers = 1024;
  const Authority authority_;
  const Certificate certificate_;
  const SigningKey key_;
  const Revocations revocations_;
  const std::uint8_t radio_;
  const Session session_;
  std::map<Fingerprint, Certificate> members_;
  std::shared_ptr<LearnedCertificates> learned_;
};

}  // namespace fleetmap::trust
