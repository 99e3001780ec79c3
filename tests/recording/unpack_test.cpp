#include "recording/unpack.hpp"

#include <bzlib.h>
#include <gmock/gmock.h>
#include <lz4frame.h>

#include <fstream>

#include "recording/compressed.hpp"
#include "support/file_content.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::recording {
namespace {

using fleetmap::testing::TemporaryFolder;
using ::testing::HasSubstr;
using testing::zstd_of;

/// Larger than a step of the decoders, and neither constant nor random.
Bytes content() {
  Bytes bytes(700'000);
  for (std::size_t k = 0; k < bytes.size(); ++k) bytes[k] = static_cast<std::uint8_t>(k * k >> 7);
  return bytes;
}

Bytes lz4_of(const Bytes& bytes) {
  Bytes packed(LZ4F_compressFrameBound(bytes.size(), nullptr));
  packed.resize(LZ4F_compressFrame(packed.data(), packed.size(), bytes.data(), bytes.size(), nullptr));
  return packed;
}

Bytes bz2_of(const Bytes& bytes) {
  Bytes packed(bytes.size() + 1000), in = bytes;
  auto size = static_cast<unsigned>(packed.size());
  EXPECT_EQ(
      BZ2_bzBuffToBuffCompress(reinterpret_cast<char*>(packed.data()), &size,
                               reinterpret_cast<char*>(in.data()), static_cast<unsigned>(in.size()), 9, 0, 0),
      BZ_OK);
  packed.resize(size);
  return packed;
}

using Unpack = Result<Bytes> (*)(ByteView, std::size_t);

TEST(Unpack, GivesBackWhatWasPacked) {
  const Bytes bytes = content();
  EXPECT_EQ(unpack_zstd(zstd_of(bytes), bytes.size()), bytes);
  EXPECT_EQ(unpack_lz4(lz4_of(bytes), bytes.size()), bytes);
  EXPECT_EQ(unpack_bz2(bz2_of(bytes), bytes.size()), bytes);
  EXPECT_EQ(unpack_zstd(zstd_of({}), 10), Bytes());
  EXPECT_EQ(unpack_lz4(lz4_of({}), 10), Bytes());
}

TEST(Unpack, RefusesWhatIsCutDamagedOrTooLarge) {
  const Bytes bytes = content();
  for (const auto& [unpack, packed] : {std::pair<Unpack, Bytes>(unpack_zstd, zstd_of(bytes)),
                                       std::pair<Unpack, Bytes>(unpack_lz4, lz4_of(bytes)),
                                       std::pair<Unpack, Bytes>(unpack_bz2, bz2_of(bytes))}) {
    for (const std::size_t part : {packed.size() - 1, packed.size() / 2, std::size_t{6}, std::size_t{0}}) {
      EXPECT_FALSE(unpack(ByteView(packed).first(part), bytes.size())) << part;
    }
    Bytes damaged = packed;
    damaged[0] ^= 0xff;
    EXPECT_FALSE(unpack(damaged, bytes.size()));
    const auto too_large = unpack(packed, bytes.size() - 1);
    ASSERT_FALSE(too_large);
    EXPECT_THAT(too_large.error().message, HasSubstr("unpacks to more than"));
  }
}

TEST(Unpack, ZstdIsKnownByItsBeginning) {
  EXPECT_TRUE(is_zstd(zstd_of({1, 2, 3})));
  EXPECT_FALSE(is_zstd(lz4_of({1, 2, 3})));
  EXPECT_FALSE(is_zstd(Bytes{0x28, 0xb5}));
}

TEST(Unpack, AFileIsUnpackedAsAWhole) {
  const TemporaryFolder folder;
  const Bytes bytes = content(), packed = zstd_of(bytes);
  folder.write("a.zstd", std::string(packed.begin(), packed.end()));
  ASSERT_TRUE(unpack_zstd_file(folder.path() / "a.zstd", folder.path() / "a"));
  EXPECT_EQ(fleetmap::testing::file_bytes(folder.path() / "a"), bytes);

  folder.write("cut.zstd", std::string(packed.begin(), packed.end() - 5));
  const Status cut = unpack_zstd_file(folder.path() / "cut.zstd", folder.path() / "b");
  ASSERT_FALSE(cut);
  EXPECT_THAT(cut.error().message, HasSubstr("cut.zstd: the zstd file is cut"));
  const Status full = unpack_zstd_file(folder.path() / "a.zstd", "/dev/full");
  ASSERT_FALSE(full);
  EXPECT_THAT(full.error().message, HasSubstr("/dev/full: no room"));
}

}  // namespace
}  // namespace fleetmap::recording
