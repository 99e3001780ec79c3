#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "fleetmap/core/result.hpp"

namespace fleetmap::eval {

/// The first row names the columns. Every cell is escaped; sentences wrap, short cells do not.
using Table = std::vector<std::vector<std::string>>;

/// One HTML page that needs no other file, light or dark as the reader's system is, for wide and narrow
/// screens. Text is escaped; SVG is taken as it is.
class HtmlPage {
 public:
  explicit HtmlPage(std::string title) : title_(std::move(title)) {}
  HtmlPage& heading(const std::string& text);
  HtmlPage& paragraph(const std::string& text);
  HtmlPage& table(const Table& rows);
  /// Sentences that stand out from the rest.
  HtmlPage& warnings(const std::vector<std::string>& sentences);
  /// Figures that follow each other stand side by side where there is room.
  HtmlPage& figure(const std::string& svg, const std::string& caption = "");
  HtmlPage& picture(const std::vector<std::uint8_t>& png, const std::string& caption);
  /// Folded until the reader asks for it.
  HtmlPage& details(const std::string& summary, const std::string& preformatted);
  std::string str() const;
  Status write(const std::filesystem::path& file) const;

 private:
  void close_figures();
  std::string title_;
  std::string body_;
  bool in_figures_ = false;
};

std::string base64(const std::vector<std::uint8_t>& bytes);

}  // namespace fleetmap::eval
