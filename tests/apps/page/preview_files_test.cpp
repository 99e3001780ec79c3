#include "page/preview_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "apps/driven_days.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::ElementsAre;

class PreviewFilesTest : public ::testing::Test {
 protected:
  std::filesystem::path path(const std::string& name) const { return days_.path(name); }
  /// All submaps of `store` have previews in `file`.
  static bool holds_all(const std::filesystem::path& store, const std::filesystem::path& file) {
    const auto opened = store::Store::open_read_only(store).value();
    monitor::PreviewWriter previews(file);
    return !opened.nodes().empty() && std::ranges::all_of(opened.nodes(), [&](const auto& entry) {
      return previews.keep(entry.second.submap_hash);
    });
  }
  DrivenDays days_;
};

TEST_F(PreviewFilesTest, OfAStoreLieBesideItAndOfARunInItsFolder) {
  EXPECT_EQ(previews_of_store("out/r1/store.db"), "out/r1/store.db.previews");
  EXPECT_EQ(previews_of_run("out"), "out/monitor.previews");
}

TEST_F(PreviewFilesTest, ThoseOfTheRunServeARobotsStoreAndThoseOfTheRobotsTheRun) {
  EXPECT_THAT(more_previews_of_store(path("out/r1/store.db")), ElementsAre(path("out/monitor.previews")));
  EXPECT_THAT(more_previews_of_run(path("out")), ElementsAre());
  std::filesystem::create_directories(path("out/r1"));
  days_.drive("out/r1/store.db", 0, {0.0, 0.0, 0.0});
  EXPECT_THAT(more_previews_of_run(path("out")), ElementsAre(path("out/r1/store.db.previews")));
}

TEST_F(PreviewFilesTest, AllSubmapsOfAStoreAreKept) {
  days_.drive("a.db", 0, {0.0, 0.0, 0.0});
  keep_previews(path("a.db"), {});
  EXPECT_TRUE(holds_all(path("a.db"), path("a.db.previews")));
  std::filesystem::rename(path("a.db.previews"), path("b.db.previews"));
  keep_previews(path("a.db"), {path("b.db")});
  EXPECT_TRUE(holds_all(path("a.db"), path("a.db.previews"))) << "from those of a source";
}

TEST_F(PreviewFilesTest, NothingFailsWhereTheyCannotBeMade) {
  keep_previews(path("none.db"), {});
  monitor::PreviewWriter previews(path("none/store.db.previews"));
  previews.add({}, {});
  write_or_log(previews);
  EXPECT_FALSE(std::filesystem::exists(path("none")));
}

}  // namespace
}  // namespace fleetmap::apps
