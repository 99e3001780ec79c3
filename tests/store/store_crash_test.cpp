#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <random>

#include "fleetmap/store/store.hpp"
#include "store/agents.hpp"
#include "store/items.hpp"

namespace fleetmap::store {
namespace {

using testing::kPeer;
using testing::kSelf;

constexpr std::uint32_t kChunkedBytes = 2 * Store::kChunkBytes + 100;

Bytes chunked_submap(std::uint32_t seq) { return testing::random_bytes(kChunkedBytes, seq); }

/// Puts own nodes, peers' nodes, alignments and chunks, and writes one byte to `acknowledge` after every put.
[[noreturn]] void write_until_killed(const std::filesystem::path& path, int acknowledge) {
  auto store = Store::open(path, kSelf);
  if (!store) _exit(1);
  const auto acknowledged = [&](const Result<Put>& put) {
    if (!put || *put != Put::kAdded || write(acknowledge, "", 1) != 1) _exit(2);
  };
  for (std::uint32_t seq = 0;; ++seq) {
    const Bytes submap = chunked_submap(seq);
    const ByteView bytes(submap);
    acknowledged(store->put_node_with_submap(testing::make_node(kSelf, seq, submap), submap));
    acknowledged(store->put_node(testing::make_node(kPeer, seq, submap)));
    acknowledged(store->put_alignment(testing::make_alignment({kSelf, seq}, {kPeer, seq}, kSelf, seq)));
    acknowledged(
        store->put_submap_chunk({kPeer, seq}, 1, bytes.subspan(Store::kChunkBytes, Store::kChunkBytes)));
    acknowledged(store->put_submap_chunk({kPeer, seq}, 2, bytes.subspan(2 * Store::kChunkBytes)));
    acknowledged(store->put_submap_chunk({kPeer, seq}, 0, bytes.first(Store::kChunkBytes)));
  }
}

void expect_holds(Store& store, std::uint32_t puts) {
  for (std::uint32_t put = 0; put < puts; ++put) {
    const std::uint32_t seq = put / 6;
    const NodeId peer{kPeer, seq};
    switch (put % 6) {
      case 0:
        EXPECT_EQ(store.submap({kSelf, seq}).value_or(Bytes{}), chunked_submap(seq)) << put;
        break;
      case 1:
        EXPECT_TRUE(store.node(peer)) << put;
        break;
      case 2:
        EXPECT_TRUE(store.alignment({kSelf, seq})) << put;
        break;
      case 3:
        EXPECT_FALSE(std::ranges::count(store.missing_chunks(peer), 1u)) << put;
        break;
      case 4:
        EXPECT_FALSE(std::ranges::count(store.missing_chunks(peer), 2u)) << put;
        break;
      default:
        EXPECT_EQ(store.submap(peer).value_or(Bytes{}), chunked_submap(seq)) << put;
        break;
    }
  }
}

/// FLEETMAP_KILLS=300 kills as often.
int kills() {
  const char* wanted = std::getenv("FLEETMAP_KILLS");
  return wanted ? std::atoi(wanted) : 40;
}

TEST(StoreCrash, kill_9_loses_nothing_that_was_acknowledged) {
  std::mt19937 random(1);
  for (int k = 0; k < kills() && !HasFailure(); ++k) {
    const std::uint32_t kill_after = 1 + static_cast<std::uint32_t>(random()) % (k % 4 == 0 ? 400u : 40u);
    const testing::TemporaryFolder folder;
    int pipe_ends[2];
    ASSERT_EQ(pipe(pipe_ends), 0);
    const pid_t writer = fork();
    if (writer == 0) {
      close(pipe_ends[0]);
      write_until_killed(folder / "store.db", pipe_ends[1]);
    }
    close(pipe_ends[1]);
    std::uint32_t acknowledged = 0;
    char byte = 0;
    while (acknowledged < kill_after && read(pipe_ends[0], &byte, 1) == 1) ++acknowledged;
    ASSERT_EQ(kill(writer, SIGKILL), 0);
    int status = 0;
    ASSERT_EQ(waitpid(writer, &status, 0), writer);
    ASSERT_TRUE(WIFSIGNALED(status)) << "the writer failed by itself";
    while (read(pipe_ends[0], &byte, 1) == 1) ++acknowledged;
    close(pipe_ends[0]);
    ASSERT_GE(acknowledged, kill_after);
    auto store = Store::open(folder / "store.db", kSelf);
    ASSERT_TRUE(store) << store.error().message;
    expect_holds(*store, acknowledged);
    EXPECT_EQ(store->stats().lost_submaps, 0u);
  }
}

}  // namespace
}  // namespace fleetmap::store
