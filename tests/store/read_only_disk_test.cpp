#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>

#include "fleetmap/store/store.hpp"
#include "store/items.hpp"

namespace fleetmap::store {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr const char* kNoMounts = "no mounts here";

/// The error of opening a store on a disk that was mounted read-only after the store had been made.
std::string refusal_on_a_read_only_disk(const std::filesystem::path& folder) {
  const AgentId self = testing::agent("r1");
  const bool mounted = (unshare(CLONE_NEWNS) == 0 || unshare(CLONE_NEWUSER | CLONE_NEWNS) == 0) &&
                       mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
                       mount("none", folder.c_str(), "tmpfs", 0, nullptr) == 0;
  if (!mounted) return kNoMounts;
  if (const auto made = Store::open(folder / "store.db", self); !made) return made.error().message;
  if (mount("none", folder.c_str(), nullptr, MS_REMOUNT | MS_RDONLY, nullptr) != 0) return kNoMounts;
  const auto store = Store::open(folder / "store.db", self);
  return store ? "opened" : store.error().message;
}

TEST(ReadOnlyDisk, AStoreThereIsRefusedWithItsPathAndWhatToDo) {
  const testing::TemporaryFolder folder;
  const std::filesystem::path disk = folder / "disk";
  std::filesystem::create_directory(disk);
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  const pid_t child = fork();
  if (child == 0) {
    const std::string said = refusal_on_a_read_only_disk(disk);
    _exit(write(ends[1], said.data(), said.size()) == static_cast<ssize_t>(said.size()) ? 0 : 1);
  }
  close(ends[1]);
  std::array<char, 1000> text{};
  const ssize_t size = read(ends[0], text.data(), text.size());
  close(ends[0]);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_GT(size, 0);
  const std::string said(text.data(), static_cast<std::size_t>(size));
  if (said == kNoMounts) GTEST_SKIP() << said;
  EXPECT_THAT(
      said, AllOf(HasSubstr((disk / "store.db").string()), HasSubstr("read-only"), HasSubstr("remount,rw")));
}

}  // namespace
}  // namespace fleetmap::store
