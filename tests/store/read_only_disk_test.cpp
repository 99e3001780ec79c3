#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <functional>

#include "fleetmap/store/store.hpp"
#include "store/items.hpp"

namespace fleetmap::store {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

constexpr const char* kNoMounts = "no mounts here";

const AgentId kDiskOwner = testing::agent("r1");

bool mount_disk(const fs::path& folder) {
  return (unshare(CLONE_NEWNS) == 0 || unshare(CLONE_NEWUSER | CLONE_NEWNS) == 0) &&
         mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
         mount("none", folder.c_str(), "tmpfs", 0, nullptr) == 0;
}

bool make_read_only(const fs::path& folder) {
  return mount("none", folder.c_str(), nullptr, MS_REMOUNT | MS_RDONLY, nullptr) == 0;
}

/// A disk that is mounted in a process of its own and becomes read-only between `fill` and `look`.
class ReadOnlyDisk : public ::testing::Test {
 protected:
  using Step = std::function<std::string(const fs::path& store)>;

  ReadOnlyDisk() { fs::create_directory(disk_); }

  /// The words of `look`, or those of `fill` if there are any.
  std::string said(const Step& fill, const Step& look) const {
    return said_in_child([&] { return said_on_disk(fill, look); });
  }
  static std::string said_in_child(const std::function<std::string()>& speak) {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) return "no pipe";
    const pid_t child = fork();
    if (child == 0) {
      const std::string words = speak();
      _exit(write(ends[1], words.data(), words.size()) == static_cast<ssize_t>(words.size()) ? 0 : 1);
    }
    close(ends[1]);
    std::array<char, 1000> text{};
    const ssize_t size = read(ends[0], text.data(), text.size());
    close(ends[0]);
    int status = 0;
    if (waitpid(child, &status, 0) != child || size < 0) return "no answer";
    return {text.data(), static_cast<std::size_t>(size)};
  }

  const testing::TemporaryFolder folder_;
  const fs::path disk_ = folder_ / "disk";

 private:
  std::string said_on_disk(const Step& fill, const Step& look) const {
    if (!mount_disk(disk_)) return kNoMounts;
    if (std::string words = fill(disk_ / "store.db"); !words.empty()) return words;
    return make_read_only(disk_) ? look(disk_ / "store.db") : kNoMounts;
  }
};

std::string make_store(const fs::path& file) {
  const auto store = Store::open(file, kDiskOwner);
  return store ? "" : store.error().message;
}

/// A store as a program leaves it that is killed: its log is not moved into its file.
std::string make_store_with_log(const fs::path& file) {
  auto store = Store::open(file, kDiskOwner);
  if (!store) return store.error().message;
  const Bytes submap = testing::random_bytes(2000, 1);
  const auto put = store->put_node_with_submap(testing::make_node(kDiskOwner, 0, submap), submap);
  if (!put) return put.error().message;
  const fs::path kept = file.parent_path() / "kept";
  for (const char* suffix : {"", "-wal"}) fs::copy_file(file.string() + suffix, kept.string() + suffix);
  store = tl::unexpected(Error{});
  for (const char* suffix : {"", "-wal"}) {
    fs::remove(file.string() + suffix);
    fs::rename(kept.string() + suffix, file.string() + suffix);
  }
  return "";
}

std::string read_store(const fs::path& file) {
  auto store = Store::open_read_only(file);
  if (!store) return store.error().message;
  if (store->put_node(testing::make_node(testing::agent("r2"), 7, Bytes{}))) return "took an item";
  std::string text = "read " + store->self().str() + ", beside it:";
  for (const auto& entry : fs::directory_iterator(file.parent_path()))
    if (entry.path() != file) text.append(" ").append(entry.path().filename().string());
  return text;
}

TEST_F(ReadOnlyDisk, AStoreThereIsNotOpenedForWritingAndItIsSaidWhatToDo) {
  const std::string words = said(make_store, make_store);
  if (words == kNoMounts) GTEST_SKIP() << words;
  EXPECT_THAT(words, AllOf(HasSubstr((disk_ / "store.db").string()), HasSubstr("read-only"),
                           HasSubstr("remount,rw")));
}

TEST_F(ReadOnlyDisk, AStoreThereIsReadAndNothingIsWrittenBesideIt) {
  const std::string words = said(make_store, read_store);
  if (words == kNoMounts) GTEST_SKIP() << words;
  EXPECT_EQ(words, "read r1, beside it: store.db.lock");
}

TEST_F(ReadOnlyDisk, AStoreInTheFolderOfAnotherUserIsReadAndNothingIsWrittenBesideIt) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can become another user";
  ASSERT_EQ(make_store(disk_ / "store.db"), "");
  for (const fs::path& folder : {folder_.path(), disk_}) fs::permissions(folder, fs::perms(0755));
  fs::permissions(disk_ / "store.db", fs::perms(0644));
  const std::string words = said_in_child([&] {
    constexpr uid_t kNobody = 65534;
    return seteuid(kNobody) == 0 ? read_store(disk_ / "store.db") : "still root";
  });
  EXPECT_EQ(words, "read r1, beside it: store.db.lock");
}

TEST_F(ReadOnlyDisk, OfAStoreWithALogItIsSaidThatBothAreToBeCopied) {
  const std::string words = said(make_store_with_log, read_store);
  if (words == kNoMounts) GTEST_SKIP() << words;
  EXPECT_THAT(words,
              AllOf(HasSubstr((disk_ / "store.db").string()), HasSubstr("-wal"), HasSubstr("copy both")));
}

}  // namespace
}  // namespace fleetmap::store
