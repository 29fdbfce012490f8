#include "radiosity/solve_words.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace lightwell::solve_words_test {
namespace {

TEST(ParseAccuracy, ReadsSharesAndLux) {
  EXPECT_EQ(parse_accuracy("1%").share, 0.01);
  EXPECT_EQ(parse_accuracy("0.5 %").share, 0.005);
  EXPECT_EQ(parse_accuracy("0.01").share, 0.01);
  EXPECT_EQ(parse_accuracy("5lx").lux, 5.0);
  EXPECT_EQ(parse_accuracy("5lx").share, 0.0);
}

TEST(ParseAccuracy, RefusesOtherTextWithASentence) {
  for (const char* const text : {"", "%", "lx", "-1%", "0%", "101%", "nan%", "inf", "1e999%", "0lx",
                                 "1%%", "5 lux", "1;2"}) {
    EXPECT_THROW(parse_accuracy(text), std::invalid_argument) << text;
  }
  // A quarter and more of the mean means per cent more probably.
  EXPECT_NO_THROW(parse_accuracy("0.24"));
  EXPECT_NO_THROW(parse_accuracy("25%"));
  try {
    parse_accuracy("1");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(std::string(error.what()), "'1' would be 100 %; write 1% or 100%");
  }
}

TEST(ChooseSolver, KnowsEveryName) {
  for (const std::string& name : solver_names()) {
    SolveOptions options;
    options.solver.tolerance = 1e-3;
    choose_solver(name, options);
    EXPECT_EQ(options.progressive.has_value(), name == "progressive");
    if (options.progressive) {
      EXPECT_EQ(options.progressive->tolerance, 1e-3);
    } else {
      EXPECT_EQ(options.solver_method, solver_method(name));
    }
  }
  SolveOptions options;
  EXPECT_THROW(choose_solver("gauss", options), std::invalid_argument);
}

}  // namespace
}  // namespace lightwell::solve_words_test
