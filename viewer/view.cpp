#include "viewer/view.h"

#include <fmt/format.h>

#include <stdexcept>

#include "raytrace/image.h"
#include "viewer/solution_view.h"
#include "viewer/walk_window.h"
#include "viewer/x_display.h"

namespace lightwell {

void show_window(const SolvedScene& solved, const ViewOptions& options) {
  const DisplayConnection display;
  WalkWindow(solved, options).run();
}

void write_snapshot(const SolvedScene& solved, const ViewOptions& options,
                    const std::filesystem::path& png) {
  constexpr int largest = 8192;
  for (const int side : {options.width, options.height}) {
    if (side < 1 || side > largest) {
      throw std::invalid_argument(
          fmt::format("a snapshot of {} x {} pixels is not possible; each side may have 1 to {}",
                      options.width, options.height, largest));
    }
  }
  const DisplayConnection display;
  const SolutionView view(solved, options);
  write_png(png, options.width, options.height,
            draw_offscreen(view, options.width, options.height));
}

}  // namespace lightwell
