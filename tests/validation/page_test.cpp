#include "validation/page/validation_page.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/validation/made_up_cases.h"
#include "validation/page/validation_plots.h"
#include "validation/page/validation_text.h"

namespace lightwell::page_test {
namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(ValidationText, JsonHasTheKeysOfTheContract) {
  const ValidationRun run = run_validation(test::made_up_cases());
  const nlohmann::json json = nlohmann::json::parse(validation_json(run));
  EXPECT_EQ(json["passed"], 1);
  EXPECT_EQ(json["failed"], 2);
  const nlohmann::json& right = json["cases"][0];
  EXPECT_EQ(right["id"], "right");
  EXPECT_EQ(right["group"], "made up");
  EXPECT_EQ(right["expected"], 2.0);
  EXPECT_EQ(right["computed"], 2.05);
  EXPECT_NEAR(right["error"].get<double>(), 0.05, 1e-12);
  EXPECT_EQ(right["tolerance"], 0.1);
  EXPECT_EQ(right["pass"], true);
  EXPECT_EQ(json["cases"][1]["pass"], false);
  EXPECT_EQ(json["cases"][2]["failure"], "the lamp is out");
  EXPECT_TRUE(json["cases"][3]["pass"].is_null());
}

TEST(ValidationText, TableAndMarkdownShowFailuresAndMistakes) {
  const ValidationRun run = run_validation(test::made_up_cases());
  EXPECT_TRUE(has(table_line(run.results[1]), "FAIL"));
  EXPECT_TRUE(has(table_line(run.results[2]), "the lamp is out"));
  EXPECT_TRUE(has(table_line(run.results[3]), "nothing here can do that"));
  const std::string page = validation_markdown(run);
  EXPECT_TRUE(has(page, "**1 of 3 cases pass.**"));
  EXPECT_TRUE(
      has(page, "| `wrong` | a title with < and \\| | 1 | 1.3 | 3.0e-01 of 1.0e-01 | FAIL |"))
      << page;
  EXPECT_TRUE(has(page, "Another program: 2.2"));
  EXPECT_TRUE(has(page, "its cosine is not one"));
}

TEST(ValidationPage, ShowsVerdictPlotAndEscapedNames) {
  const ValidationRun run = run_validation(test::made_up_cases());
  const std::string page = validation_html(run, "1.2.3");
  EXPECT_TRUE(has(page, "Validation of Lightwell 1.2.3"));
  EXPECT_TRUE(has(page, "1 of 3 cases pass"));
  EXPECT_TRUE(has(page, "a title with &lt; and |"));
  EXPECT_FALSE(has(page, "title with < and"));
  EXPECT_TRUE(has(page, "<b>the lamp is out</b>"));
  EXPECT_TRUE(has(page, "<title>right: error"));
  EXPECT_TRUE(page.ends_with("</body></html>\n"));
}

TEST(ValidationPlots, DrawLinesOfNamedPlaces) {
  ComparedValues values;
  for (const char* name : {"first", "second"}) {
    for (int i = 0; i < 6; ++i) {
      values.push_back({std::string(name) + ", point " + std::to_string(i), 1.0 * i, 1.0 * i, 0.1});
    }
  }
  const ValidationRun run =
      run_validation({test::made_up_case("lines", values), test::made_up_case("one", {{}})});
  const std::string svg = values_plot(run.results[0]);
  EXPECT_TRUE(has(svg, ">first</text>"));
  EXPECT_TRUE(has(svg, ">second</text>"));
  EXPECT_EQ(values_plot(run.results[1]), "");
  EXPECT_TRUE(has(share_plot(run), "<title>one: error 0 of the tolerance</title>"));
}

// docs/validation.md is what the command writes: a row for each case, and no other rows.
TEST(ValidationGuide, ListsTheCasesOfTheProgram) {
  std::ifstream file(LIGHTWELL_DOCS "/validation.md");
  ASSERT_TRUE(file) << "docs/validation.md is missing; 'lightwell validate --markdown' writes it";
  std::stringstream all;
  all << file.rdbuf();
  const std::string page = all.str();
  const std::vector<ValidationCase> cases = validation_cases();
  for (const ValidationCase& one : cases) {
    EXPECT_TRUE(has(page, "\n## " + one.group + "\n")) << one.group;
    EXPECT_TRUE(has(page, "\n| `" + one.id + "` | ")) << one.id;
    EXPECT_TRUE(one.reason.empty() || has(page, "| " + one.reason + " |")) << one.id;
  }
  std::istringstream lines(page);
  std::size_t rows = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("## Figures of other programs", 0) == 0) break;
    if (line.rfind("| `", 0) == 0) ++rows;
  }
  EXPECT_EQ(rows, cases.size());
}

}  // namespace
}  // namespace lightwell::page_test
