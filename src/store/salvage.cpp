#include "salvage.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <system_error>
#include <vector>

#include "database.hpp"
#include "fleetmap/core/paths.hpp"
#include "item_codec.hpp"
#include "log_scan.hpp"
#include "page_scan.hpp"
#include "row_hash.hpp"
#include "schema.hpp"

namespace fleetmap::store {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLog = "-wal";
constexpr const char* kSharedMemory = "-shm";
constexpr const char* kBuilding = ".salvaging";  ///< the new store, not complete
constexpr const char* kBuilt = ".salvaged";      ///< the new store, complete

fs::path beside(const fs::path& file, const char* end) { return file.string() + end; }

std::uintmax_t size_of(const fs::path& file) {
  std::error_code none;
  const auto size = fs::file_size(file, none);
  return none ? 0 : size;
}

Status move_file(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (!error) return {};
  return failure(from.string() + ": cannot be renamed to " + to.string() + ": " + error.message() +
                 "; check the folder and its permissions");
}

/// New names in the folder survive a power cut.
Status sync_folder(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const bool synced = descriptor >= 0 && ::fsync(descriptor) == 0;
  const int code = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (synced) return {};
  return failure(folder.string() + ": cannot be synced to the disk: " + std::strerror(code));
}

/// The text of the first value in the first row of `sql`, or why there is none.
Result<std::string> text_of(const Database& db, const char* sql) {
  auto rows = db.prepare(sql);
  if (!rows) return tl::unexpected(rows.error());
  const auto row = rows->step();
  if (!row) return tl::unexpected(row.error());
  return *row ? std::string(rows->text(0)) : std::string();
}

/// The fields of a row that bears an item, whichever table it is of.
struct ItemRow {
  ByteView agent;
  std::int64_t seq;
  ByteView item;
  ByteView hash;
  std::optional<Signature> signature;
};

const ByteView* bytes_at(std::span<const Value> values, std::size_t k) {
  return k < values.size() ? std::get_if<ByteView>(&values[k]) : nullptr;
}

std::string text(ByteView bytes) { return {bytes.begin(), bytes.end()}; }

/// A row of version 3 and before, or of what is no item.
std::optional<ItemRow> item_row_without_hash(std::span<const Value> values) {
  const auto *agent = bytes_at(values, 0), *item = bytes_at(values, 2);
  const auto* seq = values.size() == 3 ? std::get_if<std::int64_t>(&values[1]) : nullptr;
  if (!agent || !seq || !item) return std::nullopt;
  return ItemRow{*agent, *seq, *item, {}, std::nullopt};
}

/// Rows of version 4, which had no signatures, stay as they are until they are changed.
std::optional<ItemRow> item_row(std::span<const Value> values) {
  if (values.size() != 4 && values.size() != 5) return std::nullopt;
  const auto* agent = bytes_at(values, 0);
  const auto* seq = std::get_if<std::int64_t>(&values[1]);
  const auto *item = bytes_at(values, 2), *hash = bytes_at(values, 3), *signature = bytes_at(values, 4);
  if (!agent || !seq || !item || !hash || (values.size() == 5 && !signature)) return std::nullopt;
  ItemRow row{*agent, *seq, *item, *hash, std::nullopt};
  const ByteView signed_by = signature ? *signature : ByteView();
  if (!std::ranges::equal(row_hash(*item, signed_by), *hash)) return std::nullopt;
  if (signed_by.size() == sizeof(Signature)) std::ranges::copy(signed_by, row.signature.emplace().begin());
  return row;
}

struct ValueRow {
  std::string key;
  ByteView value;
};

std::optional<ValueRow> value_row(std::span<const Value> values) {
  const auto *key = bytes_at(values, 0), *value = bytes_at(values, 1), *hash = bytes_at(values, 2);
  if (values.size() != 3 || !key || !value || !hash) return std::nullopt;
  if (!std::ranges::equal(value_hash(text(*key), *value), *hash)) return std::nullopt;
  return ValueRow{text(*key), *value};
}

/// Names that programs use; keeps other records of two columns out.
bool is_key(ByteView bytes) {
  constexpr std::size_t kMax = 64;
  return !bytes.empty() && bytes.size() <= kMax && std::ranges::all_of(bytes, [](std::uint8_t byte) {
    return (byte >= 'a' && byte <= 'z') || (byte >= '0' && byte <= '9') || byte == '_' || byte == '-' ||
           byte == '.';
  });
}

/// A row of version 5 and before.
std::optional<ValueRow> value_row_without_hash(std::span<const Value> values) {
  const auto *key = bytes_at(values, 0), *value = bytes_at(values, 1);
  if (values.size() != 2 || !key || !value || !is_key(*key)) return std::nullopt;
  return ValueRow{text(*key), *value};
}

/// A rotation, which random bytes are not.
bool is_rotation(const Eigen::Quaterniond& q) { return std::abs(q.squaredNorm() - 1.0) < 1e-6; }

/// Reads a damaged store page by page and puts into another what is whole. A hash shows that where the
/// schema had one. Items before version 4 and named values before version 6 count as whole when they decode
/// to the last byte, bear the name of their row and keep the rules of their type (rotations, symmetric
/// covariances); they are only taken from a file in which no row of their kind has a hash, since they are
/// left overs of before a migration elsewhere.
class Salvage {
 public:
  Salvage(const fs::path& damaged, Store& into) : damaged_(damaged), into_(into) {}

  Status run() {
    // A submap is whole if it is what its node names.
    for (void (Salvage::*take)(std::span<const Value>) :
         {&Salvage::take_hashed, &Salvage::take_without_hash, &Salvage::take_submap}) {
      if (take == &Salvage::take_without_hash && items_have_hashes_ && values_have_hashes_) continue;
      const Status scanned =
          scan_records(damaged_, [&](std::span<const Value> values) { (this->*take)(values); });
      if (!scanned) return scanned;
      if (!status_) return status_;
    }
    return {};
  }

  std::string kept() const {
    return std::to_string(into_.node_set().size()) + " nodes, " +
           std::to_string(into_.alignment_set().size()) + " alignments, " +
           std::to_string(into_.submap_set().size()) + " submaps and " + std::to_string(values_) +
           " named values";
  }

 private:
  template <class T>
  void note(const tl::expected<T, Error>& done) {
    if (status_ && !done) status_ = tl::unexpected(done.error());
  }

  void take_hashed(std::span<const Value> values) {
    if (!status_) return;
    if (const auto row = item_row(values)) {
      items_have_hashes_ = true;
      if (auto node = decode_node(row->item)) {
        node->signature = row->signature;
        note(into_.put_node(*node));
      } else if (auto alignment = decode_alignment(row->item)) {
        alignment->signature = row->signature;
        note(into_.put_alignment(*alignment));
      }
    } else if (const auto named = value_row(values)) {
      values_have_hashes_ = true;
      take_value(*named);
    }
  }

  void take_without_hash(std::span<const Value> values) {
    if (!status_) return;
    if (const auto row = items_have_hashes_ ? std::nullopt : item_row_without_hash(values)) {
      const auto is_named = [&](const AgentId& maker, std::uint32_t seq) {
        return maker.str() == text(row->agent) && std::int64_t{seq} == row->seq;
      };
      if (const auto node = decode_node(row->item)) {
        if (is_named(node->id.agent, node->id.seq) && (!node->G || is_rotation(node->G->q_enu_base)))
          note(into_.put_node(*node));
      } else if (const auto alignment = decode_alignment(row->item)) {
        if (is_named(alignment->computed_by, alignment->seq)) note(into_.put_alignment(*alignment));
      }
    } else if (const auto named = values_have_hashes_ ? std::nullopt : value_row_without_hash(values)) {
      take_value(*named);
    }
  }

  void take_value(const ValueRow& row) {
    if (row.key == kOwnerKey) {
      if (AgentId::parse(text(row.value)) && text(row.value) != into_.self().str())
        status_ = failure(damaged_.string() + ": damaged, and the store of agent '" + text(row.value) +
                          "', not of '" + into_.self().str() + "'; every agent needs its own");
      return;
    }
    note(into_.set_meta(row.key, row.value));
    ++values_;
  }

  void take_submap(std::span<const Value> values) {
    if (!status_ || values.size() != 3) return;
    const auto *agent = bytes_at(values, 0), *bytes = bytes_at(values, 2);
    const auto* seq = std::get_if<std::int64_t>(&values[1]);
    if (!agent || !seq || !bytes || *seq < 0 || *seq >= kEndOfSeqs) return;
    const auto maker = AgentId::parse(text(*agent));
    if (maker) note(into_.put_submap({*maker, static_cast<std::uint32_t>(*seq)}, *bytes));
  }

  fs::path damaged_;
  Store& into_;
  Status status_;
  std::size_t values_ = 0;
  bool items_have_hashes_ = false, values_have_hashes_ = false;
};

void remove_store(const fs::path& file) {
  std::error_code none;
  for (const char* end : {"", kLog, kSharedMemory, "-journal", ".lock"}) fs::remove(beside(file, end), none);
}

fs::path free_name(const fs::path& file) {
  for (int k = 1;; ++k) {
    fs::path name = file.string() + ".damaged-" + std::to_string(k);
    if (!is_there(name) && !is_there(beside(name, kLog))) return name;
  }
}

/// Moves the damaged files away and the new store into their place.
Result<fs::path> swap_files(const fs::path& file) {
  fs::path aside = free_name(file);
  std::error_code none;
  for (const char* end : {"", kLog, "-journal"}) {
    if (!is_there(beside(file, end))) continue;
    if (auto status = move_file(beside(file, end), beside(aside, end)); !status)
      return tl::unexpected(status.error());
  }
  fs::remove(beside(file, kSharedMemory), none);
  if (auto status = move_file(beside(file, kBuilt), file); !status) return tl::unexpected(status.error());
  if (auto status = sync_folder(file); !status) return tl::unexpected(status.error());
  return aside;
}

/// Builds the new store beside the damaged one; what was kept.
Result<std::string> build(const fs::path& file, const AgentId& self, const StoreConfig& config) {
  StoreConfig building = config;
  building.power_safe = false;
  building.max_submap_bytes = 1u << 30;  // a limit that was lowered since concerns what is to come
  const fs::path fresh = beside(file, kBuilding);
  remove_store(fresh);
  std::string kept;
  {
    auto store = Store::open(fresh, self, building);
    if (!store) return tl::unexpected(store.error());
    Salvage salvage(file, *store);
    if (auto status = salvage.run(); !status) return tl::unexpected(status.error());
    kept = salvage.kept();
  }
  // Closing the store has moved its log into the file, and synced both.
  if (size_of(beside(fresh, kLog)) > 0)
    return failure(fresh.string() + ": its log cannot be moved into it; is the disk full?");
  if (auto status = move_file(fresh, beside(file, kBuilt)); !status) return tl::unexpected(status.error());
  remove_store(fresh);
  if (auto status = sync_folder(file); !status) return tl::unexpected(status.error());
  return kept;
}

}  // namespace

Result<std::optional<std::string>> find_damage(const fs::path& file, const std::string& file_system) {
  using Damage = std::optional<std::string>;
  if (size_of(file) == 0) {
    // SQLite would delete the log.
    return size_of(beside(file, kLog)) > kLogHeaderBytes ? Damage("it is empty and its log is not")
                                                         : Damage();
  }
  const auto db = Database::open(file, false, file_system);
  if (!db) return tl::unexpected(db.error());
  const auto unless_damaged = [&](const Error& error) -> Result<Damage> {
    if (db->is_damaged()) return Damage(db->last_error());
    return tl::unexpected(error);
  };
  const auto recognised = recognise(*db);
  if (!recognised) return unless_damaged(recognised.error());
  if (*recognised == Recognised::kOther) return Damage();
  if (*recognised == Recognised::kStoreWithoutMark) return Damage("its header does not name it a store");
  const auto check = text_of(*db, "PRAGMA integrity_check(1)");
  if (!check) return unless_damaged(check.error());
  if (*check != "ok") return Damage(*check);
  const auto owner = owner_of(*db, file);
  if (!owner) return db->is_damaged() ? Damage(db->last_error()) : Damage("it names no owner");
  return Damage();
}

Result<std::string> salvage(const fs::path& file, const AgentId& self, const StoreConfig& config,
                            const std::string& damage) {
  const auto kept = build(file, self, config);
  if (!kept) {
    return failure(file.string() + ": damaged (" + damage +
                   "), and it cannot be replaced: " + kept.error().message);
  }
  const auto aside = swap_files(file);
  if (!aside) return tl::unexpected(aside.error());
  return file.string() + ": damaged (" + damage + "); kept " + *kept +
         ", the rest is fetched from other robots; the damaged file is " + aside->string() + " now";
}

Status finish_salvage(const fs::path& file) {
  if (!is_there(beside(file, kBuilt))) return {};
  const auto aside = swap_files(file);
  return aside ? Status{} : tl::unexpected(aside.error());
}

}  // namespace fleetmap::store
