#include "fleetmap/sensor/nmea_sentences.hpp"

#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <utility>

namespace fleetmap::sensor {
namespace {

/// The standard allows 82; receivers with more digits send a little more.
constexpr std::size_t kMaxSentence = 120;
constexpr std::size_t kMaxFields = 24;

/// A field that is absent is empty; one that is malformed makes the sentence so.
class SentenceFields {
 public:
  explicit SentenceFields(std::string_view sentence) {
    for (std::string_view& field : fields_) {
      const auto comma = sentence.find(',');
      field = sentence.substr(0, comma);
      if (comma == std::string_view::npos) break;
      sentence.remove_prefix(comma + 1);
    }
  }
  std::string_view text(std::size_t at) const { return fields_[at]; }
  std::optional<double> number(std::size_t at) { return number(fields_[at]); }
  std::optional<double> number(std::string_view text) {
    if (text.empty()) return std::nullopt;
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc{} && end == text.data() + text.size() && std::isfinite(value)) return value;
    malformed_ = true;
    return std::nullopt;
  }
  /// hhmmss.ss
  std::optional<Duration> time(std::size_t at) {
    const std::string_view text = fields_[at];
    if (text.empty()) return std::nullopt;
    const auto hours = number(text.substr(0, 2)),
               minutes = number(text.substr(std::min<std::size_t>(2, text.size()), 2)),
               seconds = number(text.substr(std::min<std::size_t>(4, text.size())));
    if (!hours || !minutes || !seconds) return malformed<Duration>();
    if (!within(*hours, 23) || !within(*minutes, 59) || !within(*seconds, 60.999))
      return malformed<Duration>();
    return std::chrono::hours(std::lround(*hours)) + std::chrono::minutes(std::lround(*minutes)) +
           from_seconds(*seconds);
  }
  /// Degrees of ddmm.mmm or dddmm.mmm and its hemisphere in the field behind.
  std::optional<double> angle(std::size_t at, std::size_t degree_digits, char positive, char negative) {
    const std::string_view text = fields_[at], hemisphere = fields_[at + 1];
    if (text.empty() && hemisphere.empty()) return std::nullopt;
    const auto degrees = number(text.substr(0, degree_digits));
    const auto minutes = number(text.substr(std::min(degree_digits, text.size())));
    const bool known = hemisphere.size() == 1 && (hemisphere[0] == positive || hemisphere[0] == negative);
    if (!degrees || !minutes || !known || !within(*degrees, 180.0) || !within(*minutes, 59.9999999999))
      return malformed<double>();
    return (hemisphere[0] == negative ? -1.0 : 1.0) * (*degrees + *minutes / 60.0);
  }
  /// Midnight of ddmmyy, in the century from 1980.
  std::optional<Stamp> date(std::size_t at) {
    const std::string_view text = fields_[at];
    if (text.empty()) return std::nullopt;
    if (text.size() != 6) return malformed<Stamp>();
    std::array<unsigned, 3> parts{};  // day, month, year
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const char* begin = text.data() + 2 * k;
      if (std::from_chars(begin, begin + 2, parts[k]).ptr != begin + 2) return malformed<Stamp>();
    }
    const std::chrono::year_month_day date{
        std::chrono::year(static_cast<int>(parts[2]) + (parts[2] < 80 ? 2000 : 1900)),
        std::chrono::month(parts[1]), std::chrono::day(parts[0])};
    if (!date.ok()) return malformed<Stamp>();
    return Stamp(std::chrono::sys_days(date));
  }
  bool malformed() const { return malformed_; }

 private:
  static bool within(double value, double max) { return value >= 0.0 && value <= max; }
  template <class T>
  std::optional<T> malformed() {
    malformed_ = true;
    return std::nullopt;
  }
  std::array<std::string_view, kMaxFields> fields_;
  bool malformed_ = false;
};

NmeaSentence read_gga(SentenceFields& fields) {
  const auto time = fields.time(1);
  NmeaGga gga{.time = time.value_or(Duration::zero())};
  const auto latitude = fields.angle(2, 2, 'N', 'S'), longitude = fields.angle(4, 3, 'E', 'W');
  gga.quality = static_cast<int>(std::min(9.0, std::max(0.0, fields.number(6).value_or(0.0))));
  const auto altitude = fields.number(9), geoid = fields.number(11);
  gga.has_geoid = geoid.has_value();
  if (latitude && longitude)
    gga.position =
        geo_point_from_degrees(*latitude, *longitude, altitude.value_or(0.0) + geoid.value_or(0.0));
  if (!latitude || !longitude || !altitude) gga.quality = 0;
  return time ? NmeaSentence(gga) : NmeaOther{};
}

NmeaSentence read_rmc(SentenceFields& fields) {
  const auto time = fields.time(1);
  const auto midnight = fields.date(9);
  if (!time || !midnight) return NmeaOther{};
  return NmeaRmc{*time, fields.text(2) == "A", *midnight};
}

NmeaSentence read_gst(SentenceFields& fields) {
  const auto time = fields.time(1);
  const auto north = fields.number(6), east = fields.number(7), up = fields.number(8);
  if (!time || !north || !east || !up) return NmeaOther{};
  return NmeaGst{*time, *east, *north, *up};
}

}  // namespace

std::vector<std::string> NmeaSentences::add(ByteView bytes) {
  std::vector<std::string> sentences;
  for (const std::uint8_t byte : bytes) {
    if (byte == '$') {
      if (sentence_) ++counters_.cut;
      sentence_.emplace();
    } else if (!sentence_) {
      continue;
    } else if (byte == '\n' || byte == '\r') {
      end(sentences);
    } else if (sentence_->size() == kMaxSentence) {
      ++counters_.cut;
      sentence_.reset();
    } else {
      sentence_->push_back(static_cast<char>(byte));
    }
  }
  return sentences;
}

void NmeaSentences::end(std::vector<std::string>& sentences) {
  const std::string text = *std::exchange(sentence_, std::nullopt);
  const auto star = text.rfind('*');
  std::uint8_t sum = 0, stated = 0;
  for (const char c : std::string_view(text).substr(0, star)) sum = static_cast<std::uint8_t>(sum ^ c);
  const char* last = text.data() + text.size();
  const bool has_sum = star != std::string::npos && text.size() == star + 3 &&
                       std::from_chars(text.data() + star + 1, last, stated, 16).ptr == last;
  if (!has_sum || sum != stated) return void(++counters_.wrong_checksums);
  ++counters_.sentences;
  sentences.push_back(text.substr(0, star));
}

std::optional<NmeaSentence> read_nmea(std::string_view sentence) {
  SentenceFields fields(sentence);
  const std::string_view name = fields.text(0);
  const std::string_view type = name.size() == 5 ? name.substr(2) : std::string_view();
  NmeaSentence read;
  if (type == "GGA") read = read_gga(fields);
  if (type == "RMC") read = read_rmc(fields);
  if (type == "GST") read = read_gst(fields);
  if (fields.malformed()) return std::nullopt;
  return read;
}

}  // namespace fleetmap::sensor
