#include "recording/chunked_file.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <utility>

#include "support/temporary_folder.hpp"

namespace fleetmap::recording {
namespace {

using Times = std::vector<std::uint64_t>;

/// Chunks whose messages are their own times.
class Chunks : public ChunkedFile {
 public:
  Chunks(const std::filesystem::path& file, std::vector<Times> chunks)
      : ChunkedFile(file, std::ifstream(file), 0), chunks_(std::move(chunks)) {
    for (std::size_t k = 0; k < chunks_.size(); ++k)
      found_.push_back({k, 1, *std::ranges::min_element(chunks_[k]), true});
    sort_found();
    name_topic(0, topic_);
  }
  std::size_t loaded() const { return loaded_; }
  using ChunkedFile::leave_out;
  using ChunkedFile::note_cut;

 private:
  Status load(const Found& found) override {
    ++loaded_;
    if (chunks_[found.at].front() == 13) return failure("the disk is gone");
    for (const std::uint64_t time : chunks_[found.at]) {
      const auto block = std::make_shared<const Bytes>(Bytes{static_cast<std::uint8_t>(time)});
      hold(block, time, time % 2 == 0 ? 0 : 1, *block);
    }
    return {};
  }
  bool topics_are_named() override { return true; }
  ByteView cdr_of(const BagTopic&, ByteView data) override { return data; }

  std::vector<Times> chunks_;
  BagTopic topic_{"/a", "b"};
  std::size_t loaded_ = 0;
};

TEST(ChunkedFile, GivesMessagesOfOverlappingChunksByTimeAndLoadsNoneTooEarly) {
  const fleetmap::testing::TemporaryFolder folder;
  Chunks file(folder.write("f", ""), {{4, 2, 8}, {20, 22}, {6, 30}});
  Times times;
  std::vector<std::size_t> loaded;
  while (true) {
    const auto message = file.next();
    ASSERT_TRUE(message);
    if (!*message) break;
    EXPECT_EQ((*message)->cdr[0], (*message)->received_ns);
    times.push_back(static_cast<std::uint64_t>((*message)->received_ns));
    loaded.push_back(file.loaded());
  }
  EXPECT_EQ(times, (Times{2, 4, 6, 8, 20, 22, 30}));
  EXPECT_EQ(loaded, (std::vector<std::size_t>{1, 1, 2, 2, 3, 3, 3}));
}

TEST(ChunkedFile, KeepsTheFirstDamageAndTheCut) {
  const fleetmap::testing::TemporaryFolder folder;
  const auto path = folder.write("f", "");
  Chunks sound(path, {{2}});
  EXPECT_EQ(sound.damage(), "");
  Chunks cut(path, {{2}});
  cut.note_cut(0, "copy it again");
  EXPECT_EQ(cut.damage(),
            "f: its end is missing, 0 bytes of a record that was cut are left "
            "out; copy it again");
  EXPECT_EQ(cut.damaged_parts(), 1u);
  cut.leave_out("a chunk");
  cut.leave_out("another chunk");
  EXPECT_EQ(cut.damaged_parts(), 3u);
  EXPECT_TRUE(cut.damage().ends_with("copy it again; a chunk; it is left out, as will be others"));
}

TEST(ChunkedFile, LeavesOutWhatNoTopicNamesAndEndsAfterAnError) {
  const fleetmap::testing::TemporaryFolder folder;
  Chunks file(folder.write("f", ""), {{1, 2, 3}, {13}, {14}});
  EXPECT_EQ((*file.next())->received_ns, 2);
  EXPECT_FALSE(file.next());
  const auto after = file.next();
  EXPECT_TRUE(after && !*after);
}

}  // namespace
}  // namespace fleetmap::recording
