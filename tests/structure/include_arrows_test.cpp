// The libraries' arrows, as docs/architecture.md draws them: a file of a library includes only what its row
// allows.
#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "source_tree.hpp"

namespace fleetmap {
namespace {

using structure::Include;
using structure::library_of;

const std::map<std::string, std::set<std::string>> kDirectArrows = {
    {"core", {}},
    {"trust", {"core"}},
    {"geometry", {"core"}},
    {"sensor", {"geometry"}},
    {"cloud", {"geometry"}},
    {"odometry", {"cloud", "sensor"}},
    {"localization", {"geometry", "sensor"}},
    {"place", {"geometry"}},
    {"registration", {"cloud"}},
    {"change", {"cloud"}},
    {"graph", {"geometry"}},
    {"messages", {"graph"}},
    {"orders", {"messages"}},
    {"store", {"cloud", "graph"}},
    {"monitor", {"store", "graph"}},
    {"exchange", {"orders", "store"}},
    {"bus", {"trust"}},
    {"ros_codec", {"sensor", "bus"}},
    {"fleet_codec", {"messages", "bus"}},
    {"loop_closure", {"exchange", "place", "registration", "fleet_codec"}},
    {"recording", {"ros_codec"}},
    {"sim", {"cloud", "sensor"}},
    {"planning", {"messages"}},
    {"output", {"store"}},
    {"eval", {"output"}},
    {"agent", {"odometry", "localization", "loop_closure", "planning", "ros_codec", "output", "trust"}},
    {"ros_output", {"monitor", "ros_codec"}},
    {"config", {"agent", "ros_output", "bus", "trust", "recording", "sim", "planning"}},
    {"fault_injection", {"agent"}},
    {"run_evaluation", {"config", "eval"}},
    {"experiment", {"config", "eval"}},
    {"apps", {"run_evaluation", "experiment", "fault_injection", "monitor", "change"}},
};

/// Third-party headers that only the named places may include.
const std::map<std::string, std::set<std::string>> kConfined = {
    {"^<(fastdds|fastrtps)/", {"src/bus/dds"}},
    {"^\"fleetmap/bus/dds_bus\\.", {"src/bus/dds", "src/apps"}},
    {"^\"\\.\\./", {}},
    {"^<fastcdr/", {"include/fleetmap/bus/cdr.hpp", "src/bus/dds/hello.cpp"}},
    {"^[<\"]yaml-cpp/", {"src/config", "src/recording"}},
    {"^<pcl/", {"src/registration/paper_registration.cpp"}},
    {"^<draco/", {"src/cloud"}},
    {"^<sqlite3", {"src/store", "src/recording", "src/fault_injection"}},
    {"^<GeographicLib/", {"src/geometry"}},
    {"^<(gdal|ogr|cpl)", {"src/output/geotiff_module.cpp"}},  // loaded when it is needed
    {"^<embree", {"src/sim"}},
    {"^<png", {"src/eval"}},
    {"^<boost/", {"src/experiment/student.cpp", "src/monitor/web_server.cpp"}},
    {"^<boost/(asio|beast)", {"src/monitor/web_server.cpp"}},  // seconds of CPU for each source
    {"^<openssl/", {"src/trust", "src/core/bytes.cpp", "src/core/file_hash.cpp"}},
};

/// Libraries that a library may include: its arrows and everything those may include.
std::set<std::string> allowed(const std::string& library) {
  std::set<std::string> all{library};
  for (const std::string& next : kDirectArrows.at(library)) {
    if (!kDirectArrows.contains(next)) continue;
    all.merge(allowed(next));
  }
  return all;
}

std::vector<Include> all_includes() {
  std::vector<Include> found;
  for (const char* root : {"include/fleetmap", "src"}) {
    for (const std::string& file : structure::cpp_files_below(root)) {
      const auto more = structure::includes_of(file);
      found.insert(found.end(), more.begin(), more.end());
    }
  }
  return found;
}

TEST(IncludeArrows, EveryLibraryHasARow) {
  const auto includes = all_includes();
  ASSERT_GT(includes.size(), 100u) << "the scan found hardly any include: is FLEETMAP_SOURCE_DIR right?";
  for (const Include& include : includes) {
    EXPECT_TRUE(kDirectArrows.contains(library_of(include.file)))
        << include.file << " belongs to no known library";
  }
}

TEST(IncludeArrows, FleetmapIncludesFollowTheArrows) {
  for (const Include& include : all_includes()) {
    const std::string prefix = "\"fleetmap/";
    if (!include.target.starts_with(prefix)) continue;
    const std::string to =
        include.target.substr(prefix.size(), include.target.find('/', prefix.size()) - prefix.size());
    const std::string from = library_of(include.file);
    EXPECT_TRUE(allowed(from).contains(to))
        << include.file << ":" << include.line << ": " << from << " may not include " << to;
  }
}

TEST(IncludeArrows, ThirdPartyHeadersStayWhereTheyBelong) {
  for (const Include& include : all_includes()) {
    for (const auto& [pattern, places] : kConfined) {
      if (!std::regex_search(include.target, std::regex(pattern))) continue;
      bool at_home = false;
      for (const std::string& place : places) at_home |= include.file.starts_with(place);
      EXPECT_TRUE(at_home) << include.file << ":" << include.line << ": " << include.target;
    }
  }
}

TEST(IncludeArrows, OnlyTheWebServerCompilesBeast) {
  for (const std::string& file : structure::cpp_files_below("tests")) {
    for (const Include& include : structure::includes_of(file))
      EXPECT_FALSE(std::regex_search(include.target, std::regex("^<boost/(asio|beast)")))
          << file << ":" << include.line << ": " << include.target;
  }
}

TEST(IncludeArrows, PublicHeadersAreIncludedByTheirFullName) {
  for (const Include& include : all_includes()) {
    if (!include.file.starts_with("include/") || include.target.front() != '"') continue;
    EXPECT_TRUE(include.target.starts_with("\"fleetmap/")) << include.file << ":" << include.line;
  }
}

}  // namespace
}  // namespace fleetmap
