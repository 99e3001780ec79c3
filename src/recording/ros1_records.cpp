#include "ros1_records.hpp"

#include <algorithm>

#include "fleetmap/core/byte_fields.hpp"
#include "unpack.hpp"

namespace fleetmap::recording::ros1 {
namespace {

std::uint64_t read_time(ByteFields& fields) {
  const auto seconds = fields.number<std::uint32_t>();
  return seconds * std::uint64_t{1'000'000'000} + fields.number<std::uint32_t>();
}

std::string text(ByteView bytes) { return {bytes.begin(), bytes.end()}; }

}  // namespace

std::optional<Record> take_record(ByteView& bytes) {
  ByteFields fields(bytes);
  Record record;
  record.header = fields.counted();
  record.data = fields.counted();
  if (!fields.whole()) return std::nullopt;
  bytes = fields.rest();
  return record;
}

ByteView field(const Record& record, std::string_view name) {
  ByteFields fields(record.header);
  while (fields.whole() && !fields.rest().empty()) {
    const ByteView entry = fields.counted();  // name=value
    const auto equals = std::ranges::find(entry, std::uint8_t{'='});
    if (equals == entry.end()) continue;
    if (std::ranges::equal(entry.begin(), equals, name.begin(), name.end()))
      return entry.subspan(static_cast<std::size_t>(equals - entry.begin()) + 1);
  }
  return {};
}

Op op(const Record& record) {
  return static_cast<Op>(ByteFields(field(record, "op")).number<std::uint8_t>());
}

std::optional<Connection> read_connection(const Record& record) {
  ByteFields id(field(record, "conn"));
  // Its data is a second header.
  const Record described{record.data, {}};
  Connection connection{id.number<std::uint32_t>(), text(field(record, "topic")),
                        text(field(described, "type"))};
  if (!id.whole() || connection.topic.empty()) return std::nullopt;
  return connection;
}

std::optional<Message> read_message(const Record& record) {
  ByteFields id(field(record, "conn")), time(field(record, "time"));
  const Message message{id.number<std::uint32_t>(), read_time(time)};
  if (!id.whole() || !time.whole()) return std::nullopt;
  return message;
}

std::optional<std::uint64_t> earliest(const Record& index) {
  std::optional<std::uint64_t> first;
  for (ByteFields fields(index.data); fields.rest().size() >= 12;) {
    const std::uint64_t time = read_time(fields);
    first = std::min(first.value_or(time), time);
    fields.number<std::uint32_t>();  // place in the chunk
  }
  return first;
}

Result<Bytes> unpack_records(const Record& chunk, std::size_t max_bytes) {
  const std::string compression = text(field(chunk, "compression"));
  const auto claimed = ByteFields(field(chunk, "size")).number<std::uint32_t>();
  if (claimed > max_bytes) return failure("claims " + std::to_string(claimed) + " bytes");
  Result<Bytes> records = Bytes();
  if (compression == "none") {
    records->assign(chunk.data.begin(), chunk.data.end());
  } else if (compression == "bz2") {
    records = unpack_bz2(chunk.data, claimed);
  } else if (compression == "lz4") {
    records = unpack_lz4(chunk.data, claimed);
  } else {
    return failure("its compression '" + compression + "' is none of bz2 and lz4");
  }
  if (records && records->size() != claimed) return failure("unpacks to fewer bytes than it claims");
  return records;
}

}  // namespace fleetmap::recording::ros1
