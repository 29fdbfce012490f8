#include "scene/io/room_use.h"
#include "scene/io/text_file.h"
#include "scene/io/toml/toml_document.h"
#include "scene/io/toml/toml_value.h"

namespace lightwell {
namespace {

LampControl read_control(const TomlValue& value) {
  const std::string word = value.one_of({"on/off", "stepped", "dimmed"});
  if (word == "on/off") return LampControl::on_off;
  return word == "stepped" ? LampControl::stepped : LampControl::dimmed;
}

RoomLighting read_lighting(const TomlValue& value) {
  const TomlTable table = value.table({"watts", "lux", "control", "steps", "standby", "zones"});
  constexpr int most_steps = 100;
  constexpr double most_standby = 0.99;
  RoomLighting lighting{.lux = table.require("lux").positive(),
                        .control = read_control(table.require("control"))};
  if (const auto watts = table.find("watts")) lighting.watts = watts->positive();
  if (const auto steps = table.find("steps")) {
    if (lighting.control != LampControl::stepped) {
      steps->fail("belongs to control = \"stepped\"; remove one of the two");
    }
    lighting.steps = static_cast<int>(steps->integer_within(1, most_steps));
  }
  if (const auto standby = table.find("standby")) {
    lighting.standby = standby->number_within(0.0, most_standby);
  }
  if (const auto zones = table.find("zones")) {
    lighting.is_one_zone = zones->one_of({"sensors", "room"}) == "room";
  }
  return lighting;
}

RoomUse read_use(const TomlValue& value) {
  const TomlTable table = value.table({"sensors", "regularly_occupied", "area", "lighting"});
  RoomUse use{.sensors = table.require("sensors").name(), .place = value.located("")};
  if (const auto occupied = table.find("regularly_occupied")) {
    use.is_regularly_occupied = occupied->boolean();
  }
  if (const auto area = table.find("area")) use.area = area->positive();
  if (const auto lighting = table.find("lighting")) use.lighting = read_lighting(*lighting);
  return use;
}

}  // namespace

std::vector<RoomUse> read_room_uses(const std::filesystem::path& path) {
  const TextFile file(path);
  const toml::table root = parse_toml(file);
  const TomlTable document = TomlValue(file.path(), root, "file of rooms").table({"rooms"});
  const TomlValue rooms = document.require("rooms");
  if (!rooms.is_array()) rooms.fail("must be an array of tables; write [[rooms]]");
  std::vector<RoomUse> uses;
  for (const TomlValue& value : rooms.elements("room")) uses.push_back(read_use(value));
  if (uses.empty()) rooms.fail("is empty; add at least one [[rooms]] table");
  return uses;
}

}  // namespace lightwell
