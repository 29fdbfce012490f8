#include "cli/compass.h"

#include "cli/numbers.h"

namespace lightwell {

void add_north(CLI::App& command, double& north_degrees) {
  constexpr double full_turn = 360.0;
  command
      .add_option("--north", north_degrees,
                  "turns north clockwise, seen from above, from that of the scene's sky (without a "
                  "sky: +y, or -z where y is up)")
      ->type_name("DEGREES")
      ->check(number_within(-full_turn, full_turn, "an angle in degrees"));
}

}  // namespace lightwell
