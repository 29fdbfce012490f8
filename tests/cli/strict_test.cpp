// --strict: what is left out of a scene, approximated or missing is an error.
#include <gtest/gtest.h>

#include <string>

#include "tests/cli/program.h"

namespace lightwell::strict_test {
namespace {

class Strict : public CommandTest {
 protected:
  Strict() {
    std::string shapes;
    for (int i = 0; i < 8; ++i) {
      shapes += "<shape type='obj'><string name='filename' value='gone" + std::to_string(i) +
                ".obj'/></shape>\n";
    }
    const std::string walls =
        "<shape type='cube'><transform name='to_world'><scale value='2'/></transform>"
        "<bsdf type='twosided'><bsdf type='diffuse'/></bsdf></shape>"
        "<shape type='rectangle'><emitter type='area'><rgb name='radiance' value='1'/></emitter>"
        "<bsdf type='diffuse'/></shape><sensor type='perspective'><float name='fov' value='40'/>"
        "</sensor>";
    folder.write("whole.xml", "<scene version='3.0.0'>" + walls + "</scene>");
    folder.write("part.xml", "<scene version='3.0.0'>" + walls + shapes + "</scene>");
  }
};

TEST_F(Strict, ListsEveryMissingPartOfAScene) {
  for (const std::vector<std::string>& command :
       std::vector<std::vector<std::string>>{{"info", "part.xml"},
                                             {"mesh", "part.xml"},
                                             {"form-factors", "part.xml", "-o", "f.mtx"},
                                             {"solve", "part.xml", "-o", "s.vtp"},
                                             {"run", "part.xml", "-o", "out"}}) {
    const int files = folder.file_count();
    const Ended ended = run(command + std::vector<std::string>{"--strict"});
    EXPECT_EQ(ended.code, 3) << command[0];
    EXPECT_TRUE(ended.out.empty());
    for (int i = 0; i < 8; ++i) EXPECT_TRUE(says(ended.err, "gone" + std::to_string(i) + ".obj"));
    EXPECT_EQ(folder.file_count(), files) << command[0];
  }
}

TEST_F(Strict, IsContentWithAWholeSceneAndTheRestIsReadWithout) {
  EXPECT_EQ(run({"info", "whole.xml", "--strict"}).code, 0);
  EXPECT_EQ(run({"info", "part.xml"}).code, 0);
  const Ended meshed = run({"mesh", "part.xml"});
  EXPECT_EQ(meshed.code, 0);
  EXPECT_TRUE(says(meshed.err, "'gone4.obj' and 3 more"));
}

TEST_F(Strict, IsNoOptionOfCommandsWithoutAScene) {
  EXPECT_EQ(run({"compare", "a.exr", "b.exr", "--strict"}).code, 2);
}

}  // namespace
}  // namespace lightwell::strict_test
