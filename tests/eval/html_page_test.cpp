#include "fleetmap/eval/html_page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/file_content.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::eval {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;

/// The text between the title and the end of the body.
std::string body(const HtmlPage& page) {
  const std::string html = page.str();
  const std::size_t begin = html.find("</h1>\n") + 6;
  return html.substr(begin, html.find("</body>") - begin);
}

TEST(HtmlPage, StandInTheirOrder) {
  HtmlPage page("t");
  page.heading("Map").paragraph("one & two").details("all", "a <b>");
  EXPECT_EQ(body(page),
            "<h2>Map</h2>\n<p>one &amp; two</p>\n"
            "<details><summary>all</summary><pre>a &lt;b&gt;</pre></details>\n");
}

TEST(HtmlPage, TheFirstRowOfATableNamesItsColumns) {
  HtmlPage page("t");
  page.table({{"robot", "m"}, {"r1", "<3"}});
  EXPECT_EQ(body(page),
            "<div class=\"scroll\"><table>\n<tr><th>robot</th><th>m</th></tr>\n"
            "<tr><td>r1</td><td>&lt;3</td></tr>\n</table></div>\n");
}

TEST(HtmlPage, ASentenceInATableWrapsAndANumberDoesNot) {
  HtmlPage page("t");
  page.table({{"pair", "why"}, {"r1 - r2", std::string(40, 'x')}, {"r1 - r3", std::string(41, '<')}});
  EXPECT_THAT(body(page), HasSubstr("<td>" + std::string(40, 'x') + "</td>"));
  EXPECT_THAT(body(page), HasSubstr("<td>r1 - r3</td><td class=\"sentence\">&lt;"));
}

TEST(HtmlPage, WarningsAreAListAndEscaped) {
  HtmlPage page("t");
  page.warnings({"r1 <b>", "two"});
  EXPECT_EQ(body(page), "<ul class=\"warnings\">\n<li>r1 &lt;b&gt;</li>\n<li>two</li>\n</ul>\n");
}

TEST(HtmlPage, FiguresThatFollowEachOtherStandTogether) {
  HtmlPage page("t");
  page.figure("<svg/>", "a & b").figure("<svg/>").paragraph("p").figure("<svg/>");
  EXPECT_EQ(body(page),
            "<div class=\"figures\">\n<figure><svg/><figcaption>a &amp; b</figcaption></figure>\n"
            "<figure><svg/></figure>\n</div>\n<p>p</p>\n"
            "<div class=\"figures\">\n<figure><svg/></figure>\n</div>\n");
}

TEST(HtmlPage, APageNamesItsTitleTwiceAndNoOtherFile) {
  HtmlPage page("run <7>");
  page.picture({0xff, 0x00}, "\"a\"");
  const std::string html = page.str();
  EXPECT_THAT(html, HasSubstr("<title>run &lt;7&gt;</title>"));
  EXPECT_THAT(html, HasSubstr("<h1>run &lt;7&gt;</h1>"));
  EXPECT_THAT(html, HasSubstr("<img alt=\"&quot;a&quot;\" src=\"data:image/png;base64,/wA=\">"));
  EXPECT_THAT(html, EndsWith("</div>\n</body></html>\n"));
  for (const char* outside : {"http:", "https:", "<script", "<link"})
    EXPECT_THAT(html, Not(HasSubstr(outside)));
}

TEST(HtmlPage, AFileHoldsThePageOrTheErrorNamesIt) {
  const testing::TemporaryFolder folder;
  const auto file = folder.write("a.html", "an older and longer page" + std::string(9999, ' '));
  HtmlPage page("t");
  page.paragraph("p");
  ASSERT_TRUE(page.write(file));
  EXPECT_EQ(testing::file_text(file), page.str());
  const auto none = folder.path() / "none" / "a.html";
  const Status status = page.write(none);
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().message, none.string() + ": cannot be written: No such file or directory");
}

TEST(Base64, UsesAll64LettersAndPads) {
  std::vector<std::uint8_t> bytes;
  for (int k = 0; k < 64; k += 4) {
    bytes.push_back(static_cast<std::uint8_t>(k << 2 | (k + 1) >> 4));
    bytes.push_back(static_cast<std::uint8_t>((k + 1) << 4 | (k + 2) >> 2));
    bytes.push_back(static_cast<std::uint8_t>((k + 2) << 6 | (k + 3)));
  }
  EXPECT_EQ(base64(bytes), "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/");
  EXPECT_EQ(base64({0xff}), "/w==");
  EXPECT_EQ(base64({0xff, 0xff}), "//8=");
}

}  // namespace
}  // namespace fleetmap::eval
