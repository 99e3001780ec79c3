#include "monitor/content.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "monitor/page_files.hpp"
#include "monitor/views.hpp"
#include "store/items.hpp"

namespace fleetmap::monitor {
namespace {

using ::testing::HasSubstr;
using testing::kFile;
using ::testing::StartsWith;
using testing::ViewMaker;

constexpr PageFile kTwoFiles[] = {{"/index.html", "text/html", kFile},
                                  {"/main.js", "text/javascript", kFile}};

cloud::PointCloud cloud_of(std::size_t points) {
  cloud::PointCloud cloud;
  for (std::size_t k = 0; k < points; ++k) cloud.points.emplace_back(static_cast<float>(k), 1.0f, 2.0f);
  return cloud;
}

TEST(Content, gives_the_page_by_exact_path_alone) {
  Content content(kTwoFiles, {}, 1000);
  EXPECT_EQ(content.reply("/").type, "text/html");
  EXPECT_TRUE(content.reply("/main.js").gzip);
  for (const char* path : {"/main.js/", "/../main.js", "//main.js", "/%2e%2e/etc/passwd", "/etc/passwd",
                           "main.js", "", "/MAIN.JS"})
    EXPECT_EQ(content.reply(path).status, 404u) << path;
}

TEST(Content, without_a_page_it_tells_so) {
  Content content({}, {}, 1000);
  const Reply reply = content.reply("/");
  EXPECT_EQ(reply.status, 200u);
  EXPECT_THAT(reply.body, HasSubstr("/state.json"));
  EXPECT_EQ(content.reply("/main.js").status, 404u);
}

TEST(Content, submaps_of_the_shown_view_are_loaded_once) {
  int loads = 0;
  Content content(
      kTwoFiles,
      [&](const NodeId&, const ContentHash&) {
        ++loads;
        return Result<cloud::PointCloud>(cloud_of(100));
      },
      1 << 20);
  ViewMaker fleet;
  fleet.robot("r1", 0, 1);
  const std::string target = "/submap/" + to_hex(fleet.view.nodes[0].submap_hash) + "?from=0&count=40";
  EXPECT_EQ(content.reply(target).status, 404u) << "nothing is shown yet";
  content.show(fleet.view);
  for (int k = 0; k < 3; ++k) {
    const Reply reply = content.reply(target);
    EXPECT_EQ(reply.status, 200u);
    EXPECT_TRUE(reply.immutable);
    EXPECT_EQ(reply.body.size(), kPointHeaderBytes + 8 * 40);
    EXPECT_THAT(reply.body, StartsWith("FMP1"));
  }
  EXPECT_EQ(loads, 1);
  fleet.view.has_submap[0] = false;
  content.show(fleet.view);
  EXPECT_EQ(content.reply(target).status, 404u) << "not held any more";
}

TEST(Content, a_submap_that_cannot_be_read_is_no_end) {
  Content content(
      kTwoFiles,
      [](const NodeId&, const ContentHash&) -> Result<cloud::PointCloud> { return failure("disk error"); },
      1000);
  ViewMaker fleet;
  fleet.robot("r1", 0, 1);
  content.show(fleet.view);
  const Reply reply = content.reply("/submap/" + to_hex(fleet.view.nodes[0].submap_hash) + "?from=0&count=1");
  EXPECT_EQ(reply.status, 503u);
  EXPECT_THAT(reply.body, HasSubstr("disk error"));
}

/// A fleet of so many nodes, and what is asked of it.
class ManySubmaps : public ::testing::Test {
 protected:
  ManySubmaps() {
    fleet.robot("r1", 0, 40);
    for (std::size_t k = 0; k < 40; ++k)
      fleet.view.nodes[k].submap_hash[0] = static_cast<std::uint8_t>(k + 1);
    content.show(fleet.view);
  }
  std::string hash(std::size_t k) const { return to_hex(fleet.view.nodes[k].submap_hash); }
  std::string ask(std::size_t count, std::initializer_list<std::size_t> nodes = {}) {
    std::string target = "/submaps?from=0&count=" + std::to_string(count) + "&of=";
    for (std::size_t k = 0; k < 40 && nodes.size() == 0; ++k) target += hash(k) + (k < 39 ? "," : "");
    for (const std::size_t k : nodes) target += (target.back() == '=' ? "" : ",") + hash(k);
    return content.reply(target).body;
  }

  ViewMaker fleet;
  int loads = 0;
  bool broken = false;
  Content content{kTwoFiles,
                  [this](const NodeId&, const ContentHash&) -> Result<cloud::PointCloud> {
                    ++loads;
                    if (broken) return failure("disk error");
                    return cloud_of(3000);
                  },
                  1 << 20};
};

TEST_F(ManySubmaps, come_in_one_answer_each_after_its_hash) {
  constexpr std::size_t kPart = 32 + kPointHeaderBytes + 8 * 100;
  const std::string both = ask(100, {0, 1});
  ASSERT_EQ(both.size(), 2 * kPart);
  for (const std::size_t k : {0u, 1u}) {
    const std::string one = content.reply("/submap/" + hash(k) + "?from=0&count=100").body;
    EXPECT_EQ(both.substr(k * kPart, kPart), hash(k) + one);
  }
  EXPECT_EQ(ask(5000, {0}).size(), 32 + kPointHeaderBytes + 8 * Content::kCoarsePoints)
      << "the first ones alone";
  const std::string later = content.reply("/submaps?from=100&count=50&of=" + hash(0)).body;
  EXPECT_EQ(later, hash(0) + content.reply("/submap/" + hash(0) + "?from=100&count=50").body);
}

TEST_F(ManySubmaps, previews_are_made_once_and_spread_over_the_site) {
  std::vector<std::string> order;
  while (content.misses_previews()) {
    const auto [hash, make] = content.begin_preview();
    order.push_back(hash);
    content.end_preview(hash, make());
  }
  EXPECT_EQ(std::set(order.begin(), order.end()).size(), 40u);
  EXPECT_EQ(loads, 40);
  EXPECT_EQ(order[0], hash(0));
  EXPECT_EQ(order[1], hash(32));
  EXPECT_EQ(order[2], hash(16)) << "the first ones are far apart";
  EXPECT_EQ(ask(10).size(), 40 * (32 + kPointHeaderBytes + 8 * 10)) << "all are at hand";
  content.show(fleet.view);
  EXPECT_FALSE(content.misses_previews()) << "a newer state decodes nothing again";
  EXPECT_EQ(loads, 40);
}

TEST_F(ManySubmaps, previews_that_were_kept_are_not_made_again) {
  while (content.misses_previews()) {
    const auto [hash, make] = content.begin_preview();
    content.end_preview(hash, make());
  }
  EXPECT_EQ(content.new_previews(), 40u);
  const Previews kept = content.previews();
  EXPECT_EQ(kept.size(), 40u);
  EXPECT_EQ(content.new_previews(), 0u);

  Content later(
      kTwoFiles,
      [](const NodeId&, const ContentHash&) -> Result<cloud::PointCloud> { return failure("not asked"); },
      1 << 20);
  later.keep(kept);
  EXPECT_TRUE(later.previews().empty()) << "nothing is shown yet";
  ViewMaker more = fleet;
  more.robot("r2", 0, 1);
  more.view.nodes[40].submap_hash[0] = 41;
  later.show(more.view);
  EXPECT_EQ(later.previews().size(), 40u);
  EXPECT_EQ(later.kept_previews(), 40u);
  ASSERT_TRUE(later.misses_previews());
  EXPECT_EQ(later.begin_preview().first, to_hex(more.view.nodes[40].submap_hash));
  EXPECT_FALSE(later.misses_previews());
  EXPECT_EQ(later.reply("/submaps?from=0&count=10&of=" + hash(3)).body, ask(10, {3}));
}

TEST_F(ManySubmaps, what_is_being_made_comes_later_unless_nothing_else_is_there) {
  constexpr std::size_t kPart = 32 + kPointHeaderBytes + 8 * 10;
  const auto [first, make] = content.begin_preview();
  EXPECT_EQ(ask(10, {0, 1}).size(), kPart) << "the second one";
  EXPECT_EQ(ask(10, {0}).size(), kPart) << "an empty answer would be an error for the page";
  content.end_preview(first, make());
  EXPECT_EQ(ask(10, {0, 1}).size(), 2 * kPart);
}

TEST_F(ManySubmaps, a_preview_that_cannot_be_read_is_told_to_who_asks) {
  broken = true;
  while (content.misses_previews()) {
    const auto [hash, make] = content.begin_preview();
    content.end_preview(hash, make());
  }
  EXPECT_EQ(ask(10, {3}).size(), 32 + kPointHeaderBytes) << "its hash, and no point";
}

TEST_F(ManySubmaps, an_answer_decodes_some_at_a_time_and_none_twice) {
  constexpr std::size_t kPart = 32 + kPointHeaderBytes + 8 * 10;
  EXPECT_EQ(ask(10).size(), Content::kDecodedAtOnce * kPart);
  EXPECT_EQ(ask(10).size(), 2 * Content::kDecodedAtOnce * kPart);
  EXPECT_EQ(ask(10).size(), 40 * kPart);
  EXPECT_EQ(loads, 40);
  EXPECT_EQ(ask(10).size(), 40 * kPart);
  EXPECT_EQ(loads, 40);
}

TEST_F(ManySubmaps, what_cannot_be_read_is_empty_and_what_is_not_shown_is_left_out) {
  broken = true;
  EXPECT_EQ(ask(10, {3}).size(), 32 + kPointHeaderBytes);
  broken = false;
  EXPECT_EQ(ask(10, {3}).size(), 32 + kPointHeaderBytes + 80) << "a disk may recover";
  EXPECT_EQ(content.reply("/submaps?from=0&count=1&of=" + std::string(32, '0')).body, "");
  EXPECT_EQ(content.reply("/submaps?from=0&count=1&of=../../etc/passwd").status, 400u);
}

TEST(PointCache, drops_what_was_used_longest_ago) {
  const auto cloud = std::make_shared<const QuantisedCloud>(quantised(cloud_of(100)));  // 800 bytes
  PointCache cache(1700);
  cache.keep("a", cloud);
  cache.keep("b", cloud);
  EXPECT_TRUE(cache.find("a"));
  cache.keep("c", cloud);
  EXPECT_TRUE(cache.find("a"));
  EXPECT_FALSE(cache.find("b"));
  EXPECT_TRUE(cache.find("c"));
  PointCache tiny(1);
  tiny.keep("a", cloud);
  EXPECT_TRUE(tiny.find("a")) << "the last one stays, however large";
}

}  // namespace
}  // namespace fleetmap::monitor
