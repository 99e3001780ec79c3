#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>

#include "bus/dds_domains.hpp"
#include "fleetmap/bus/dds_bus.hpp"
#include "support/file_content.hpp"

namespace fleetmap::bus::testing {

namespace fs = std::filesystem;

/// A copy of the shipped profiles that a test may spoil.
class QosDirectory : public ::testing::Test {
 protected:
  void SetUp() override {
    directory_ = fs::path(::testing::TempDir()) / ("fleetmap-qos-" + std::to_string(getpid()));
    fs::remove_all(directory_);
    fs::copy(FLEETMAP_SOURCE_DIR "/qos", directory_);
    config_.agent = AgentId::parse("r1").value();
    config_.qos_directory = directory_;
    config_.onboard.domain = first_test_domain();
    config_.long_range.domain = first_test_domain() + 1;
    config_.short_range.domain = first_test_domain() + 2;
    config_.long_range.address = config_.short_range.address = "127.0.0.1";
  }
  void TearDown() override { fs::remove_all(directory_); }

  void replace(const std::string& file, const std::string& from, const std::string& to) {
    std::string text = fleetmap::testing::file_text(directory_ / file);
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    std::ofstream(directory_ / file) << text;
  }
  std::string error() const {
    const auto bus = DdsBus::create(config_);
    return bus ? "none" : bus.error().message;
  }

  /// False after a minute without `done()`.
  static bool run_both(DdsBus& first, DdsBus& second, const std::function<bool()>& done) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (std::chrono::steady_clock::now() < deadline) {
      for (DdsBus* bus : {&first, &second}) {
        if (bus->run_until(done, std::chrono::milliseconds(5))) return true;
      }
    }
    return false;
  }

  fs::path directory_;
  DdsBusConfig config_;
};

}  // namespace fleetmap::bus::testing
