#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::trust {

enum class Secrecy { kPublic, kSecret };

/// Fails if the file cannot be read or is secret and readable by others.
Result<std::string> read_file(const std::filesystem::path& file, Secrecy secrecy);
/// Replaces the file at once; a secret one is never readable by others.
Status write_file(const std::filesystem::path& file, const std::string& text, Secrecy secrecy);

/// The blocks of a PEM text that have this name ("CERTIFICATE"), decoded.
std::vector<Bytes> from_pem(const std::string& text, const std::string& name);
std::string to_pem(const Bytes& der, const std::string& name);
/// The same of a file that holds exactly one.
Result<Bytes> read_pem(const std::filesystem::path& file, const std::string& name);

/// "FILE: why", with what to do.
tl::unexpected<Error> wrong(const std::filesystem::path& file, const std::string& why);

inline constexpr const char* kCertificatePem = "CERTIFICATE";
inline constexpr const char* kRevocationsPem = "X509 CRL";

}  // namespace fleetmap::trust
