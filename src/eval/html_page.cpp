#include "fleetmap/eval/html_page.hpp"

#include "fleetmap/core/whole_file.hpp"
#include "fleetmap/eval/plot.hpp"

namespace fleetmap::eval {
namespace {

constexpr std::size_t kShortCell = 40;  // characters; longer ones wrap

constexpr const char* kStyle = R"(
:root{color-scheme:light dark}
body{font:15px/1.5 system-ui,sans-serif;margin:0 auto;padding:1.5rem;max-width:1400px;color:#1b1f24;background:#fff}
h1{font-size:1.6rem;margin:0 0 1rem}h2{font-size:1.15rem;margin:2rem 0 .6rem}
.scroll{overflow-x:auto}
table{border-collapse:collapse;font-variant-numeric:tabular-nums}
th,td{padding:.3rem .7rem;text-align:right;border-bottom:1px solid #d5d9de;white-space:nowrap}
th{font-weight:600}th:first-child,td:first-child,td.sentence{text-align:left}
td.sentence{white-space:normal;min-width:15rem}
h1,h2,p,li,td.sentence,figcaption{overflow-wrap:anywhere}
ul.warnings{list-style:none;padding:0}
.warnings li{border-left:4px solid #c2410c;background:#fff4ec;padding:.4rem .8rem;margin:.4rem 0}
.figures{display:flex;flex-wrap:wrap;gap:1rem}
figure{margin:0;flex:1 1 420px;max-width:100%}
figure svg,figure img{width:100%;height:auto;border-radius:4px}
figcaption{font-size:.85rem;opacity:.75}
pre{overflow-x:auto;font-size:.8rem}
@media(prefers-color-scheme:dark){body{color:#dfe3e8;background:#15181c}th,td{border-color:#3a4048}
.warnings li{background:#33211a}}
@media(max-width:600px){body{padding:1rem}th,td{padding:.25rem .35rem}th{white-space:normal}td{font-size:.9rem}}
)";

}  // namespace

std::string base64(const std::vector<std::uint8_t>& bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = bytes.size() - i;
    const std::uint32_t group = static_cast<std::uint32_t>(bytes[i]) << 16 |
                                (left > 1 ? static_cast<std::uint32_t>(bytes[i + 1]) << 8 : 0u) |
                                (left > 2 ? static_cast<std::uint32_t>(bytes[i + 2]) : 0u);
    text += kDigits[group >> 18];
    text += kDigits[group >> 12 & 63];
    text += left > 1 ? kDigits[group >> 6 & 63] : '=';
    text += left > 2 ? kDigits[group & 63] : '=';
  }
  return text;
}

void HtmlPage::close_figures() {
  if (in_figures_) body_ += "</div>\n";
  in_figures_ = false;
}

HtmlPage& HtmlPage::heading(const std::string& text) {
  close_figures();
  body_ += "<h2>" + escaped(text) + "</h2>\n";
  return *this;
}

HtmlPage& HtmlPage::paragraph(const std::string& text) {
  close_figures();
  body_ += "<p>" + escaped(text) + "</p>\n";
  return *this;
}

HtmlPage& HtmlPage::table(const Table& rows) {
  close_figures();
  body_ += "<div class=\"scroll\"><table>\n";
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const std::string tag = r == 0 ? "th" : "td";
    body_ += "<tr>";
    for (const std::string& cell : rows[r]) {
      const bool wraps = r > 0 && cell.size() > kShortCell;
      body_ += "<" + tag + (wraps ? " class=\"sentence\"" : "") + ">" + escaped(cell) + "</" + tag + ">";
    }
    body_ += "</tr>\n";
  }
  body_ += "</table></div>\n";
  return *this;
}

HtmlPage& HtmlPage::warnings(const std::vector<std::string>& sentences) {
  close_figures();
  body_ += "<ul class=\"warnings\">\n";
  for (const std::string& sentence : sentences) body_ += "<li>" + escaped(sentence) + "</li>\n";
  body_ += "</ul>\n";
  return *this;
}

HtmlPage& HtmlPage::figure(const std::string& svg, const std::string& caption) {
  if (!in_figures_) body_ += "<div class=\"figures\">\n";
  in_figures_ = true;
  body_ += "<figure>" + svg;
  if (!caption.empty()) body_ += "<figcaption>" + escaped(caption) + "</figcaption>";
  body_ += "</figure>\n";
  return *this;
}

HtmlPage& HtmlPage::picture(const std::vector<std::uint8_t>& png, const std::string& caption) {
  return figure("<img alt=\"" + escaped(caption) + "\" src=\"data:image/png;base64," + base64(png) + "\">",
                caption);
}

HtmlPage& HtmlPage::details(const std::string& summary, const std::string& preformatted) {
  close_figures();
  body_ += "<details><summary>" + escaped(summary) + "</summary><pre>" + escaped(preformatted) +
           "</pre></details>\n";
  return *this;
}

std::string HtmlPage::str() const {
  return "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
         "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n<title>" +
         escaped(title_) + "</title>\n<style>" + kStyle + "</style></head>\n<body>\n<h1>" + escaped(title_) +
         "</h1>\n" + body_ + (in_figures_ ? "</div>\n" : "") + "</body></html>\n";
}

Status HtmlPage::write(const std::filesystem::path& file) const { return write_whole_file(file, str()); }

}  // namespace fleetmap::eval
