// Documents as PDF, read back with poppler.
#include "viewer/document/pdf_document.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/viewer/pdf_words.h"

namespace lightwell::pdf_document_test {
namespace {

constexpr double mm = 72.0 / 25.4;

class PdfDocument : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(has_pdftotext()) << "install poppler-utils, as tests/run does";
  }
};

Document document_of(std::vector<DocumentBlock> blocks) {
  Document document{.title = "Title", .footer = "Footer"};
  document.sections.push_back({.title = "Section", .blocks = std::move(blocks)});
  return document;
}

const PdfWord& word_of(const PdfText& pdf, const std::string& text) {
  for (const PdfWord& word : pdf.words) {
    if (word.text == text) return word;
  }
  ADD_FAILURE() << "there is no word " << text;
  return pdf.words.front();
}

/// Neither the time nor the place of a run is in the file.
TEST_F(PdfDocument, SameDocumentSameBytes) {
  const Document document = document_of({DocumentParagraph{"Some <b>text</b>."}});
  const std::string bytes = pdf_document(document);
  EXPECT_EQ(bytes.substr(0, 5), "%PDF-");
  EXPECT_EQ(bytes, pdf_document(document));
  EXPECT_EQ(bytes.find("CreationDate"), std::string::npos);
}

TEST_F(PdfDocument, ACoverAndEverySectionArePages) {
  Document document = document_of({DocumentParagraph{"first"}});
  document.sections.push_back({.title = "Second"});
  document.sections.push_back({.title = "Third", .begins_page = false});
  const PdfText pdf = read_pdf(pdf_document(document));
  EXPECT_EQ(pdf.page_count, 3);
  EXPECT_EQ(word_of(pdf, "Second").page, 3);
  EXPECT_EQ(word_of(pdf, "Third").page, 3);
  for (const char* number : {"1 / 3", "2 / 3", "3 / 3"}) EXPECT_EQ(pdf.count(number), 1) << number;
  EXPECT_EQ(pdf.count("Footer"), 3);
  EXPECT_EQ(pdf.count("Footer · Second"), 1) << "the section that begins on the page";
}

/// Numbers of a column with and without decimals have their decimal signs in one line.
TEST_F(PdfDocument, NumbersAreAlignedAtTheDecimalSign) {
  DocumentTable table{.columns = {{"name", true}, {"value"}}};
  for (const char* value : {"12345", "1.25", "77.5"}) {
    table.rows.push_back({{{"row"}, {value, "± 0.5"}}});
  }
  const PdfText pdf = read_pdf(pdf_document(document_of({table})));
  const double whole = word_of(pdf, "12345").right;
  // Digits of DejaVu Sans are 0.636 of the size of 8.5 points, a point is 0.318; a part of a point
  // is lost where boxes are rounded.
  constexpr double digit = 0.636 * 8.5, sign = 0.318 * 8.5, rounding = 0.3;
  EXPECT_NEAR(word_of(pdf, "1.25").right - 2.0 * digit - sign, whole, rounding);
  EXPECT_NEAR(word_of(pdf, "77.5").right - digit - sign, whole, rounding);
}

/// A drawing whose viewBox is in millimetres has these millimetres on paper.
TEST_F(PdfDocument, DrawingsAreTrueToTheirScale) {
  const DocumentDrawing drawing{
      .caption = "Drawing",
      .svg =
          "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-10 -5 120 60\">"
          "<text x=\"0\" y=\"10\" class=\"value\">left</text>"
          "<text x=\"100\" y=\"40\" class=\"value\">rght</text></svg>"};
  const PdfText pdf = read_pdf(pdf_document(document_of({drawing})));
  const PdfWord &left = word_of(pdf, "left"), &right = word_of(pdf, "rght");
  const auto middle = [](const PdfWord& word) { return 0.5 * (word.left + word.right); };
  // The drawing begins 10 mm before its zero, at the margin of 13 mm. Letters of 2.1 mm are placed
  // to a hundredth of their size, and words of other letters have other bearings: 0.1 mm.
  constexpr double within = 0.1 * mm;
  EXPECT_NEAR(middle(left), 23.0 * mm, within);
  EXPECT_NEAR(middle(right) - middle(left), 100.0 * mm, within);
  EXPECT_NEAR(right.top - left.top, 30.0 * mm, within);
}

/// Columns of numbers that are wider than the page are set in smaller letters.
TEST_F(PdfDocument, WideTablesFitThePage) {
  DocumentTable table{.columns = {{"name", true}}};
  TableRow row{{{std::string(300, 'x')}}};
  for (int i = 0; i < 12; ++i) {
    table.columns.push_back({"number"});
    row.cells.push_back({"12345678901234567890", "± 1234567890"});
  }
  table.rows.push_back(row);
  EXPECT_TRUE(is_within_margins(read_pdf(pdf_document(document_of({table})))));
}

TEST_F(PdfDocument, ADrawingThatIsNoSvgIsAnError) {
  for (const char* svg : {"", "no svg", "<svg xmlns=\"http://www.w3.org/2000/svg\"></svg>"}) {
    const Document document = document_of({DocumentDrawing{.svg = svg}});
    EXPECT_THROW(pdf_document(document), std::runtime_error) << svg;
  }
}

TEST(MarkedText, HidesWhatWouldBeAMark) {
  EXPECT_EQ(marked("a<b> & \"c\"\n"), "a&lt;b> &amp; &quot;c&quot; ");
  EXPECT_EQ(marked("\xe9"), "é") << "Latin-1";
}

}  // namespace
}  // namespace lightwell::pdf_document_test
