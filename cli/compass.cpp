#include "cli/compass.h"

namespace lightwell {

void add_north(CLI::App& command, double& north_degrees) {
  command
      .add_option("--north", north_degrees,
                  "turns north clockwise, seen from above, from that of the scene's sky (without a "
                  "sky: +y, or -z where y is up)")
      ->type_name("DEGREES")
      ->check(CLI::Range(-360.0, 360.0).description(""));
}

}  // namespace lightwell
