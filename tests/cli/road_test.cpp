// Files, exit codes and errors of 'lightwell road'.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/cli/program.h"

namespace lightwell::road_test {
namespace {

const std::filesystem::path examples = LIGHTWELL_TEST_DATA "/../../examples/road";

class RoadCommand : public CommandTest {
 protected:
  void SetUp() override {
    std::filesystem::copy(examples, folder / "", std::filesystem::copy_options::recursive);
  }
  // The example's road with one text in place of another.
  void change(const std::string& from, const std::string& to) {
    std::string text = content_of(examples / "street.toml");
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos);
    folder.write("street.toml", text.replace(at, from.size(), to));
  }
};

/// The page has what the figures have, and the search reports its greatest spacing.
TEST_F(RoadCommand, WritesThePageAndTheFigures) {
  const auto json = run_json({"road", "street.toml", "-o", "street.html", "-o", "street.json"});
  EXPECT_EQ(json["verdict"], "met");
  EXPECT_EQ(json["spacing"], 29.0);
  EXPECT_EQ(json["observers"].size(), 2u);
  EXPECT_EQ(nlohmann::json::parse(content_of(folder / "street.json"))["strips"], json["strips"]);
  const std::string page = content_of(folder / "street.html");
  for (const char* words : {"Mill Street", "carriageway: met", "right footway: met", "2, oncoming",
                            "Q0 0.070 per sr", "CIE 144:2001", "cd/m²"}) {
    EXPECT_TRUE(says(page, words));
  }
  const auto found = run_json({"road", "street.toml", "--max-spacing"});
  EXPECT_EQ(found["spacing"], found["spacings"].back()[1]);
  EXPECT_GE(found["spacing"], 29.0);
}

/// A missed class is a result, as in a report; a search that finds nothing falls short.
TEST_F(RoadCommand, SaysWhatIsMissed) {
  change("class = \"M4\"", "class = \"M1\"");
  const Ended missed = run({"road", "street.toml"});
  EXPECT_EQ(missed.code, 0) << missed.err;
  EXPECT_TRUE(says(missed.out, "carriageway: missed"));
  EXPECT_TRUE(says(missed.out, "missed: L_m 0.91 of lane 1, at least 2.00"));
  const Ended none = run({"road", "street.toml", "--max-spacing"});
  EXPECT_EQ(none.code, 4);
  EXPECT_TRUE(says(none.out, "no spacing meets all classes"));
}

TEST_F(RoadCommand, RefusesWrongInput) {
  change("lanes = 2", "lanes = 2.5");
  const Ended wrong = run({"road", "street.toml", "-o", "street.html"});
  EXPECT_EQ(wrong.code, 3);
  EXPECT_TRUE(says(wrong.err, "street.toml:6"));
  EXPECT_FALSE(std::filesystem::exists(folder / "street.html"));
  EXPECT_EQ(run({"road", "none.toml"}).code, 3);
  EXPECT_EQ(run({"road", "street.ies"}).code, 2);
  EXPECT_EQ(run({"road", "street.toml", "-o", "street.csv"}).code, 2);
}

}  // namespace
}  // namespace lightwell::road_test
