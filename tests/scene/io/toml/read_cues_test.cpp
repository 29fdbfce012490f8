#include <gtest/gtest.h>

#include "scene/errors.h"
#include "scene/io/cue_file.h"
#include "tests/temporary_folder.h"

namespace lightwell::read_cues_test {
namespace {

class ReadCues : public testing::Test {
 protected:
  std::vector<WordedCue> read(const std::string& text) const {
    return read_cues(folder.write("cues.toml", text));
  }
  std::string refusal(const std::string& text) const {
    try {
      read(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing was refused";
  }
  TemporaryFolder folder;
};

TEST_F(ReadCues, LevelsAndTimesAreThoseOfTheFile) {
  const auto cues = read(R"([[cues]]
name = "preset"
others = "off"
hold = 4

[[cues]]
name = "day break"
fade = 3
fade_down = 5.5
wait = 1
[cues.channels]
"desk*" = 0.1
window = "0.8,#ffd9b0"
)");
  ASSERT_EQ(cues.size(), 2u);
  EXPECT_EQ(cues[0].name, "preset");
  EXPECT_TRUE(cues[0].levels.empty());
  ASSERT_TRUE(cues[0].others);
  EXPECT_EQ(cues[0].others->value, "off");
  EXPECT_EQ(cues[0].hold, 4.0);
  EXPECT_EQ(cues[0].fade_up, 0.0);
  EXPECT_EQ(cues[1].name, "day break");
  EXPECT_FALSE(cues[1].others);
  EXPECT_EQ(cues[1].fade_up, 3.0);
  EXPECT_EQ(cues[1].fade_down, 5.5);
  EXPECT_EQ(cues[1].wait, 1.0);
  ASSERT_EQ(cues[1].levels.size(), 2u);
  EXPECT_EQ(cues[1].levels[0].channels, "desk*");
  EXPECT_EQ(std::stod(cues[1].levels[0].value), 0.1);
  EXPECT_EQ(cues[1].levels[1].value, "0.8,#ffd9b0");
  const std::string place = cues[1].levels[0].place;
  EXPECT_TRUE(place.ends_with("cues.toml:12:11: level 'desk*' of cue 'day break'")) << place;
}

TEST_F(ReadCues, WithoutNamesAreNumbered) {
  const auto cues = read("[[cues]]\nothers = 1\n[[cues]]\nothers = 0\n");
  ASSERT_EQ(cues.size(), 2u);
  EXPECT_EQ(cues[0].name, "cue1");
  EXPECT_EQ(cues[1].name, "cue2");
}

struct Fault {
  const char* name;
  const char* text;
  const char* says;
};

TEST_F(ReadCues, FaultsAreNamedWithTheirPlace) {
  const Fault faults[] = {
      {"Empty", "", "there are no cues; add at least one [[cues]] table"},
      {"NoTables", "cues = []", "is empty; add at least one [[cues]] table"},
      {"OneTable", "[cues]\nname = 'a'", "must be an array of tables; write [[cues]]"},
      {"NoToml", "[[cues]\n", "cues.toml:1:"},
      {"EmptyName", "[[cues]]\nname = ''\nothers = 1",
       "cues.toml:2:8: name of cue 1 of cues is empty"},
      {"Slash", "[[cues]]\nname = '../a'\nothers = 1", "must not contain a slash"},
      {"Twice", "[[cues]]\nname = 'a'\nothers = 1\n[[cues]]\nname = 'a'\nothers = 0",
       "cues.toml:4:1: cue 'a' has a name that an earlier cue has"},
      {"NoLevel", "[[cues]]\nname = 'a'\nfade = 2", "cue 'a' changes nothing"},
      {"NegativeFade", "[[cues]]\nname = 'a'\nothers = 1\nfade = -2",
       "cues.toml:4:8: fade of cue 'a' is -2; it must lie between 0 and 86400"},
      {"NegativeDown", "[[cues]]\nname = 'a'\nothers = 1\nfade_down = -0.1", "fade_down of cue"},
      {"EndlessHold", "[[cues]]\nname = 'a'\nothers = 1\nhold = inf", "hold of cue 'a' is inf"},
      {"Unknown", "[[cues]]\nname = 'a'\nothers = 1\nfades = 2", "Did you mean 'fade'?"},
      {"NoTable", "[[cues]]\nname = 'a'\nchannels = 0.5", "channels of cue 'a' must be a table"},
      {"LevelOfFlags", "[[cues]]\nname = 'a'\nchannels = {b = true}",
       "level 'b' of cue 'a' must be a string, but is true or false"}};
  for (const Fault& fault : faults) {
    const std::string said = refusal(fault.text);
    EXPECT_NE(said.find(fault.says), std::string::npos) << fault.name << ": " << said;
  }
}

}  // namespace
}  // namespace lightwell::read_cues_test
