#include "bus/dds/qos_schema.hpp"

#include <gmock/gmock.h>
#include <tinyxml2.h>

#include <filesystem>

namespace fleetmap::bus {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string error(const std::string& xml) {
  tinyxml2::XMLDocument document;
  if (document.Parse(xml.c_str()) != tinyxml2::XML_SUCCESS) return "no XML";
  const Status status = check_schema(*document.RootElement(), "f.xml");
  return status ? "none" : status.error().message;
}

std::string writer(const std::string& content) {
  return "<dds><profiles><data_writer profile_name=\"w\">" + content + "</data_writer></profiles></dds>";
}

TEST(QosSchema, AcceptsWhatIsShipped) {
  int files = 0;
  for (const auto& file : std::filesystem::directory_iterator(FLEETMAP_SOURCE_DIR "/qos")) {
    tinyxml2::XMLDocument document;
    ASSERT_EQ(document.LoadFile(file.path().c_str()), tinyxml2::XML_SUCCESS);
    const Status status = check_schema(*document.RootElement(), file.path().string());
    EXPECT_TRUE(status) << status.error().message;
    ++files;
  }
  EXPECT_EQ(files, 3);
}

TEST(QosSchema, TheRootMayBeTheProfilesThemselves) {
  EXPECT_EQ(error("<profiles xmlns=\"x\"><data_reader profile_name=\"r\"/></profiles>"), "none");
  EXPECT_EQ(error("<dds/>"), "none");
  EXPECT_THAT(error("<log/>"), HasSubstr("f.xml:1: the root element is <log>; expected <dds> or <profiles>"));
}

TEST(QosSchema, AnElementIsAllowedInItsOwnPlaceOnly) {
  EXPECT_EQ(error(writer("<topic><historyQos><depth>5</depth></historyQos></topic>")), "none");
  EXPECT_EQ(error(writer("<qos><deadline><period><sec>1</sec></period></deadline></qos>")), "none");
  EXPECT_THAT(error(writer("<qos>\n<historyQos/></qos>")),
              StartsWith("f.xml:2: unknown element <historyQos> in <qos>; expected one of <durability>"));
  EXPECT_THAT(
      error(writer("<times><heartbeatResponseDelay><sec>1</sec></heartbeatResponseDelay></times>")),
      AllOf(HasSubstr("unknown element <heartbeatResponseDelay> in <times>"), HasSubstr("<heartbeatPeriod>")))
      << "that is a reader's";
}

TEST(QosSchema, ProfilesThatChangeTheWholeProcessAreRefused) {
  EXPECT_THAT(error("<dds><library_settings/></dds>"),
              HasSubstr("unknown element <library_settings> in <dds>; expected one of <profiles>"));
  EXPECT_THAT(error("<dds>\n<log/></dds>"), StartsWith("f.xml:2: unknown element <log>"));
  EXPECT_THAT(error("<dds><profiles><participant profile_name=\"p\" is_default_profile=\"true\"/>"
                    "</profiles></dds>"),
              HasSubstr("attribute is_default_profile of <participant> is not allowed here; remove it"));
  EXPECT_THAT(error(writer("<qos kind=\"x\"/>")), HasSubstr("attribute kind of <qos>"));
}

TEST(QosSchema, AProfileNeedsAName) {
  EXPECT_THAT(error("<profiles><participant/></profiles>"),
              HasSubstr("<participant> has no profile_name; give it one"));
  EXPECT_THAT(error("<profiles><data_reader profile_name=\"\"/></profiles>"),
              HasSubstr("<data_reader> has no profile_name"));
}

TEST(QosSchema, ValuesAreOfTheirKind) {
  const auto depth = [](const std::string& text) {
    return error(writer("<topic><historyQos><depth>" + text + "</depth></historyQos></topic>"));
  };
  EXPECT_EQ(depth("4294967295"), "none");
  for (const char* wrong : {"-1", "4294967296", "1.5", "5 m", ""})
    EXPECT_THAT(depth(wrong),
                HasSubstr("<depth> is \"" + std::string(wrong) + "\"; expected a whole number >= 0"));

  const auto kind = [](const std::string& text) {
    return error(writer("<qos><reliability><kind>" + text + "</kind></reliability></qos>"));
  };
  EXPECT_EQ(kind("RELIABLE"), "none");
  EXPECT_EQ(kind("BEST_EFFORT"), "none");
  for (const char* wrong : {"reliable", "BEST_EFFORT|RELIABLE", "BEST", ""})
    EXPECT_THAT(kind(wrong), HasSubstr("; expected one of BEST_EFFORT|RELIABLE")) << wrong;

  const auto seconds = [](const std::string& text) {
    return error(writer("<times><heartbeatPeriod><sec>" + text + "</sec></heartbeatPeriod></times>"));
  };
  EXPECT_EQ(seconds("0"), "none");
  EXPECT_EQ(seconds("DURATION_INFINITY"), "none");
  EXPECT_THAT(seconds("0.5"), HasSubstr("expected whole seconds or DURATION_INFINITY"));

  const auto flag = [](const std::string& text) {
    return error(
        writer("<qos><disable_heartbeat_piggyback>" + text + "</disable_heartbeat_piggyback></qos>"));
  };
  EXPECT_EQ(flag("true"), "none");
  EXPECT_THAT(flag("TRUE"), HasSubstr("expected true or false"));
  EXPECT_THAT(error(writer("<qos><partition><names><name></name></names></partition></qos>")),
              HasSubstr("expected a text"));
}

}  // namespace
}  // namespace fleetmap::bus
