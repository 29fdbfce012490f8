#include <gtest/gtest.h>

#include <string>

#include "scene/errors.h"
#include "scene/io/room_use.h"
#include "tests/temporary_folder.h"

namespace lightwell::read_rooms_test {
namespace {

class ReadRooms : public testing::Test {
 protected:
  std::vector<RoomUse> read(const std::string& text) const {
    return read_room_uses(folder.write("rooms.toml", text));
  }
  void expect_refused(const std::string& text, const std::string& sentence) const {
    EXPECT_TRUE(says(message_of<InputError>([&] { read(text); }), sentence)) << text;
  }
  TemporaryFolder folder{};
};

}  // namespace

TEST_F(ReadRooms, HaveUseAndLighting) {
  const auto uses = read(
      "[[rooms]]\nsensors = \"desk*\"\narea = 24\n"
      "lighting = { watts = 180, lux = 500, control = \"stepped\", steps = 3, standby = 0.05, "
      "zones = \"room\" }\n"
      "[[rooms]]\nsensors = \"store\"\nregularly_occupied = false\n");
  ASSERT_EQ(uses.size(), 2u);
  EXPECT_EQ(uses[0].area, 24.0);
  EXPECT_TRUE(uses[0].is_regularly_occupied);
  ASSERT_TRUE(uses[0].lighting.has_value());
  const RoomLighting& lighting = *uses[0].lighting;
  EXPECT_EQ(lighting.watts, 180.0);
  EXPECT_EQ(lighting.control, LampControl::stepped);
  EXPECT_EQ(lighting.steps, 3);
  EXPECT_EQ(lighting.standby, 0.05);
  EXPECT_TRUE(lighting.is_one_zone);
  EXPECT_FALSE(uses[1].is_regularly_occupied);
  EXPECT_FALSE(uses[1].lighting.has_value());
}

TEST_F(ReadRooms, AreRefusedWithASentence) {
  const std::string room = "[[rooms]]\nsensors = \"desk\"\n";
  expect_refused(room + "lighting = { lux = 500, control = \"dimed\" }\n",
                 "'on/off', 'stepped' or 'dimmed'");
  expect_refused(room + "lighting = { watts = -1, lux = 500, control = \"dimmed\" }\n",
                 "rooms.toml:3");
  expect_refused(room + "lighting = { lux = 500 }\n", "control");
  expect_refused(room + "lighting = { lux = 500, control = \"dimmed\", steps = 2 }\n",
                 "belongs to control = \"stepped\"");
  expect_refused(room + "lighting = { lux = 500, control = \"dimmed\", standby = 1 }\n",
                 "rooms.toml:3");
  expect_refused(room + "area = 0\n", "rooms.toml:3");
  expect_refused("[[rooms]]\narea = 3\n", "sensors");
  expect_refused("rooms = []\n", "at least one [[rooms]]");
  expect_refused("rooms = 3\n", "[[rooms]]");
}

}  // namespace lightwell::read_rooms_test
