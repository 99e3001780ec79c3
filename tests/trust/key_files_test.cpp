#include "key_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "support/temporary_folder.hpp"
#include "trust/file_mode.hpp"

namespace fleetmap::trust {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::mode_of;
using ::testing::StartsWith;
namespace fs = std::filesystem;

class KeyFiles : public ::testing::Test {
 protected:
  std::string refusal(const fs::path& file, Secrecy secrecy = Secrecy::kPublic) const {
    const auto text = read_file(file, secrecy);
    return text ? "none" : text.error().message;
  }

  const testing::TemporaryFolder folder_;
  const fs::path file_ = folder_.path() / "some.key";
};

TEST_F(KeyFiles, WrittenContentIsReadAgain) {
  const std::string text("a\0\n\xff", 4);
  for (const Secrecy secrecy : {Secrecy::kSecret, Secrecy::kPublic}) {
    for (const std::string& content : {text, std::string(), std::string(100'000, 'x')}) {
      ASSERT_TRUE(write_file(file_, content, secrecy));
      EXPECT_EQ(read_file(file_, secrecy).value(), content);
    }
  }
  EXPECT_FALSE(fs::exists(file_.string() + ".new"));
}

TEST_F(KeyFiles, ASecretFileIsTheOwnersAloneWhateverWasThereBefore) {
  std::ofstream(file_) << "public";
  fs::permissions(file_, fs::perms(0666));
  std::ofstream(file_.string() + ".new") << "of a program that was killed";
  fs::permissions(file_.string() + ".new", fs::perms(0666));
  ASSERT_TRUE(write_file(file_, "secret", Secrecy::kSecret));
  EXPECT_EQ(mode_of(file_), 0600u);
  EXPECT_EQ(read_file(file_, Secrecy::kSecret).value(), "secret");
  ASSERT_TRUE(write_file(file_, "public", Secrecy::kPublic));
  EXPECT_EQ(mode_of(file_) & 0200, 0200u);
  EXPECT_EQ(mode_of(file_) & 0022, 0u);
}

TEST_F(KeyFiles, ASecretThatAnyOtherMayReadOrWriteIsRefused) {
  ASSERT_TRUE(write_file(file_, "secret", Secrecy::kSecret));
  for (const unsigned mode : {0640u, 0604u, 0620u, 0602u, 0610u, 0601u}) {
    fs::permissions(file_, fs::perms(mode));
    EXPECT_EQ(refusal(file_, Secrecy::kSecret),
              file_.string() + ": is secret, and other users of this machine may read it; chmod 600 it");
    EXPECT_EQ(refusal(file_), "none") << "no secret";
  }
  fs::permissions(file_, fs::perms(0400));
  EXPECT_EQ(refusal(file_, Secrecy::kSecret), "none");
}

TEST_F(KeyFiles, MissingFilesAndFoldersAreNamedWithTheRemedy) {
  EXPECT_EQ(
      refusal(file_),
      file_.string() + ": No such file or directory; copy the robot's folder that `fleetmap keys add` made");
  EXPECT_EQ(refusal(folder_.path()), folder_.path().string() + ": is no file; copy the robot's folder anew");
  const fs::path nowhere = folder_.path() / "no" / "some.key";
  const Status written = write_file(nowhere, "text", Secrecy::kPublic);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().message, nowhere.string() + ": cannot be written: No such file or directory");
}

TEST_F(KeyFiles, PemKeepsTheBytesUnderTheirName) {
  Bytes der(100);
  for (std::size_t k = 0; k < der.size(); ++k) der[k] = static_cast<std::uint8_t>(3 * k);
  const std::string pem = to_pem(der, kCertificatePem);
  EXPECT_THAT(pem, StartsWith("-----BEGIN CERTIFICATE-----\n"));
  EXPECT_THAT(from_pem(pem, kCertificatePem), ElementsAre(der));
  EXPECT_THAT(from_pem(pem, kRevocationsPem), ElementsAre());
}

TEST_F(KeyFiles, OfSeveralBlocksThoseOfTheNameCount) {
  const Bytes first{1}, second{2, 3}, list{4};
  const std::string text = "comment\n" + to_pem(first, kCertificatePem) + to_pem(list, kRevocationsPem) +
                           "more\n" + to_pem(second, kCertificatePem);
  EXPECT_THAT(from_pem(text, kCertificatePem), ElementsAre(first, second));
  EXPECT_THAT(from_pem(text, kRevocationsPem), ElementsAre(list));
  EXPECT_THAT(from_pem("nonsense", kCertificatePem), ElementsAre());
  EXPECT_THAT(from_pem("", kCertificatePem), ElementsAre());
}

TEST_F(KeyFiles, APemFileHoldsExactlyOne) {
  const Bytes der{1, 2, 3};
  const std::string pem = to_pem(der, kRevocationsPem);
  ASSERT_TRUE(write_file(file_, pem, Secrecy::kPublic));
  EXPECT_EQ(read_pem(file_, kRevocationsPem).value(), der);
  const std::string said = file_.string() + ": holds no X509 CRL in PEM; copy the robot's folder anew";
  for (const std::string& text : {std::string(), pem + pem, to_pem(der, kCertificatePem)}) {
    ASSERT_TRUE(write_file(file_, text, Secrecy::kPublic));
    EXPECT_EQ(read_pem(file_, kRevocationsPem).error().message, said);
  }
  fs::remove(file_);
  EXPECT_THAT(read_pem(file_, kRevocationsPem).error().message, HasSubstr("No such file"));
}

}  // namespace
}  // namespace fleetmap::trust
