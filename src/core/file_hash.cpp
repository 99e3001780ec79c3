#include "fleetmap/core/file_hash.hpp"

#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <memory>

namespace fleetmap {

Result<ContentHash> file_hash(const std::filesystem::path& file) {
  constexpr std::size_t kBlock = std::size_t{1} << 20;
  std::ifstream in(file, std::ios::binary);
  if (!in) return failure(file.string() + ": cannot be read");
  const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context(EVP_MD_CTX_new(), &EVP_MD_CTX_free);
  bool hashed = context && EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) == 1;
  std::vector<char> block(kBlock);
  while (hashed && in) {
    in.read(block.data(), static_cast<std::streamsize>(block.size()));
    hashed = EVP_DigestUpdate(context.get(), block.data(), static_cast<std::size_t>(in.gcount())) == 1;
  }
  std::array<std::uint8_t, EVP_MAX_MD_SIZE> digest{};
  hashed = hashed && EVP_DigestFinal_ex(context.get(), digest.data(), nullptr) == 1;
  if (!hashed || in.bad()) return failure(file.string() + ": cannot be read");
  ContentHash hash{};
  std::copy_n(digest.begin(), hash.size(), hash.begin());
  return hash;
}

}  // namespace fleetmap
