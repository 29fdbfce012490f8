#include "viewer/view.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "raytrace/image.h"
#include "viewer/live_solve.h"
#include "viewer/solution_view.h"
#include "viewer/walk_window.h"
#include "viewer/x_display.h"

namespace lightwell {

void show_window(const SolvedScene& solved, const ViewOptions& options) {
  const DisplayConnection display;
  WalkWindow(solved, options).run();
}

namespace {

void require_size(const ViewOptions& options) {
  constexpr int largest = 8192;
  for (const int side : {options.width, options.height}) {
    if (side < 1 || side > largest) {
      throw std::invalid_argument(
          fmt::format("a snapshot of {} x {} pixels is not possible; each side may have 1 to {}",
                      options.width, options.height, largest));
    }
  }
}

}  // namespace

void write_snapshot(const SolvedScene& solved, const ViewOptions& options,
                    const std::filesystem::path& png) {
  require_size(options);
  const DisplayConnection display;
  const SolutionView view(solved, options);
  write_png(png, options.width, options.height,
            draw_offscreen(view, options.width, options.height));
}

void show_live_window(const Scene& scene, const LiveViewOptions& live, const ViewOptions& options) {
  const DisplayConnection display;
  LiveSolve solve(scene, live.solve, live.provenance);
  WalkWindow window(solve, options);
  solve.start();
  window.run();
}

int write_live_snapshot(const Scene& scene, const LiveViewOptions& live, std::span<const int> shots,
                        const ViewOptions& options, const std::filesystem::path& png) {
  ViewOptions strip = options;
  strip.width = options.width * static_cast<int>(shots.size());
  require_size(options);
  require_size(strip);
  const DisplayConnection display;
  LiveSolve solve(scene, live.solve, live.provenance);
  std::vector<SolvedScene> stages;
  int shot = 0;
  for (const int wanted : shots) {
    solve.shoot(wanted);
    const LiveLight light = solve.light();
    shot = light.shots;
    RadiositySolution& shown = stages.emplace_back(solve.dark()).solution;
    shown.direct_irradiance = light.irradiance;
    if (!live.ambient) continue;
    shown.indirect_irradiance.rowwise() += light.ambient.max(0.0f).transpose();
  }
  const double exposure = SolutionView(stages.back(), options).look().metered_scale;
  std::vector<std::uint8_t> picture(std::size_t{3} * strip.width * strip.height);
  for (std::size_t k = 0; k < stages.size(); ++k) {
    SolutionView view(stages[k], options);
    Look look = view.look();
    look.metered_scale = exposure;
    view.set_look(look);
    const auto drawn = draw_offscreen(view, options.width, options.height);
    const std::size_t row = std::size_t{3} * options.width;
    for (int y = 0; y < options.height; ++y) {
      std::copy_n(drawn.begin() + static_cast<std::ptrdiff_t>(row * y), row,
                  picture.begin() + static_cast<std::ptrdiff_t>(row * (stages.size() * y + k)));
    }
  }
  write_png(png, strip.width, strip.height, picture);
  return shot;
}

}  // namespace lightwell
