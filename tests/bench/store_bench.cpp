#include <benchmark/benchmark.h>

#include "fleetmap/store/map_merge.hpp"
#include "fleetmap/store/store.hpp"
#include "store/items.hpp"

namespace fleetmap::store {
namespace {

const AgentId kSelf = testing::agent("r1");
const AgentId kPeer = testing::agent("r2");

StoreConfig no_sync() {
  StoreConfig config;
  config.power_safe = false;
  return config;
}

void put_node_of_a_peer(benchmark::State& state) {
  const testing::TemporaryFolder folder;
  auto store = Store::open(folder / "store.db", kSelf, no_sync()).value();
  std::uint32_t seq = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(store.put_node(testing::make_node(kPeer, seq++, Bytes{})).value());
  }
}
BENCHMARK(put_node_of_a_peer)->Unit(benchmark::kMicrosecond);

void put_own_node_with_disk_sync(benchmark::State& state) {
  const testing::TemporaryFolder folder;
  auto store = Store::open(folder / "store.db", kSelf).value();
  const Bytes submap = testing::random_bytes(50'000, 1);
  std::uint32_t seq = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        store.put_node_with_submap(testing::make_node(kSelf, seq++, submap), submap).value());
  }
}
BENCHMARK(put_own_node_with_disk_sync)->Unit(benchmark::kMicrosecond);

void put_submap_chunks(benchmark::State& state) {
  const testing::TemporaryFolder folder;
  auto store = Store::open(folder / "store.db", kSelf, no_sync()).value();
  constexpr std::uint32_t kChunks = 64;
  const Bytes submap = testing::random_bytes(kChunks * Store::kChunkBytes, 1);
  std::uint32_t seq = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(store.put_node(testing::make_node(kPeer, seq, submap)).value());
    for (std::uint32_t chunk = 0; chunk < kChunks; ++chunk) {
      const ByteView piece = ByteView(submap).subspan(chunk * Store::kChunkBytes, Store::kChunkBytes);
      benchmark::DoNotOptimize(store.put_submap_chunk({kPeer, seq}, chunk, piece).value());
    }
    ++seq;
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations()) * kChunks * Store::kChunkBytes);
}
BENCHMARK(put_submap_chunks)->Unit(benchmark::kMillisecond)->Iterations(100);

void open_and_look_up(benchmark::State& state) {
  const testing::TemporaryFolder folder;
  const auto nodes = static_cast<std::uint32_t>(state.range(0));
  {
    auto store = Store::open(folder / "store.db", kSelf, no_sync()).value();
    for (std::uint32_t seq = 0; seq < nodes; ++seq) {
      benchmark::DoNotOptimize(store.put_node(testing::make_node(kPeer, seq, Bytes{})).value());
    }
  }
  for (auto _ : state) {
    auto store = Store::open(folder / "store.db", kSelf, no_sync()).value();
    benchmark::DoNotOptimize(store.node({kPeer, nodes / 2}));
  }
}
BENCHMARK(open_and_look_up)->Arg(1000)->Arg(50'000)->Unit(benchmark::kMillisecond);

/// Opens a store of so many nodes with submaps of 60 kB, all of which is read and checked.
void open_and_check_all(benchmark::State& state) {
  const testing::TemporaryFolder folder;
  const auto nodes = static_cast<std::uint32_t>(state.range(0));
  const Bytes submap = testing::random_bytes(60'000, 1);
  {
    auto store = Store::open(folder / "store.db", kSelf, no_sync()).value();
    for (std::uint32_t seq = 0; seq < nodes; ++seq)
      benchmark::DoNotOptimize(
          store.put_node_with_submap(testing::make_node(kPeer, seq, submap), submap).value());
  }
  for (auto _ : state) benchmark::DoNotOptimize(Store::open(folder / "store.db", kSelf, no_sync()).value());
  state.SetBytesProcessed(state.iterations() * state.range(0) * static_cast<std::int64_t>(submap.size()));
}
BENCHMARK(open_and_check_all)->Arg(500)->Arg(5000)->Unit(benchmark::kMillisecond);

/// Cost of a digest after so many chunks of submaps came since the last one.
void sync_before_a_digest(benchmark::State& state) {
  const testing::TemporaryFolder folder;
  auto store = Store::open(folder / "store.db", kSelf).value();
  const auto chunks = static_cast<std::uint32_t>(state.range(0));
  const Bytes submap = testing::random_bytes((chunks + 1) * Store::kChunkBytes, 1);
  std::uint32_t seq = 0;
  for (auto _ : state) {
    state.PauseTiming();
    benchmark::DoNotOptimize(store.put_node(testing::make_node(kPeer, seq, submap)).value());
    for (std::uint32_t chunk = 0; chunk < chunks; ++chunk) {
      const ByteView piece = ByteView(submap).subspan(chunk * Store::kChunkBytes, Store::kChunkBytes);
      benchmark::DoNotOptimize(store.put_submap_chunk({kPeer, seq}, chunk, piece).value());
    }
    ++seq;
    state.ResumeTiming();
    benchmark::DoNotOptimize(store.sync());
  }
}
BENCHMARK(sync_before_a_digest)->Arg(0)->Arg(16)->Arg(200)->Unit(benchmark::kMillisecond)->Iterations(50);

}  // namespace
}  // namespace fleetmap::store
