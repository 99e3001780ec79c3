#include "devices/device_input.hpp"

#include <gmock/gmock.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <sstream>

#include "apps/devices/patience.hpp"
#include "support/eventually.hpp"
#include "support/occurrences.hpp"
#include "support/pseudo_terminal.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::apps {
namespace {

using fleetmap::testing::eventually;
using fleetmap::testing::occurrences;
using fleetmap::testing::PseudoTerminal;
using namespace std::chrono_literals;

/// A device behind a link whose target comes and goes, as those of udev do.
class DeviceInputTest : public ::testing::Test {
 protected:
  void SetUp() override {
    before_ = spdlog::default_logger();
    spdlog::set_default_logger(std::make_shared<spdlog::logger>(
        "test", std::make_shared<spdlog::sinks::ostream_sink_mt>(log_, /*force_flush=*/true)));
  }
  void TearDown() override {
    input_.reset();
    spdlog::set_default_logger(before_);
  }
  void plug_in() {
    device_.emplace();
    std::filesystem::create_symlink(device_->path(), link_);
  }
  void unplug() {
    std::filesystem::remove(link_);
    device_.reset();
  }
  void start() {
    input_ = std::make_unique<DeviceInput>(
        agent::SerialPort{link_, 57600}, DeviceInput::Handlers{.on_bytes =
                                                                   [this](ByteView bytes, Stamp) {
                                                                     const std::scoped_lock lock(mutex_);
                                                                     received_.append(bytes.begin(),
                                                                                      bytes.end());
                                                                   },
                                                               .greeting =
                                                                   [] {
                                                                     return Bytes{'h', 'i'};
                                                                   },
                                                               .request = [](Stamp) { return Bytes{'?'}; }});
  }
  bool receives(const std::string& text) {
    return eventually(
        [&] {
          const std::scoped_lock lock(mutex_);
          return received_ == text;
        },
        kPatience);
  }
  bool sends(const std::string& text) {
    std::string sent;
    return eventually(
        [&] {
          const Bytes bytes = device_->receive();
          sent.append(bytes.begin(), bytes.end());
          return sent.starts_with(text);
        },
        kPatience);
  }

  fleetmap::testing::TemporaryFolder folder_;
  std::filesystem::path link_ = folder_.path() / "autopilot";
  std::optional<PseudoTerminal> device_;
  std::ostringstream log_;  ///< read when the input has ended
  std::shared_ptr<spdlog::logger> before_;
  std::mutex mutex_;
  std::string received_;
  std::unique_ptr<DeviceInput> input_;
};

TEST_F(DeviceInputTest, ADeviceThatVanishesIsReadAgainWhenItComesBack) {
  start();  // before it is plugged in
  plug_in();
  ASSERT_TRUE(sends("hi"));
  ASSERT_TRUE(device_->send(bytes_of("one")));
  ASSERT_TRUE(receives("one"));
  ASSERT_TRUE(sends("?"));
  unplug();
  plug_in();
  ASSERT_TRUE(sends("hi")) << "a greeting for each connection";
  ASSERT_TRUE(device_->send(bytes_of("two")));
  ASSERT_TRUE(receives("onetwo"));
  EXPECT_EQ(input_->trouble(), "") << "it is heard";
  input_.reset();
  const std::string log = log_.str();
  EXPECT_LE(occurrences(log, "no such device"), 2u) << log;
  EXPECT_EQ(occurrences(log, "autopilot: heard"), 2u) << log;
}

TEST_F(DeviceInputTest, AMissingDeviceIsSaidOnce) {
  start();
  const auto begun = std::chrono::steady_clock::now();  // several tries
  ASSERT_TRUE(eventually([&] { return std::chrono::steady_clock::now() - begun > 3500ms; }, kPatience));
  EXPECT_THAT(input_->trouble(),
              ::testing::EndsWith("autopilot: no such device; plug it in, or correct the path"));
  input_.reset();
  EXPECT_EQ(
      occurrences(log_.str(),
                  "autopilot: no such device; plug it in, or correct the path; tried again every second"),
      1u)
      << log_.str();
}

TEST_F(DeviceInputTest, ADeviceThatSendsNothingIsSaidOnce) {
  plug_in();
  start();
  ASSERT_TRUE(sends("hi"));
  const auto begun = std::chrono::steady_clock::now();
  ASSERT_TRUE(eventually([&] { return std::chrono::steady_clock::now() - begun > 6500ms; }, kPatience));
  input_.reset();
  EXPECT_EQ(occurrences(log_.str(), "autopilot: sends nothing; check its power"), 1u) << log_.str();
}

TEST_F(DeviceInputTest, EndsWhileTheDeviceIsMissing) {
  start();
  const auto begun = std::chrono::steady_clock::now();
  input_.reset();
  EXPECT_LT(std::chrono::steady_clock::now() - begun, kPatience);
}

}  // namespace
}  // namespace fleetmap::apps
