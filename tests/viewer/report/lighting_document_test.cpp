// A report as a document: HTML and PDF of it have every figure, in every language.
#include "viewer/report/lighting_document.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/viewer/pdf_words.h"
#include "tests/viewer/report/made_report.h"
#include "viewer/document/html_document.h"
#include "viewer/document/pdf_document.h"
#include "viewer/report/figures.h"
#include "viewer/report/lighting_tables.h"
#include "viewer/report/standard_tables.h"

namespace lightwell::lighting_document_test {
namespace {

std::string html_of(const LightingReport& report, Language language = Language::english) {
  return html_document(lighting_document(report, {}, language));
}

// The figures of a report as its readers see them.
std::set<std::string> figures_of(const LightingReport& report, Language language) {
  std::set<std::string> figures = {
      "0123456789abcdef", number_in(language, fmt::format("{:g}", report.maintenance_factor)),
      fmt::format("{}", report.rays), percent_text(report.error_estimate, language)};
  const auto add = [&](const char* form, double value) {
    figures.insert(number_in(language, fmt::format(fmt::runtime(form), value)));
  };
  const nlohmann::ordered_json json = figures_json(report);
  for (const auto& surface : json["surfaces"]) {
    for (const char* key :
         {"E_m", "E_min", "E_max", "mean_within", "E_min_within", "E_max_within"}) {
      figures.insert(lux_text(surface[key].get<double>(), language));
    }
    for (const char* key : {"U_0", "area_m2", "W_per_m2", "W_per_m2_per_100_lx"}) {
      add("{:.2f}", surface[key].get<double>());
    }
    figures.insert(surface["points"].dump());
  }
  for (const auto& row : json["luminaires"]) {
    add("{:.0f}", row["lumens"].get<double>());
    add("{:.1f}", row["watts"].get<double>());
    figures.insert(row["number"].dump());
  }
  for (const auto& observer : json["observers"]) {
    add("{:.1f}", observer["UGR"].get<double>());
    add("{:.4g}", observer["background_luminance"].get<double>());
    for (const auto& source : observer["sources"]) {
      add("{:.0f}", source["luminance"].get<double>());
      add("{:.3g}", source["solid_angle"].get<double>());
      add("{:.2f}", source["position_index"].get<double>());
    }
  }
  return figures;
}

constexpr Language report_languages[] = {Language::english, Language::german, Language::french,
                                         Language::spanish};

TEST(LightingDocument, ThePageHasEveryFigureInEveryLanguage) {
  const LightingReport report = made_report(3, 3);
  for (const Language language : report_languages) {
    const std::string page = html_of(report, language);
    for (const std::string& figure : figures_of(report, language)) {
      EXPECT_NE(page.find(figure), std::string::npos) << figure << " in " << code_of(language);
    }
    EXPECT_TRUE(says(page, std::string("<html lang=\"") + code_of(language)));
    EXPECT_TRUE(says(page, "bare bulb")) << "a lamp without UGR";
  }
}

/// Every piece of English that is not also German.
TEST(LightingDocument, NoEnglishIsLeftInTheGermanPage) {
  LightingReport report = made_report(2, 2);
  for (const LightContent content : {LightContent::electric, LightContent::together}) {
    report.content = content;
    report.sky = "CIE overcast";
    const std::string page = html_of(report, Language::german);
    for (int i = 0; i < static_cast<int>(Word::count); ++i) {
      const auto word = static_cast<Word>(i);
      const std::string english = word_in(Language::english, word);
      if (english == word_in(Language::german, word)) continue;
      EXPECT_EQ(page.find(">" + english + "<"), std::string::npos) << english;
      // Words may be parts of other words; phrases are looked for up to their first value.
      const std::string phrase = english.substr(0, english.find('{'));
      if (phrase.find(' ') == std::string::npos) continue;
      EXPECT_EQ(page.find(phrase), std::string::npos) << english;
    }
    EXPECT_TRUE(says(page, "Wartungsfaktor"));
    EXPECT_TRUE(says(page, "mittlere Beleuchtungsstärke"));
    EXPECT_TRUE(says(page, "Gleichmäßigkeit"));
  }
}

/// With electric light and daylight apart, a surface has a row for each and one for both.
TEST(LightingDocument, PartsOfTheLightHaveRowsOfTheirOwn) {
  LightingReport report = made_report(1, 1);
  report.content = LightContent::apart;
  report.surfaces[0].electric = report.surfaces[0].field;
  report.surfaces[0].daylight = report.surfaces[0].field;
  const DocumentTable table = illuminance_table(report, Language::english);
  ASSERT_EQ(table.rows.size(), 4u);
  EXPECT_EQ(table.rows[0].kind, RowKind::group);
  for (const TableRow& row : table.rows) EXPECT_EQ(row.cells.size(), table.columns.size());
  EXPECT_EQ(table.rows[3].cells[0].text, "both");
}

/// Limits have a table for each area, with the figure, its bound, the limit and the verdict;
/// without a figure, a dash.
TEST(LightingDocument, LimitsOfStandardsHaveATableForEachArea) {
  LightingReport report = made_report(1, 1);
  report.requirements = {
      {.area = "desk", .place = "top", .limit = 500, .value = 512, .within = 4},
      {.area = "desk", .place = "chair", .figure = Figure::glare, .is_upper = true, .limit = 19},
      {.area = "way",
       .place = "floor",
       .figure = Figure::uniformity,
       .is_recommended = true,
       .limit = 0.4,
       .value = 0.31,
       .within = 0.02}};
  const auto tables = requirement_tables(report.requirements, Language::german);
  ASSERT_EQ(tables.size(), 2u);
  EXPECT_EQ(tables[0].title, "desk: eingehalten");
  ASSERT_EQ(tables[0].rows.size(), 2u);
  EXPECT_EQ(tables[0].rows[0].cells[2].text, "512");
  EXPECT_EQ(tables[0].rows[0].cells[2].bound, "± 4");
  EXPECT_EQ(tables[0].rows[0].cells[3].text, "≥ 500");
  EXPECT_EQ(tables[0].rows[1].cells[2].text, "–");
  EXPECT_EQ(tables[0].rows[1].cells[3].text, "≤ 19,0");
  EXPECT_EQ(tables[1].rows[0].cells[2].text, "0,31");
  EXPECT_EQ(tables[1].rows[0].cells[4].text, "verfehlt (empfohlen)");
  EXPECT_EQ(tables[1].title, "way: eingehalten") << "advice misses nothing";
  EXPECT_TRUE(says(html_of(report), "Limits of standards"));
}

/// Without wavelengths there are lux alone.
TEST(LightingDocument, LightAtTheEyeHasARowForEachObserver) {
  LightingReport report = made_report(1, 1);
  ASSERT_FALSE(report.observers.empty());
  Observer& first = report.observers.front();
  first.lux = 312.0;
  first.lux_within = 2.5;
  const TableRow grey = eye_table(report, Language::french).rows.front();
  EXPECT_EQ(grey.cells[1].text, "312");
  EXPECT_EQ(grey.cells[1].bound, "± 2,50");
  EXPECT_EQ(grey.cells[2].text, "–");
  first.light = eye_light(daylight_illuminant(6504.0));
  const TableRow row = eye_table(report, Language::french).rows.front();
  EXPECT_EQ(row.cells[3].text, "1,00");
  EXPECT_EQ(row.cells[4].text, fmt::format("{:.0f}", *first.light->colour_temperature));
  EXPECT_EQ(row.cells[5].text, "100");
}

/// Without surfaces, luminaires, observers or pictures there is a document still.
TEST(LightingDocument, OfNothingIsADocument) {
  LightingReport report = made_report(0, 0);
  report.observers.clear();
  const std::string page = html_of(report);
  EXPECT_TRUE(says(page, "No luminaires"));
  EXPECT_EQ(page.find("Glare"), std::string::npos);
}

#ifdef LIGHTWELL_PDF
class LightingPdf : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(has_pdftotext()) << "install poppler-utils, as tests/run does";
  }
  static PdfText pdf_of(const LightingReport& report, Language language = Language::english) {
    return read_pdf(pdf_document(lighting_document(report, {}, language)));
  }
};

TEST_F(LightingPdf, HasEveryFigureInEveryLanguage) {
  const LightingReport report = made_report(3, 3);
  for (const Language language : report_languages) {
    const PdfText pdf = pdf_of(report, language);
    for (const std::string& figure : figures_of(report, language)) {
      // The narrow space before a percent sign separates words.
      const std::string shown = figure.substr(0, figure.find("\u202f"));
      EXPECT_GE(pdf.count(shown), 1) << figure << " in " << code_of(language);
    }
    EXPECT_TRUE(is_within_margins(pdf));
    EXPECT_GE(pdf.count("Project A"), pdf.page_count) << "in the footer of each page";
  }
}

/// Thirty grids and sixty luminaires have tables of more than one page, with a head on each.
TEST_F(LightingPdf, LongTablesRepeatTheirHeads) {
  const LightingReport report = made_report(30, 60);
  const PdfText pdf = pdf_of(report);
  EXPECT_TRUE(is_within_margins(pdf));
  // A row is 14 points high at least, and a page 260 mm: 60 rows of luminaires and 30 of grids with
  // 30 of power take at least two pages each.
  EXPECT_GE(pdf.count("flux, lm"), 2);
  EXPECT_GE(pdf.count("calculation surface"), 3);
  EXPECT_EQ(pdf.count("lamp 60 "), 1);
  EXPECT_EQ(pdf.count(fmt::format("{0} / {0}", pdf.page_count)), 1);
}

TEST_F(LightingPdf, NamesOfAnyLengthAndBytesStayOnThePage) {
  LightingReport report = made_report(2, 2);
  const std::string name(200, 'W');
  report.title = name + " " + name;
  report.heading.project = name;
  report.heading.remarks.clear();
  for (int i = 0; i < 2000; ++i) report.heading.remarks += "remark ";
  report.surfaces[0].grid.name = name;
  report.surfaces[1].grid.name = "Büro <2> & \"é\" \xff\xfe 照度";
  report.luminaires[0].name = name;
  report.luminaires[1].flux = 1e30;
  report.observers[0].name = name;
  report.observers[0].glare.sources[0].name = name;
  report.observers[0].glare.left_out = {name};
  const PdfText pdf = pdf_of(report);
  EXPECT_TRUE(is_within_margins(pdf));
  EXPECT_GE(pdf.count("remark"), 2000);
  EXPECT_GE(pdf.count("&lt;2&gt;"), 1);
}
#endif

}  // namespace
}  // namespace lightwell::lighting_document_test
