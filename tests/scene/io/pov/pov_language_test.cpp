#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include "scene/errors.h"
#include "scene/io/pov/pov_language.h"
#include "tests/scene/expected_messages.h"
#include "tests/scene/scene_questions.h"
#include "tests/temporary_folder.h"

namespace lightwell::pov_language_test {
namespace {

class PovLanguageText : public testing::Test {
 protected:
  /// The numbers of all blocks "v { ... }" of a text, in order.
  std::vector<double> values(const std::string& text) {
    std::vector<double> all;
    PovLanguage language(remarks);
    language.read(folder.write("a.pov", text), [&](const PovNode& block) {
      for (const PovItem& item : block.items) {
        const PovVector* vector = item.vector();
        for (int i = 0; vector && i < vector->count; ++i) {
          all.push_back(vector->c[static_cast<std::size_t>(i)]);
        }
      }
    });
    return all;
  }
  double value(const std::string& expression) {
    const std::vector<double> all = values("#declare V = " + expression + ";\nv { V }");
    return all.size() == 1 ? all[0] : std::nan("");
  }
  std::string remark() const {
    std::string all;
    for (const std::string& sentence : remarks.sentences()) all += sentence + "\n";
    return all;
  }
  TemporaryFolder folder;
  Remarks remarks;
};

using Values = std::vector<double>;

// Whole numbers and halves are exact; other values are those of the same functions of C.
TEST_F(PovLanguageText, ExpressionsHaveTheirValues) {
  EXPECT_EQ(value("1 + 2*3 - 4/8"), 6.5);
  EXPECT_EQ(value("-(2 - 5)*2"), 6.0);
  EXPECT_EQ(value("3 > 2 & 2 != 2"), 0.0);
  EXPECT_EQ(value("(1 = 1 ? 7 : 9)"), 7.0);
  EXPECT_EQ(value("vlength(<3, 4, 0>) + vdot(x, <5, 1, 1>)"), 10.0);
  EXPECT_EQ(value("sqrt(2)"), std::sqrt(2.0));
  EXPECT_EQ(value("mod(7, 4) + div(9, 2) + int(2.9) + abs(-1)"), 10.0);
  EXPECT_EQ(value("min(3, 1, 2) + max(3, 1, 2)"), 4.0);
  EXPECT_EQ(value("select(-1, 5, 6, 7) + select(1, 5, 6)"), 11.0);
  EXPECT_EQ(value("<1, 2, 3>.y + (x*4).x"), 6.0);
  EXPECT_EQ(value("strlen(concat(\"ab\", str(1.5, 0, 1))) + asc(\"A\")"), 70.0);
  EXPECT_EQ(values("v { <1, 2, 3>*2 - 1 }"), (Values{1, 3, 5}));
  EXPECT_EQ(values("v { vcross(x, y) vrotate(x, z*90)*0 }"), (Values{0, 0, 1, 0, 0, 0}));
}

TEST_F(PovLanguageText, ColoursHaveFiveComponents) {
  EXPECT_EQ(values("v { color rgb <1, 0.5, 0> }"), (Values{1, 0.5, 0, 0, 0}));
  EXPECT_EQ(values("v { rgbt <1, 2, 3, 0.5> }"), (Values{1, 2, 3, 0, 0.5}));
  EXPECT_EQ(values("v { color red 0.5 blue 1 filter 0.25 }"), (Values{0.5, 0, 1, 0.25, 0}));
  EXPECT_EQ(values("#include \"colors.inc\"\nv { Red + Gray50*2 }"), (Values{2, 1, 1, 0, 0}));
  EXPECT_EQ(values("#declare C = rgb 1;\nv { color C*0.5 transmit 0.5 }"),
            (Values{0.5, 0.5, 0.5, 0, 0.5}));
}

TEST_F(PovLanguageText, DirectivesChooseAndRepeat) {
  EXPECT_EQ(values("#for (I, 1, 7, 3) v { I } #end"), (Values{1, 4, 7}));
  EXPECT_EQ(values("#declare N = 0;\n#while (N < 2) v { N } #declare N = N + 1; #end"),
            (Values{0, 1}));
  EXPECT_EQ(values("#if (0) v { 1 } #elseif (1) v { 2 } #else v { 3 } #end"), (Values{2}));
  EXPECT_EQ(values("#ifdef (Q) v { 1 } #else v { 2 } #end #ifndef (Q) v { 3 } #end"),
            (Values{2, 3}));
  EXPECT_EQ(
      values("#switch (4) #case (1) v { 1 } #break #range (3, 5) v { 2 } #break #else v { 3 } "
             "#end v { 9 }"),
      (Values{2, 9}));
  EXPECT_EQ(values("#for (I, 0, 9) #if (I > 1) #break #end v { I } #end v { 5 }"),
            (Values{0, 1, 5}));
  EXPECT_EQ(values("#for (I, 0, 1) #for (K, 0, 1) v { I*10 + K } #end #end"),
            (Values{0, 1, 10, 11}));
  EXPECT_EQ(values("v { 1 #if (1) 2 #else 3 #end }"), (Values{1, 2}));
}

TEST_F(PovLanguageText, MacrosFunctionsAndArraysAreEvaluated) {
  EXPECT_EQ(values("#macro Sum(A, B) (A + B) #end\nv { Sum(1, 2)*2 }"), (Values{6}));
  EXPECT_EQ(values("#macro Put(A) #local B = A*2; v { B } #end\nPut(3) Put(4)"), (Values{6, 8}));
  EXPECT_EQ(value("3"), 3.0);
  EXPECT_EQ(values("#declare F = function(a, b) { a*b + 1 }\nv { 2*F(3, 4) }"), (Values{26}));
  EXPECT_EQ(values("#declare A = array[2][2] {{1, 2}, {3, 4}}\n#declare A[0][1] = 7;\n"
                   "v { A[0][1] A[1][0] dimension_size(A, 2) }"),
            (Values{7, 3, 2}));
  const Values random = values("#declare S = seed(7);\nv { rand(S) rand(S) }");
  ASSERT_EQ(random.size(), 2u);
  for (const double r : random) EXPECT_TRUE(r >= 0.0 && r <= 1.0) << r;
  EXPECT_NE(random[0], random[1]);
  EXPECT_EQ(remark(), "");
}

TEST_F(PovLanguageText, CommentsAreNestedAndFilesIncluded) {
  folder.write("part.inc", "#declare P = 4; // a number\n");
  EXPECT_EQ(values("/* a /* b */ c */ #include \"part.inc\"\nv { P }"), (Values{4}));
}

// A statement that fails is left out with its place, and the next one is read.
TEST_F(PovLanguageText, StatementsThatFailAreLeftOut) {
  EXPECT_EQ(values("v { 1 }\nv { Nothing + 1*Nowhere }\nv { 1 } v { 2*Nobody { 3 } }\nv { 4 }"),
            (Values{1, 1, 4}));
  EXPECT_NE(remark().find("a.pov:2: "), std::string::npos) << remark();
  EXPECT_EQ(values("#declare A = 1 / 0;\nv { 2 }"), (Values{2}));
  EXPECT_EQ(values("#if (Unknown) v { 1 } #else v { 2 } #end"), (Values{2}));
  EXPECT_EQ(values("Unknown(3)\nv { 2 }"), (Values{2}));
}

TEST_F(PovLanguageText, EndlessAndDeepTextsAreRefused) {
  const auto refuse = [&](const std::string& text, const std::vector<std::string>& parts) {
    test::expect_message([&] { values(text); }, parts);
  };
  refuse("#while (1)\n#end", {"a.pov:2: ", "steps"});
  refuse("#macro A() v { 1 } A() #end\nA()", {"a.pov:1: ", "200 deep"});
  refuse("#macro A() v { A() } #end\nA()", {"a.pov:1: ", "200 deep"});
  refuse("#if (1)\nv { 1 }", {"a.pov:1: ", "#end"});
  refuse("v { v { 1 }", {"a.pov:1: ", "no end"});
  refuse("v { " + std::string(300, '('), {"nested more than"});
  refuse("#declare A = array[10000][1000];", {"more than"});
  refuse("v { \"text\nv", {"a.pov:1: ", "string"});
  refuse("v { 1 }\n/* text", {"a.pov:2: ", "comment"});
  refuse("v { 1 @ }", {"a.pov:1: ", "'@'"});
  refuse("#declare A = v { 1 }\n#for (I, 0, 100) #declare A = v { A }; #end", {"nested more than"});
  refuse("#declare S = \"0123456789abcdef\"; #for (I, 0, 100) #declare S = concat(S, S); #end",
         {"string has more than"});
}

}  // namespace
}  // namespace lightwell::pov_language_test
