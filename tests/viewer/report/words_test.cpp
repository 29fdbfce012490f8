// The table of words of a report in its languages.
#include "viewer/report/words.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace lightwell::words_test {
namespace {

constexpr Language languages[] = {Language::english, Language::german, Language::french,
                                  Language::spanish};

// Places {0}, {1}, ... of a text in rising order.
std::string places_of(const std::string& text) {
  std::string places;
  for (std::size_t at = 0; (at = text.find('{', at)) != std::string::npos; ++at) {
    places += text.at(at + 1);
  }
  std::ranges::sort(places);
  return places;
}

int count(const std::string& text, const std::string& part) {
  int found = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) ++found;
  return found;
}

/// A value that has no place in one language would be missing from that report.
TEST(Words, EachLanguageHasAllWordsWithTheSamePlacesAndMarks) {
  for (int i = 0; i < static_cast<int>(Word::count); ++i) {
    const auto word = static_cast<Word>(i);
    const std::string english = word_in(Language::english, word);
    for (const Language language : languages) {
      const std::string text = word_in(language, word);
      SCOPED_TRACE(text);
      EXPECT_FALSE(text.empty()) << i << " " << code_of(language);
      EXPECT_EQ(places_of(text), places_of(english));
      for (const char* mark : {"<b>", "</b>", "<sub>", "</sub>", "<small>"}) {
        EXPECT_EQ(count(text, mark), count(english, mark)) << mark;
      }
      EXPECT_EQ(count(text, "  "), 0);
      EXPECT_EQ(count(text, "\""), 0) << "marks of quotation are those of the language";
    }
  }
}

/// Words that are the same in two languages are figures, symbols and words that both have.
TEST(Words, SentencesAreTranslated) {
  for (int i = 0; i < static_cast<int>(Word::count); ++i) {
    const auto word = static_cast<Word>(i);
    const std::string english = word_in(Language::english, word);
    if (std::ranges::count(english, ' ') < 3) continue;
    if (word == Word::plan_caption || word == Word::count_of) continue;  // symbols and places
    for (const Language language : languages) {
      if (language == Language::english) continue;
      EXPECT_NE(english, word_in(language, word));
    }
  }
}

TEST(Words, CodesNameLanguages) {
  for (const Language language : languages) EXPECT_EQ(language_of(code_of(language)), language);
  EXPECT_FALSE(language_of("it").has_value());
  EXPECT_FALSE(language_of("").has_value());
}

TEST(Words, ValuesTakeTheirPlaces) {
  EXPECT_EQ(worded(Language::english, Word::grid_size, {"1", "2", "3", "4"}),
            "1 m × 2 m, a point every 3 m × 4 m.");
  EXPECT_EQ(worded(Language::english, Word::watts_each), " W each") << "no value, no place";
  EXPECT_EQ(number_in(Language::german, "12.5"), "12,5");
  EXPECT_EQ(number_in(Language::english, "12.5"), "12.5");
}

}  // namespace
}  // namespace lightwell::words_test
