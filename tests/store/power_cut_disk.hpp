#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace fleetmap::testing {

/// A disk that loses its power at a chosen operation, as a SQLite VFS over the system's own. Bytes that were
/// synced survive; of the others survive none, a prefix, or any 512-byte sectors, some of them as garbage.
/// Creation and deletion of files survive a sync of their folder, which SQLite asks for with the first sync
/// of a new journal or write-ahead log. After the cut every operation fails, as if the process were gone.
class PowerCutDisk {
 public:
  explicit PowerCutDisk(std::uint32_t seed);
  ~PowerCutDisk();
  PowerCutDisk(const PowerCutDisk&) = delete;
  PowerCutDisk& operator=(const PowerCutDisk&) = delete;

  /// For store::StoreConfig::file_system.
  const std::string& name() const;
  /// The power goes at the `operations`-th write, truncation, deletion or sync from now on.
  void cut_after(std::size_t operations);
  bool is_cut() const;
  /// The next `count` syncs fail, and what they were of is lost as by a power cut, though it can be read
  /// until there is one: Linux marks pages clean whose write failed.
  void fail_syncs(std::size_t count);
  /// The process goes, and the disk keeps its power: every operation fails until revive().
  void kill();
  void revive();
  /// Operations since the disk was made.
  std::size_t operations() const;
  std::size_t syncs() const;
  /// The files hold what survived. No file of the disk may be open.
  void restore_power();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fleetmap::testing
