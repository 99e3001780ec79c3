#include "schema.hpp"

#include <gtest/gtest.h>

#include <string>

#include "fleetmap/fleet_codec/messages.hpp"
#include "fleetmap_short_range.h"

namespace fleetmap::fleet_codec {
namespace {

std::string schema_refusal(const Bytes& cdr) {
  const Status status = check_fleet_type(cdr, "Some", 32'768);
  return status ? "none" : status.error().message;
}

Bytes message(std::size_t size, std::uint8_t version = kSchemaVersion) {
  Bytes bytes(size);
  bytes[1] = 1;
  bytes[4] = version;
  return bytes;
}

TEST(FleetSchema, BothByteOrdersOfThisVersionAreTaken) {
  EXPECT_EQ(schema_refusal(message(5)), "none");
  Bytes big_endian = message(5);
  big_endian[1] = 0;
  EXPECT_EQ(schema_refusal(big_endian), "none");
}

TEST(FleetSchema, OtherEncapsulationsAreRefusedBeforeAnythingIsRead) {
  EXPECT_EQ(schema_refusal({}), "Some: 0 bytes are too few for a CDR message");
  EXPECT_EQ(schema_refusal({0, 1, 0, 0}), "Some: 4 bytes are too few for a CDR message");
  Bytes parameters = message(100, 99);
  parameters[1] = 3;
  EXPECT_EQ(schema_refusal(parameters), "Some: encapsulation 3 is not plain XCDR1 (0 or 1)");
}

TEST(FleetSchema, AnotherVersionIsNamedBesideThisOne) {
  EXPECT_EQ(schema_refusal(message(5, 5)), "Some: the sender speaks schema version 5, this program version " +
                                               std::to_string(kSchemaVersion) +
                                               "; run the same release on all robots");
  EXPECT_EQ(schema_refusal(message(100'000, 255)).find("Some: the sender speaks schema version 255"), 0u);
}

TEST(FleetSchema, ALongerMessageThanItsTypeHasIsRefused) {
  EXPECT_EQ(schema_refusal(message(32'768)), "none");
  EXPECT_EQ(schema_refusal(message(32'769)), "Some: 32769 bytes are more than this type can have");
}

TEST(FleetSchema, ATypeIsReadOnlyWhereAllThatHolds) {
  msg::SubmapRequest request;
  request.schema(kSchemaVersion);
  request.offset(77);
  EXPECT_EQ(fleet_type_from_cdr<msg::SubmapRequest>(bus::to_cdr(request), "Some")->offset(), 77u);
  Bytes cut = bus::to_cdr(request);
  cut.pop_back();
  EXPECT_FALSE(fleet_type_from_cdr<msg::SubmapRequest>(cut, "Some"));
  // Fast CDR would read it and leave the rest.
  Bytes longer = bus::to_cdr(request);
  longer.resize(bus::kEncapsulationBytes + msg::SubmapRequest::getMaxCdrSerializedSize() + 1);
  const auto refused = fleet_type_from_cdr<msg::SubmapRequest>(longer, "Some");
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("bytes are more than this type can have"), std::string::npos);
  request.schema(kSchemaVersion + 1);
  const auto other = fleet_type_from_cdr<msg::SubmapRequest>(bus::to_cdr(request), "Some");
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().message.find("Some: the sender speaks schema version " +
                                       std::to_string(kSchemaVersion + 1)),
            0u);
}

}  // namespace
}  // namespace fleetmap::fleet_codec
