#include "fleetmap/store/registration_log.hpp"

#include <array>
#include <cstring>
#include <optional>
#include <utility>

#include "database.hpp"

namespace fleetmap::store {
namespace {

// A power cut may lose the last of it; nothing else depends on this file.
constexpr const char* kLogTable = R"sql(
  PRAGMA synchronous = OFF;
  CREATE TABLE IF NOT EXISTS cloud(hash TEXT PRIMARY KEY, bytes BLOB NOT NULL);
  CREATE TABLE IF NOT EXISTS registration(
    id INTEGER PRIMARY KEY, target_agent TEXT, target_seq INTEGER, source_agent TEXT, source_seq INTEGER,
    method TEXT, target_cloud TEXT NOT NULL, source_cloud TEXT NOT NULL, prior BLOB NOT NULL);
)sql";

/// T_target_source row by row (12), the four sigmas, up.
using StoredPrior = std::array<double, 19>;

StoredPrior stored(const LoggedPrior& prior) {
  StoredPrior values{};
  Eigen::Map<Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(values.data()) =
      prior.T_target_source.matrix().topRows<3>();
  values[12] = prior.sigma_translation_m;
  values[13] = prior.sigma_yaw_rad;
  values[14] = prior.sigma_tilt_rad;
  values[15] = prior.sigma_height_m;
  Eigen::Map<Eigen::Vector3d>(values.data() + 16) = prior.up_target;
  return values;
}

std::optional<LoggedPrior> prior_of(ByteView bytes) {
  StoredPrior values{};
  if (bytes.size() != sizeof values) return std::nullopt;
  std::memcpy(values.data(), bytes.data(), sizeof values);
  LoggedPrior prior;
  prior.T_target_source.matrix().topRows<3>() =
      Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(values.data());
  prior.sigma_translation_m = values[12];
  prior.sigma_yaw_rad = values[13];
  prior.sigma_tilt_rad = values[14];
  prior.sigma_height_m = values[15];
  prior.up_target = Eigen::Map<const Eigen::Vector3d>(values.data() + 16);
  return prior;
}

Result<NodeId> node_of(const Statement& row, int column) {
  const auto agent = AgentId::parse(std::string(row.text(column)));
  if (!agent) return tl::unexpected(agent.error());
  return NodeId{*agent, static_cast<std::uint32_t>(row.integer(column + 1))};
}

Bytes bytes_of(const Statement& row, int column) {
  const ByteView bytes = row.blob(column);
  return {bytes.begin(), bytes.end()};
}

}  // namespace

struct RegistrationLog::State {
  std::filesystem::path file;
  RegistrationLogConfig config;
  Database db;

  /// The cloud's name in the file, which holds it afterwards.
  Result<std::string> keep(const Bytes& cloud) {
    std::string name = to_hex(content_hash(cloud));
    auto insert = db.prepare("INSERT OR IGNORE INTO cloud VALUES(?, ?)");
    if (!insert) return tl::unexpected(insert.error());
    if (const Status kept = insert->bind(1, std::string_view(name)).bind(2, ByteView(cloud)).run(); !kept)
      return tl::unexpected(kept.error());
    return name;
  }

  /// Bytes of the file that hold something; SQLite writes new rows into the others first.
  Result<std::uint64_t> bytes_in_use() const {
    std::array<std::uint64_t, 3> values{};
    constexpr std::array kPragmas{"PRAGMA page_size", "PRAGMA page_count", "PRAGMA freelist_count"};
    for (std::size_t k = 0; k < values.size(); ++k) {
      const auto value = db.integer(kPragmas[k]);
      if (!value) return tl::unexpected(value.error());
      values[k] = static_cast<std::uint64_t>(*value);
    }
    return values[0] * (values[1] - values[2]);
  }

  /// Drops the oldest until `room` (B) is free below the bound. The search for clouds without a registration
  /// takes long, so an eighth of the bound is freed at once.
  Status make_room(std::size_t room) {
    std::optional<std::int64_t> before;
    for (std::uint64_t max_bytes = config.max_bytes;; max_bytes = config.max_bytes / 8 * 7) {
      const auto used = bytes_in_use();
      if (!used) return tl::unexpected(used.error());
      const auto left = db.integer("SELECT COUNT(*) FROM registration");
      if (!left) return tl::unexpected(left.error());
      if (*used + room <= max_bytes || *left == 0) return {};
      if (before && *left >= *before)
        return failure(file.string() + ": is damaged, its rows cannot be dropped; delete it");
      before = *left;
      const std::string oldest = std::to_string(*left / 32 + 1);
      const Status dropped = db.execute(
          ("DELETE FROM registration WHERE id IN (SELECT id FROM registration ORDER BY id LIMIT " + oldest +
           "); DELETE FROM cloud WHERE hash NOT IN (SELECT target_cloud FROM registration UNION "
           "SELECT source_cloud FROM registration)")
              .c_str());
      if (!dropped) return dropped;
    }
  }
};

RegistrationLog::RegistrationLog(std::unique_ptr<State> state) : state_(std::move(state)) {}
RegistrationLog::RegistrationLog(RegistrationLog&&) noexcept = default;
RegistrationLog& RegistrationLog::operator=(RegistrationLog&&) noexcept = default;
RegistrationLog::~RegistrationLog() = default;

Result<RegistrationLog> RegistrationLog::open(const std::filesystem::path& file,
                                              const RegistrationLogConfig& config) {
  if (const Status valid = config.validate(); !valid) return tl::unexpected(valid.error());
  auto db = Database::open(file, false);
  if (!db) return tl::unexpected(db.error());
  if (const Status made = db->execute(kLogTable); !made) return tl::unexpected(made.error());
  return RegistrationLog(std::make_unique<State>(State{file, config, std::move(*db)}));
}

Result<RegistrationLog> RegistrationLog::open_read_only(const std::filesystem::path& file) {
  auto db = Database::open(file, true);
  if (!db) return tl::unexpected(db.error());
  return RegistrationLog(std::make_unique<State>(State{file, {}, std::move(*db)}));
}

Status RegistrationLog::add(const LoggedRegistration& registration) {
  auto transaction = Transaction::begin(state_->db);
  if (!transaction) return tl::unexpected(transaction.error());
  constexpr std::size_t kPages = 16 * 1024;  // of rows, indices and the ends of clouds
  const std::size_t room = registration.target_cloud.size() + registration.source_cloud.size() + kPages;
  if (const Status made = state_->make_room(room); !made) return made;
  const auto target = state_->keep(registration.target_cloud);
  if (!target) return tl::unexpected(target.error());
  const auto source = state_->keep(registration.source_cloud);
  if (!source) return tl::unexpected(source.error());
  const StoredPrior prior = stored(registration.prior);
  Bytes prior_bytes(sizeof prior);
  std::memcpy(prior_bytes.data(), prior.data(), sizeof prior);
  auto insert = state_->db.prepare(
      "INSERT INTO registration(target_agent, target_seq, source_agent, source_seq, method, target_cloud, "
      "source_cloud, prior) VALUES(?, ?, ?, ?, ?, ?, ?, ?)");
  if (!insert) return tl::unexpected(insert.error());
  insert->bind(1, std::string_view(registration.target.agent.str()))
      .bind(2, std::int64_t{registration.target.seq})
      .bind(3, std::string_view(registration.source.agent.str()))
      .bind(4, std::int64_t{registration.source.seq})
      .bind(5, std::string_view(registration.method))
      .bind(6, std::string_view(*target))
      .bind(7, std::string_view(*source))
      .bind(8, ByteView(prior_bytes));
  if (const Status added = insert->run(); !added) return added;
  return transaction->commit();
}

Result<std::vector<LoggedRegistration>> RegistrationLog::read() const {
  auto rows = state_->db.prepare(
      "SELECT target_agent, target_seq, source_agent, source_seq, method, t.bytes, s.bytes, prior "
      "FROM registration JOIN cloud t ON t.hash = target_cloud JOIN cloud s ON s.hash = source_cloud "
      "ORDER BY id");
  if (!rows) return tl::unexpected(rows.error());
  std::vector<LoggedRegistration> all;
  while (true) {
    const auto row = rows->step();
    if (!row) return tl::unexpected(row.error());
    if (!*row) return all;
    const auto target = node_of(*rows, 0), source = node_of(*rows, 2);
    const auto prior = prior_of(rows->blob(7));
    if (!target || !source || !prior) {
      return failure(state_->file.string() + ": registration " + std::to_string(all.size() + 1) +
                     " is damaged; move the file away to go on without it");
    }
    all.push_back(
        {*target, *source, std::string(rows->text(4)), bytes_of(*rows, 5), bytes_of(*rows, 6), *prior});
  }
}

}  // namespace fleetmap::store
