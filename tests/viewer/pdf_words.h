#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "tests/temporary_folder.h"

namespace lightwell {

/// A word of a PDF and its box, in points from the upper left corner of its page.
struct PdfWord {
  int page = 0;  ///< from 1
  double left = 0.0, top = 0.0, right = 0.0, bottom = 0.0;
  std::string text{};
};

/// Words of a PDF with their boxes, as poppler's pdftotext reads them; pages without words count in
/// `page_count`.
struct PdfText {
  int page_count = 0;
  std::vector<PdfWord> words{};
  std::string text{};  ///< of all pages, words and lines separated by single spaces

  int count(const std::string& phrase) const {
    int found = 0;
    for (std::size_t at = 0; (at = text.find(phrase, at)) != std::string::npos; ++at) ++found;
    return found;
  }
};

inline bool has_pdftotext() {
  return std::system("command -v pdftotext >/dev/null 2>&1") == 0;
}

inline double attribute(const std::string& line, const std::string& name) {
  const std::size_t at = line.find(name + "=\"");
  return std::stod(line.substr(at + name.size() + 2));
}

inline PdfText read_pdf(const std::string& bytes) {
  const TemporaryFolder folder;
  folder.write("a.pdf", bytes);
  const std::string command = "cd '" + folder.path().string() + "' && pdftotext -bbox a.pdf a.html";
  EXPECT_EQ(std::system(command.c_str()), 0);
  PdfText pdf;
  std::istringstream lines(content_of(folder / "a.html"));
  for (std::string line; std::getline(lines, line);) {
    if (line.find("<page ") != std::string::npos) ++pdf.page_count;
    if (line.find("<word ") == std::string::npos) continue;
    const std::size_t begin = line.find('>') + 1;
    pdf.words.push_back({pdf.page_count, attribute(line, "xMin"), attribute(line, "yMin"),
                         attribute(line, "xMax"), attribute(line, "yMax"),
                         line.substr(begin, line.rfind("</word>") - begin)});
    pdf.text += pdf.words.back().text + " ";
  }
  return pdf;
}

/// True if every word lies within the margins of an A4 page: 13 mm at the sides, 16 mm above, and
/// 10 mm below the footer.
inline testing::AssertionResult is_within_margins(const PdfText& pdf) {
  constexpr double mm = 72.0 / 25.4;
  // Side bearings of letters, and a box of a word that is its font's and not that of its letters.
  constexpr double slack = 1.5;  // points
  for (const PdfWord& word : pdf.words) {
    if (word.left < 13.0 * mm - slack || word.right > 197.0 * mm + slack ||
        word.top < 16.0 * mm - slack || word.bottom > 287.0 * mm + slack) {
      return testing::AssertionFailure()
             << "'" << word.text << "' on page " << word.page << " spans " << word.left << " to "
             << word.right << ", " << word.top << " to " << word.bottom << " points";
    }
  }
  return testing::AssertionSuccess();
}

}  // namespace lightwell
