#include "validation/validate.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <set>

#include "tests/validation/made_up_cases.h"

namespace lightwell::validate_test {
namespace {

TEST(ValidationCases, HaveNamesSourcesAndReasons) {
  std::set<std::string> ids;
  for (const ValidationCase& one : validation_cases()) {
    EXPECT_TRUE(ids.insert(one.id).second) << one.id << " stands twice";
    EXPECT_FALSE(one.group.empty() || one.title.empty() || one.source.empty()) << one.id;
    // A case that cannot be run says why; everything else says where its tolerance comes from.
    EXPECT_FALSE((one.can_run() ? one.reason : one.note).empty()) << one.id;
  }
}

// All stored cases are there: 42 form factors, 23 enclosures, 17 of optics and shadows, 11 of
// photometry and glare, 15 of CIE 171.
TEST(ValidationCases, HoldEveryStoredCase) {
  std::map<std::string, int> count;
  for (const ValidationCase& one : validation_cases()) ++count[one.group];
  EXPECT_EQ(count["form factors"], 42);
  EXPECT_EQ(count["enclosures"], 23);
  EXPECT_EQ(count["optics"] + count["shadows"], 17);
  EXPECT_EQ(count["photometry"] + count["glare"], 11);
  EXPECT_EQ(count["CIE 171:2006"], 15);
  EXPECT_EQ(count["UGR tables"], 6);
  EXPECT_EQ(count["Cornell box"], 1);
  EXPECT_EQ(count["sky components"], 6);
}

class ValidationGroup : public testing::TestWithParam<const char*> {};

TEST_P(ValidationGroup, Passes) {
  const ValidationRun run = run_validation(select_cases(validation_cases(), GetParam()));
  std::printf("%s\n", verdict_line(run).c_str());
  for (const CaseResult& one : run.results) {
    if (!one.about.can_run()) continue;
    const ComparedValue* const worst = one.worst();
    ASSERT_NE(worst, nullptr) << one.about.id << ": " << one.failure;
    EXPECT_EQ(one.verdict, Verdict::passed)
        << one.about.id << " at " << worst->place << ": expected " << worst->expected
        << ", computed " << worst->computed << ", tolerance " << worst->tolerance;
  }
}
INSTANTIATE_TEST_SUITE_P(Groups, ValidationGroup,
                         testing::Values("form factors", "enclosures", "optics", "shadows",
                                         "photometry", "glare", "UGR tables", "sky components",
                                         "cie171-5.2", "cie171-5.3", "cie171-5.4", "cie171-5.5",
                                         "cie171-5.6", "cie171-5.7", "cie171-5.8", "cie171-5.9",
                                         "cie171-5.10", "cie171-5.11", "cie171-5.12", "cie171-5.13",
                                         "cie171-5.14", "Cornell box"));

TEST(ComparedValue, FailsIfItIsNoNumberOrOffAtAll) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE((ComparedValue{"", 1.0, nan, 1e9}.passes()));
  EXPECT_TRUE((ComparedValue{"", 0.0, 0.0, 0.0}.passes()));
  EXPECT_FALSE((ComparedValue{"", 0.0, 1e-300, 0.0}.passes()));
  EXPECT_EQ((ComparedValue{"", 2.0, 2.0, 0.0}.share()), 0.0);
  EXPECT_GT((ComparedValue{"", 0.0, 1e-300, 0.0}.share()), 1e300);
}

TEST(SelectCases, TakesNamesGroupsAndAsterisks) {
  const auto count = [](const char* pattern) {
    return select_cases(validation_cases(), pattern).size();
  };
  EXPECT_EQ(count(""), validation_cases().size());
  EXPECT_EQ(count("CIE 171"), 15u);
  EXPECT_EQ(count("CIE171*4X4"), 1u);
  EXPECT_EQ(count("cie171-5.10*1x1"), 1u);
  EXPECT_EQ(count("furnace"), 4u);
}

TEST(SelectCases, NamesTheNearestIfThereAreNone) {
  try {
    select_cases(validation_cases(), "furnance-rho0.5");
    FAIL() << "expected InputError";
  } catch (const InputError& error) {
    const std::string sentence = error.what();
    EXPECT_NE(sentence.find("'furnance-rho0.5'"), std::string::npos) << sentence;
    EXPECT_NE(sentence.find("furnace-rho0.5"), std::string::npos) << sentence;
  }
}

TEST(RunValidation, TellsFourKindsApart) {
  std::vector<std::string> done;
  const ValidationRun run =
      run_validation(test::made_up_cases(), {},
                     [&done](const CaseResult& result) { done.push_back(result.about.id); });
  EXPECT_EQ(done, (std::vector<std::string>{"right", "wrong", "broken", "missing"}));
  EXPECT_EQ(run.count(Verdict::passed), 1);
  EXPECT_EQ(run.count(Verdict::failed), 2);
  EXPECT_EQ(run.count(Verdict::not_run), 1);
  EXPECT_TRUE(run.has_failed());
  EXPECT_EQ(run.results[0].worst()->place, "b");
  EXPECT_EQ(run.results[2].failure, "the lamp is out");
  EXPECT_EQ(run.closest()->about.id, "wrong");
  const std::string line = verdict_line(run);
  EXPECT_EQ(line.rfind("1 of 3 cases pass in ", 0), 0u) << line;
  EXPECT_NE(line.find("3.00 of its tolerance (wrong)"), std::string::npos) << line;
}

TEST(RunValidation, KeepsWhatIsDoneWhenItIsStopped) {
  std::vector<ValidationCase> cases = test::made_up_cases();
  cases[1].compute = [](const Progress& progress) -> ComparedValues {
    report(progress, "work", 0.5);
    ADD_FAILURE() << "the case went on";
    return {};
  };
  int asked = 0;
  const ValidationRun run =
      run_validation(cases, [&asked](std::string_view, double) { return ++asked < 3; });
  EXPECT_EQ(run.results[0].verdict, Verdict::passed);
  EXPECT_EQ(run.results[1].verdict, Verdict::stopped);
  EXPECT_EQ(run.results[2].verdict, Verdict::stopped);
  EXPECT_NE(verdict_line(run).find("2 were not reached"), std::string::npos) << verdict_line(run);
}

TEST(RunValidation, CaseWithoutValuesFails) {
  const ValidationRun run = run_validation({test::made_up_case("empty", {})});
  EXPECT_EQ(run.count(Verdict::failed), 1);
}

}  // namespace
}  // namespace lightwell::validate_test
