// The profile files in qos/: the shipped ones are accepted, faulty ones are refused with file and line.
#include <gmock/gmock.h>

#include <sstream>

#include "bus/qos_directory.hpp"

namespace fleetmap::bus::testing {
namespace {

using ::testing::HasSubstr;

TEST_F(QosDirectory, TheShippedProfilesAreAccepted) { EXPECT_EQ(error(), "none"); }

TEST_F(QosDirectory, AMissingFileIsNamed) {
  fs::remove(directory_ / "long_range.xml");
  EXPECT_THAT(error(), HasSubstr((directory_ / "long_range.xml").string() + ": cannot be read"));
}

TEST_F(QosDirectory, AMissingDirectoryIsNamed) {
  config_.qos_directory = directory_ / "nowhere";
  EXPECT_THAT(error(), HasSubstr("nowhere/onboard.xml: cannot be read"));
}

TEST_F(QosDirectory, MalformedXmlIsNamedWithItsLine) {
  replace("onboard.xml", "</transport_descriptors>", "</transport_descriptor>");
  EXPECT_THAT(error(), ::testing::ContainsRegex("onboard\\.xml:[0-9]+: is not well-formed XML"));
}

TEST_F(QosDirectory, AnEmptyFileIsNotWellFormed) {
  std::ofstream(directory_ / "onboard.xml") << "";
  EXPECT_THAT(error(), HasSubstr("is not well-formed XML"));
}

TEST_F(QosDirectory, AnotherRootElementIsRefused) {
  std::ofstream(directory_ / "short_range.xml") << "<?xml version=\"1.0\"?>\n<qos/>\n";
  EXPECT_THAT(error(),
              HasSubstr("short_range.xml:2: the root element is <qos>; expected <dds> or <profiles>"));
}

TEST_F(QosDirectory, AnUnknownElementIsNamedWithItsLineAndWhatMayStandThere) {
  replace("long_range.xml", "<depth>32</depth>", "<deepth>32</deepth>");
  EXPECT_THAT(error(),
              ::testing::ContainsRegex("long_range\\.xml:[0-9]+: unknown element <deepth> in <historyQos>; "
                                       "expected one of <kind>, <depth>"));
}

TEST_F(QosDirectory, AValueOfTheWrongKindIsNamed) {
  replace("onboard.xml", "<depth>5</depth>", "<depth>five</depth>");
  EXPECT_THAT(error(), HasSubstr("<depth> is \"five\"; expected a whole number >= 0"));
}

TEST_F(QosDirectory, AnUnknownWordIsNamed) {
  replace("short_range.xml", "<kind>BEST_EFFORT</kind>", "<kind>BEST_EFORT</kind>");
  EXPECT_THAT(error(), HasSubstr("<kind> is \"BEST_EFORT\"; expected one of BEST_EFFORT|RELIABLE"));
}

TEST_F(QosDirectory, ADefaultProfileIsRefusedSinceItWouldChangeTheWholeProcess) {
  replace("onboard.xml", "<participant profile_name",
          "<participant is_default_profile=\"true\" profile_name");
  EXPECT_THAT(error(), HasSubstr("attribute is_default_profile of <participant> is not allowed here"));
}

TEST_F(QosDirectory, AProfileDefinedTwiceIsNamedWithBothLines) {
  replace("onboard.xml", "<data_writer profile_name=\"state\">", "<data_writer profile_name=\"sensor\">");
  EXPECT_THAT(error(), HasSubstr("<data_writer> \"sensor\" is already defined at line"));
}

TEST_F(QosDirectory, ATransportThatIsNotDefinedIsNamed) {
  replace("short_range.xml", "<transport_id>wifi</transport_id>", "<transport_id>lan</transport_id>");
  EXPECT_THAT(error(), HasSubstr("no <transport_descriptor> has the id \"wifi\""));
}

class MissingProfile : public QosDirectory,
                       public ::testing::WithParamInterface<std::pair<Link, std::string>> {};

TEST_P(MissingProfile, IsNamed) {
  const auto& [link, profile] = GetParam();
  const std::string file = std::string(to_string(link)) + ".xml";
  for (const char* kind : {"participant", "data_writer", "data_reader"}) {
    const bool participant = kind == std::string("participant");
    const std::string name = participant ? to_string(link) : profile;
    SetUp();
    replace(file, std::string("<") + kind + " profile_name=\"" + name + "\"",
            std::string("<") + kind + " profile_name=\"another\"");
    std::ostringstream missing;
    missing << file << ": no <" << kind << " profile_name=\"" << name << "\">; add that profile";
    EXPECT_THAT(error(), HasSubstr(missing.str()));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Profiles, MissingProfile,
    ::testing::Values(std::pair{Link::kOnboard, "sensor"}, std::pair{Link::kOnboard, "state"},
                      std::pair{Link::kLongRange, "small"}, std::pair{Link::kLongRange, "cloud"},
                      std::pair{Link::kShortRange, "control"}, std::pair{Link::kShortRange, "bulk"}),
    [](const auto& info) { return info.param.second; });

TEST_F(QosDirectory, WritersAndReadersOfEveryProfileMatch) {
  auto first = DdsBus::create(config_).value();
  config_.agent = AgentId::parse("r2").value();
  auto second = DdsBus::create(config_).value();
  for (const Link link : {Link::kOnboard, Link::kLongRange, Link::kShortRange}) {
    for (const std::string& profile : profiles_of(link)) {
      const Topic topic{link, "match/" + profile, "fleetmap::Match", profile};
      first->advertise(topic);
      const Handle handle = second->subscribe(topic, [](const Bytes&) {});
      EXPECT_TRUE(run_both(*first, *second, [&] {
        return first->matches(topic).readers == 1 && second->matches(topic).writers == 1;
      }));
    }
  }
}

}  // namespace
}  // namespace fleetmap::bus::testing
