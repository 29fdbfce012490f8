// Targets of files that standards are held to: roads, road surfaces, sports, ratings,
// rooms, samples of colours.
#include "scene/io/room_use.h"
#include "standards/colour_fidelity.h"
#include "standards/daylight_rating.h"
#include "standards/road/road.h"
#include "standards/sports.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/target.h"

namespace lightwell::fuzz {

void read_road_file(std::string_view bytes) {
  read_road(input_file("road.toml", bytes));
}

void read_road_surface(std::string_view bytes) {
  read_r_table(input_file("surface.csv", bytes));
}

void read_sport_table(std::string_view bytes) {
  read_sports(input_file("sports.toml", bytes));
}

void read_rating_table(std::string_view bytes) {
  read_daylight_ratings(input_file("ratings.toml", bytes));
}

void read_room_table(std::string_view bytes) {
  read_room_uses(input_file("rooms.toml", bytes));
}

void read_colours(std::string_view bytes) {
  read_colour_samples(input_file("colours.csv", bytes));
}

}  // namespace lightwell::fuzz
