#include "scene/utf8.h"

#include <gtest/gtest.h>

namespace lightwell {
namespace {

using namespace std::string_view_literals;

TEST(Utf8, KeepsWhatIsValid) {
  for (const auto text : {"plain"sv, "K\u00fcche"sv, "\u53f0\u6240"sv, "\U0001f4a1 lamp"sv}) {
    EXPECT_EQ(as_utf8(text), text);
  }
}

TEST(Utf8, TakesOtherBytesAsLatin1) {
  EXPECT_EQ(as_utf8("K\xfc"
                    "che"),
            "K\u00fcche");
  EXPECT_EQ(as_utf8("\xff"), "\u00ff");
  EXPECT_EQ(as_utf8("end \xe5\x8f"), "end \u00e5\u008f") << "a character that is cut off";
}

// An overlong "/", a surrogate, U+FFFE and a number beyond the last character (RFC 3629).
TEST(Utf8, KnowsWhatIsNoCharacter) {
  for (const auto bytes :
       {"\xc0\xaf"sv, "\xe0\x80\xaf"sv, "\xed\xa0\x80"sv, "\xef\xbf\xbe"sv, "\xf4\x90\x80\x80"sv}) {
    const std::string text = as_utf8(bytes);
    EXPECT_EQ(text.size(), 2 * bytes.size());
    EXPECT_EQ(as_utf8(text), text);
  }
}

TEST(Utf8, LeavesControlCharactersOut) {
  EXPECT_EQ(as_utf8("a\x1b[31m\tb\x7f\0c"sv), "a[31mbc");
}

}  // namespace
}  // namespace lightwell
