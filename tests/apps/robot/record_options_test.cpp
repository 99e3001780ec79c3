#include "robot/record_options.hpp"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

namespace fleetmap::apps {
namespace {

using recording::BagStorage;
using recording::ChunkCompression;

RecordOptions parsed(const std::string& line) {
  CLI::App app;
  RecordOptions options;
  add_record_options(app, options, "writes a bag");
  app.parse(line);
  return options;
}

TEST(RecordOptions, McapWithZstdUnlessAnotherFormatIsNamed) {
  EXPECT_EQ(parsed("").folder, "");
  const RecordOptions usual = parsed("--record bags");
  EXPECT_EQ(usual.folder, "bags");
  EXPECT_EQ(usual.format.storage, BagStorage::kMcap);
  EXPECT_EQ(usual.format.compression, ChunkCompression::kZstd);
  EXPECT_EQ(parsed("--record bags --record-format sqlite3").format.storage, BagStorage::kSqlite);
  EXPECT_EQ(parsed("--record bags --record-compression lz4").format.compression, ChunkCompression::kLz4);
  EXPECT_EQ(parsed("--record bags --record-format mcap --record-compression none").format.compression,
            ChunkCompression::kNone);
}

TEST(RecordOptions, RefusesOtherFormatsAndAFormatWithoutAFolder) {
  for (const char* line : {"--record bags --record-format db3", "--record bags --record-compression gzip",
                           "--record-format mcap", "--record-compression lz4",
                           "--record-compression lz4 --record bags --record-format sqlite3"})
    EXPECT_THROW(parsed(line), CLI::ParseError) << line;
}

}  // namespace
}  // namespace fleetmap::apps
