#include "fleetmap/monitor/reasons.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <functional>
#include <map>

namespace fleetmap::monitor {
namespace {

/// A text around its numbers: words[k] precedes numbers[k], the last one follows all.
struct NumberedText {
  std::vector<std::string> words{""};
  std::vector<std::string> numbers;
};

NumberedText numbered_text(const std::string& reason) {
  NumberedText parts;
  const auto is_digit = [&](std::size_t k) {
    return k < reason.size() && std::isdigit(static_cast<unsigned char>(reason[k])) != 0;
  };
  for (std::size_t k = 0; k < reason.size(); ++k) {
    if (!is_digit(k)) {
      parts.words.back().push_back(reason[k]);
      continue;
    }
    const std::size_t begin = k;
    while (is_digit(k + 1) ||
           (reason[k] != '.' && k + 1 < reason.size() && reason[k + 1] == '.' && is_digit(k + 2)))
      ++k;
    parts.numbers.push_back(reason.substr(begin, k + 1 - begin));
    parts.words.emplace_back();
  }
  return parts;
}

/// The least and the greatest of numbers in the same place, as they were written.
struct NumberRange {
  std::string low, high;

  void add(const std::string& number) {
    const double value = std::atof(number.c_str());
    if (low.empty() || value < std::atof(low.c_str())) low = number;
    if (high.empty() || value > std::atof(high.c_str())) high = number;
  }
  std::string text() const { return low == high ? low : low + " to " + high; }
};

struct ReasonKind {
  std::vector<NumberRange> ranges;
  std::size_t count = 0;
};

std::string worded(const std::vector<std::string>& words, const std::vector<NumberRange>& ranges) {
  std::string text = words.front();
  for (std::size_t k = 0; k < ranges.size(); ++k) text.append(ranges[k].text()).append(words[k + 1]);
  return text;
}

}  // namespace

std::vector<Reason> reasons_of(const std::map<std::string, std::size_t>& counts) {
  std::map<std::vector<std::string>, ReasonKind> kinds;
  for (const auto& [text, count] : counts) {
    const NumberedText parts = numbered_text(text);
    ReasonKind& kind = kinds[parts.words];
    kind.ranges.resize(parts.numbers.size());
    kind.count += count;
    for (std::size_t k = 0; k < parts.numbers.size(); ++k) kind.ranges[k].add(parts.numbers[k]);
  }
  std::vector<Reason> sorted;
  for (const auto& [words, kind] : kinds) sorted.push_back({worded(words, kind.ranges), kind.count});
  std::ranges::stable_sort(sorted, std::greater{}, &Reason::count);
  return sorted;
}

std::vector<Reason> reasons_of(const std::vector<const Attempt*>& attempts) {
  std::map<std::string, std::size_t> counts;
  for (const Attempt* attempt : attempts) {
    if (attempt->verdict != "accepted")
      ++counts[attempt->reason.empty() ? attempt->verdict : attempt->reason];
  }
  return reasons_of(counts);
}

}  // namespace fleetmap::monitor
