#pragma once

#include <memory>
#include <string>

namespace fleetmap::fault_injection {

/// A SQLite file system (VFS) over the system's own that can be set full or read-only, and that syncs
/// nothing, because virtual time has no power cuts. One object a disk; it must outlive the stores on it.
class FaultyFileSystem {
 public:
  FaultyFileSystem();
  ~FaultyFileSystem();
  FaultyFileSystem(const FaultyFileSystem&) = delete;
  FaultyFileSystem& operator=(const FaultyFileSystem&) = delete;

  /// For store::StoreConfig::file_system.
  const std::string& name() const;
  /// Every write fails as on a full disk until it is set back.
  void set_full(bool full);
  bool is_full() const;
  /// Every write fails as after a remount, which the system does when the disk has errors.
  void set_read_only(bool read_only);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fleetmap::fault_injection
