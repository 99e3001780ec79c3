#include "fleetmap/bus/cdr.hpp"

#include <gmock/gmock.h>

#include <stdexcept>

namespace fleetmap::bus {
namespace {

using eprosima::fastcdr::Cdr;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// The type that fastddsgen makes of struct { unsigned long number; string text; }.
struct Note {
  std::uint32_t number = 0;
  std::string text;

  static std::size_t getCdrSerializedSize(const Note& note) { return 4 + 4 + note.text.size() + 1; }
  void serialize(Cdr& cdr) const { cdr << number << text; }
  void deserialize(Cdr& cdr) { cdr >> number >> text; }
};

const Bytes kLittle{0, 1, 0, 0, 4, 3, 2, 1, 3, 0, 0, 0, 'a', 'b', 0};
const Bytes kBig{0, 0, 0, 0, 1, 2, 3, 4, 0, 0, 0, 3, 'a', 'b', 0};

TEST(Cdr, IsWrittenInLittleEndianBehindItsHeader) { EXPECT_EQ(to_cdr(Note{0x01020304, "ab"}), kLittle); }

TEST(Cdr, IsReadInEitherByteOrder) {
  for (const Bytes& bytes : {kLittle, kBig}) {
    const auto note = from_cdr<Note>(bytes, "Note");
    ASSERT_TRUE(note) << note.error().message;
    EXPECT_EQ(note->number, 0x01020304u);
    EXPECT_EQ(note->text, "ab");
  }
}

TEST(Cdr, NoPartOfAMessageIsOne) {
  for (std::size_t size = 0; size < kLittle.size(); ++size) {
    const auto note = from_cdr<Note>(ByteView(kLittle).first(size), "Note");
    ASSERT_FALSE(note) << size;
    EXPECT_THAT(note.error().message,
                AllOf(StartsWith("Note: " + std::to_string(size) + " bytes are "),
                      HasSubstr(size <= kEncapsulationBytes ? "too few" : "truncated or malformed")));
  }
}

TEST(Cdr, OtherEncapsulationsAreRefusedByNumber) {
  Bytes bytes = kLittle;
  bytes[1] = 2;
  EXPECT_EQ(from_cdr<Note>(bytes, "Note").error().message,
            "Note: encapsulation 2 is not plain XCDR1 (0 or 1)");
  bytes[0] = 1;
  bytes[1] = 0;
  EXPECT_EQ(check_encapsulation(bytes, "Note").error().message,
            "Note: encapsulation 256 is not plain XCDR1 (0 or 1)");
  EXPECT_TRUE(check_encapsulation(kBig, "Note"));
}

TEST(Cdr, PeekingChangesNothingAndMayRefuse) {
  std::uint32_t number = 0;
  const auto note = from_cdr<Note>(kBig, "Note", [&](Cdr& cdr) { cdr >> number; });
  ASSERT_TRUE(note);
  EXPECT_EQ(number, 0x01020304u);
  EXPECT_EQ(note->number, number);
  EXPECT_EQ(note->text, "ab");
  const auto refused =
      from_cdr<Note>(kBig, "Note", [](Cdr&) { throw std::runtime_error("longer than allowed"); });
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("longer than allowed"));
}

}  // namespace
}  // namespace fleetmap::bus
