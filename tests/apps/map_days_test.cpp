// Maps of one site on several days: `fleetmap map merge` aligns them, `fleetmap map diff` finds what changed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <memory>

#include "fleetmap/cloud/kd_tree.hpp"
#include "fleetmap/config/world_file.hpp"
#include "fleetmap/core/file_hash.hpp"
#include "fleetmap/output/placed_store.hpp"
#include "fleetmap/output/trajectory_file.hpp"
#include "fleetmap/sim/ground_truth.hpp"
#include "small_twin.hpp"
#include "support/command_line.hpp"
#include "support/file_content.hpp"
#include "support/process.hpp"

namespace fleetmap {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using Points = std::vector<Eigen::Vector3f>;

const GeoPoint kOrigin = geo_point_from_degrees(39.0, -3.0, 600.0);

/// A farm of 20 tables, in which one robot drives; on the second day some tables are gone and there is a
/// fence.
class MapDays : public ::testing::Test {
 protected:
  struct Day {
    double missing_tables = 0.0;
    bool fence = false;
    int session = 0;
    std::vector<std::string> more = {};
  };
  MapDays() { drive("monday", {}); }

  void drive(const std::string& name, const Day& day) {
    const std::string fence = day.fence ? "true" : "false";
    twin_.write(
        name + ".yaml",
        "kind: solar_farm\nseed: 1\nsize: [50, 36]\nmargin: 8\nheadland: 6\nrow_pitch: 8\ntable_length: 6\n"
        "road_every: 0\ncabins: 1\ntrees: 8\nterrain_cell: 0.5\n"
        "terrain: {rolling_amplitude: 0.15, rolling_wavelength: 30}\nmissing_tables: " +
            std::to_string(day.missing_tables) + "\nfence: {enabled: " + fence + "}\n");
    fs::copy_file(twin_.path(name + ".yaml"), twin_.path("world.yaml"), fs::copy_options::overwrite_existing);
    twin_.write_fleet("", {"robot: {seed: " + std::to_string(day.session + 7) + "}"});
    std::vector<std::string> arguments{"--agents", "1", "--first-session", std::to_string(day.session)};
    arguments.insert(arguments.end(), day.more.begin(), day.more.end());
    const auto run = twin_.run(name, arguments);
    EXPECT_EQ(run.exit_code, 0) << run.output;
  }

  std::string store_of(const std::string& day) const { return twin_.path(day + "/r1/store.db").string(); }

  int map(const std::vector<std::string>& arguments) {
    std::vector<std::string> all{testing::kProgram, "map"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    testing::Process process(all);
    const int exit_code = process.wait();
    output_ = process.output();
    return exit_code;
  }

  /// Mean over the nodes of a day of their place less the true one, m.
  Eigen::Vector2d error_of(const std::string& day, const std::map<NodeId, Pose>& T_enu_node) const {
    const auto truth = output::read_tum(twin_.path(day + "/r1/truth.tum")).value();
    const auto store = store::Store::open_read_only(store_of(day)).value();
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (const auto& [id, node] : store.nodes()) {
      const auto at = std::ranges::lower_bound(truth, node.stamp, {}, &output::StampedPose::stamp);
      EXPECT_NE(at, truth.end());
      if (at != truth.end()) sum += (T_enu_node.at(id).translation() - at->T_w_base.translation()).head<2>();
    }
    return sum / static_cast<double>(store.nodes().size());
  }
  static std::map<NodeId, Pose> placed(const std::string& store) {
    return output::place(store::Store::open_read_only(store).value(), kOrigin, {}).T_enu_node;
  }

  /// Surfaces of one day's world that the other one does not have.
  Points only_in(const std::string& day, const std::string& other) const {
    const auto surface = [this](const std::string& name) {
      const auto world = sim::build_world(config::load_world(twin_.path(name + ".yaml")).value()).value();
      return sim::ground_truth(*world, 100.0, 1, 5'000'000);
    };
    const cloud::KdTree tree(surface(other));
    Points points;
    for (const Eigen::Vector3f& point : surface(day).points) {
      if (!tree.nearest(point, 0.5f)) points.push_back(point);
    }
    return points;
  }
  /// Points of the coloured map with this much green or red.
  static Points coloured(const fs::path& ply, bool appeared) {
    const std::string bytes = testing::file_text(ply);
    const std::string end = "end_header\n";
    Points points;
    for (std::size_t at = bytes.find(end) + end.size(); at + 15 <= bytes.size(); at += 15) {
      const auto red = static_cast<unsigned char>(bytes[at + 12]),
                 green = static_cast<unsigned char>(bytes[at + 13]);
      if (appeared ? green < red + 100 : red < green + 100) continue;
      std::memcpy(points.emplace_back().data(), bytes.data() + at, 12);
    }
    return points;
  }
  static Points moved_by(const Eigen::Vector2d& shift, Points points) {
    for (Eigen::Vector3f& point : points) point.head<2>() += shift.cast<float>();
    return points;
  }
  static double share_near(const Points& of, const Points& others, float distance) {
    if (of.empty()) return 0.0;
    const cloud::KdTree tree(others);
    const auto near = std::ranges::count_if(
        of, [&](const auto& point) { return tree.nearest(point, distance).has_value(); });
    return static_cast<double>(near) / static_cast<double>(of.size());
  }

  testing::SmallTwin twin_;
  std::string output_;
};

TEST_F(MapDays, MergedFitEachOtherThoughGpsDoesNotAndNothingHasChanged) {
  drive("tuesday", {.session = 1000});
  const std::string merged = twin_.path("merged.db").string();
  ASSERT_EQ(map({"merge", store_of("monday"), store_of("tuesday"), "--out", merged}), 0) << output_;
  EXPECT_THAT(output_, AllOf(HasSubstr(": joined by "), Not(HasSubstr("NOT joined"))));
  const auto before = placed(store_of("monday")), after = placed(store_of("tuesday"));
  const double by_gps = (error_of("monday", before) - error_of("tuesday", after)).norm();
  const auto joined = placed(merged);
  const double aligned = (error_of("monday", joined) - error_of("tuesday", joined)).norm();
  RecordProperty("by_gps_mm", static_cast<int>(1000 * by_gps));
  RecordProperty("aligned_mm", static_cast<int>(1000 * aligned));
  EXPECT_GT(by_gps, 0.3) << "or there is nothing to be gained";
  EXPECT_LT(aligned, 0.05);
  for (const char* what : {"info", "export", "tracks", "graph"}) {
    const std::string format = what == std::string("tracks")  ? ".gpx"
                               : what == std::string("graph") ? ".g2o"
                                                              : ".ply";
    std::vector<std::string> arguments{what, merged};
    if (what != std::string("info"))
      arguments.insert(arguments.end(), {"--out", twin_.path(what + format).string()});
    EXPECT_EQ(map(arguments), 0) << what << output_;
  }
  const std::string hash = to_hex(file_hash(merged).value());
  ASSERT_EQ(map({"merge", store_of("monday"), store_of("tuesday"), "--out", merged}), 1);
  EXPECT_THAT(output_, HasSubstr("exists")) << "nothing is overwritten";
  EXPECT_EQ(to_hex(file_hash(merged).value()), hash);
  ASSERT_EQ(map({"diff", store_of("monday"), store_of("tuesday")}), 0) << output_;
  EXPECT_THAT(output_, HasSubstr("\n0 changes: 0 appeared, 0 disappeared\n"));
}

TEST_F(MapDays, StoresWithoutOverlapOrOfOneRunAreNotJoined) {
  drive("elsewhere",
        {.session = 3000, .more = {"--set", "site.origin=[39.02, -3.0, 600.0]", "--set", "max_time=30"}});
  const fs::path merged = twin_.path("apart");
  ASSERT_EQ(map({"merge", store_of("monday"), store_of("elsewhere"), "--out", merged.string()}), 0)
      << output_;
  EXPECT_THAT(output_,
              AllOf(HasSubstr("NOT joined: they do not overlap: by GPS their paths come no nearer than 2"),
                    HasSubstr("2 parts that no alignment joins")));
  EXPECT_TRUE(fs::exists(merged / "store.db"));
  EXPECT_EQ(map({"diff", store_of("monday"), store_of("elsewhere")}), 1);
  EXPECT_THAT(output_, HasSubstr("cannot be aligned: they do not overlap"));
  EXPECT_EQ(map({"diff", store_of("monday"), store_of("monday")}), 1);
  EXPECT_THAT(output_, HasSubstr("share an odometry session"));
}

TEST_F(MapDays, TablesThatWentAndAFenceThatCameAreFound) {
  drive("changed", {.missing_tables = 0.2, .fence = true, .session = 2000});
  const fs::path ply = twin_.path("changes.ply"), geojson = twin_.path("changes.geojson");
  ASSERT_EQ(map({"diff", store_of("monday"), store_of("changed"), "--ply", ply.string(), "--geojson",
                 geojson.string()}),
            0)
      << output_;
  // GPS has moved the map as a whole.
  const std::string merged = twin_.path("with_changes.db").string();
  ASSERT_EQ(map({"merge", store_of("monday"), store_of("changed"), "--out", merged}), 0) << output_;
  const Eigen::Vector2d moved = error_of("monday", placed(merged));
  const Points gone = moved_by(moved, only_in("monday", "changed"));
  const Points come = moved_by(moved, only_in("changed", "monday"));
  ASSERT_GT(gone.size(), 1000u) << "tables";
  ASSERT_GT(come.size(), 1000u) << "the fence";
  // GPS has also turned the map, by half a metre at the corners.
  constexpr float kNear = 1.0f;  // m
  const Points found_gone = coloured(ply, false), found_come = coloured(ply, true);
  EXPECT_GT(share_near(found_gone, gone, kNear), 0.95);
  EXPECT_GT(share_near(found_come, come, kNear), 0.95);
  EXPECT_GT(share_near(gone, found_gone, kNear), 0.6) << "of all tables that went";
  EXPECT_GT(share_near(come, found_come, kNear), 0.5) << "of the whole fence";
  std::ifstream file(geojson);
  const auto features = nlohmann::json::parse(file)["features"];
  const auto tables = std::ranges::count_if(
      features, [](const auto& feature) { return feature["properties"]["kind"] == "disappeared"; });
  EXPECT_EQ(tables, 2) << features.dump(1);
}

}  // namespace
}  // namespace fleetmap
