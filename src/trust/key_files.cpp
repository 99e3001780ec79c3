#include "key_files.hpp"

#include <fcntl.h>
#include <openssl/pem.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include "openssl.hpp"

namespace fleetmap::trust {
namespace {

constexpr mode_t kSecretMode = 0600, kPublicMode = 0644, kOthers = 0077;

bool write_all(int fd, const std::string& text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t wrote = ::write(fd, text.data() + done, text.size() - done);
    if (wrote <= 0) return false;
    done += static_cast<std::size_t>(wrote);
  }
  return ::fsync(fd) == 0;
}

}  // namespace

tl::unexpected<Error> wrong(const std::filesystem::path& file, const std::string& why) {
  return failure(file.string() + ": " + why);
}

Result<std::string> read_file(const std::filesystem::path& file, Secrecy secrecy) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) {
    return wrong(
        file, std::string(std::strerror(errno)) + "; copy the robot's folder that `fleetmap keys add` made");
  }
  if (!S_ISREG(status.st_mode)) return wrong(file, "is no file; copy the robot's folder anew");
  if (secrecy == Secrecy::kSecret && (status.st_mode & kOthers) != 0)
    return wrong(file, "is secret, and other users of this machine may read it; chmod 600 it");
  std::ifstream in(file, std::ios::binary);
  if (!in) return wrong(file, "cannot be read; it must belong to the user that runs fleetmap");
  return std::string{std::istreambuf_iterator<char>(in), {}};
}

Status write_file(const std::filesystem::path& file, const std::string& text, Secrecy secrecy) {
  std::filesystem::path fresh = file;
  fresh += ".new";
  ::unlink(fresh.c_str());
  const mode_t mode = secrecy == Secrecy::kSecret ? kSecretMode : kPublicMode;
  const int fd = ::open(fresh.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
  bool good = fd >= 0 && write_all(fd, text);
  const std::string reason = std::strerror(errno);
  if (fd >= 0) ::close(fd);
  good = good && ::rename(fresh.c_str(), file.c_str()) == 0;
  return good ? Status() : wrong(file, "cannot be written: " + reason);
}

std::vector<Bytes> from_pem(const std::string& text, const std::string& name) {
  std::vector<Bytes> blocks;
  const BioHandle bio(BIO_new_mem_buf(text.data(), static_cast<int>(text.size())));
  require(bio != nullptr, "memory");
  char* found = nullptr;
  char* header = nullptr;
  unsigned char* data = nullptr;
  long size = 0;
  while (PEM_read_bio(bio.get(), &found, &header, &data, &size) == 1) {
    if (name == found) blocks.emplace_back(data, data + size);
    OPENSSL_free(found);
    OPENSSL_free(header);
    OPENSSL_free(data);
  }
  return blocks;
}

std::string to_pem(const Bytes& der, const std::string& name) {
  const BioHandle bio(BIO_new(BIO_s_mem()));
  require(bio && PEM_write_bio(bio.get(), name.c_str(), "", der.data(), static_cast<long>(der.size())) > 0,
          "writing PEM");
  char* text = nullptr;
  const long size = BIO_get_mem_data(bio.get(), &text);
  return {text, static_cast<std::size_t>(size)};
}

Result<Bytes> read_pem(const std::filesystem::path& file, const std::string& name) {
  const auto text = read_file(file, Secrecy::kPublic);
  if (!text) return tl::unexpected(text.error());
  const std::vector<Bytes> blocks = from_pem(*text, name);
  if (blocks.size() != 1) return wrong(file, "holds no " + name + " in PEM; copy the robot's folder anew");
  return blocks.front();
}

}  // namespace fleetmap::trust
