#include "monitor/preview_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "support/temporary_folder.hpp"

namespace fleetmap::monitor {
namespace {

class PreviewFile : public ::testing::Test {
 protected:
  PreviewFile() {
    for (const char digit : {'1', 'a', 'f'}) {
      QuantisedCloud cloud;
      cloud.centre = {1.0f, -2.0f, static_cast<float>(digit)};
      cloud.scale = 0.001f;
      cloud.whole = 15'000;
      for (int k = 0; k < digit; ++k) cloud.values.insert(cloud.values.end(), {std::int16_t(k), -3, 5, 7});
      previews_[std::string(32, digit)] = std::make_shared<const QuantisedCloud>(std::move(cloud));
    }
    previews_[std::string(32, '0')] = std::make_shared<const QuantisedCloud>();  // an empty submap
  }
  void expect_ours(const Previews& read) const {
    ASSERT_EQ(read.size(), previews_.size());
    for (const auto& [hash, cloud] : previews_) {
      ASSERT_TRUE(read.contains(hash)) << hash;
      const QuantisedCloud& other = *read.at(hash);
      EXPECT_EQ(other.centre, cloud->centre);
      EXPECT_EQ(other.scale, cloud->scale);
      EXPECT_EQ(other.whole, cloud->whole);
      EXPECT_EQ(other.values, cloud->values);
    }
  }

  Previews previews_;
  testing::TemporaryFolder folder_;
};

TEST_F(PreviewFile, what_was_written_is_read) {
  const std::filesystem::path file = folder_ / "store.db.previews";
  EXPECT_TRUE(read_previews(file).empty()) << "there is none yet";
  ASSERT_TRUE(write_previews(file, previews_));
  expect_ours(read_previews(file));
  ASSERT_TRUE(write_previews(file, {}));
  EXPECT_TRUE(read_previews(file).empty());
}

TEST_F(PreviewFile, a_damaged_file_is_none) {
  Bytes bytes = encoded_previews(previews_);
  expect_ours(decoded_previews(bytes));
  for (std::size_t k = 0; k < bytes.size(); ++k) {
    ASSERT_TRUE(decoded_previews(ByteView(bytes).first(k)).empty()) << "cut after " << k << " bytes";
    bytes[k] ^= 0x10;
    ASSERT_TRUE(decoded_previews(bytes).empty()) << "byte " << k << " is another";
    bytes[k] ^= 0x10;
  }
  bytes.push_back(0);
  EXPECT_TRUE(decoded_previews(bytes).empty()) << "a byte more";
}

TEST_F(PreviewFile, where_none_can_be_written_the_reason_is_told) {
  const auto written = write_previews(folder_ / "none" / "store.db.previews", previews_);
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("store.db.previews"), std::string::npos) << written.error().message;
}

}  // namespace
}  // namespace fleetmap::monitor
