#include "viewer/window/preview.h"

#include <exception>
#include <string_view>
#include <utility>

#include "raytrace/virtual_lights/sketch.h"

namespace lightwell {
Preview::Preview(const Scene& scene, const Provenance& provenance, const Progress& watch)
    : thread_([this, &scene, provenance, watch] {
        try {
          made_ = sketch_scene(scene, {.progress = [&](std::string_view phase, double share) {
                                 if (watch) watch(phase, share);
                                 return !cancelled_;
                               }});
          made_.solution.provenance = provenance;
          ready_ = true;
        } catch (const std::exception&) {
          // Cancelled, or a failure that the solve meets and reports.
        }
      }) {}

Preview::~Preview() {
  cancel();
  thread_.join();
}

std::optional<SolvedScene> Preview::take() {
  if (!is_ready()) return std::nullopt;
  ready_ = false;
  return std::move(made_);
}

bool surpasses_sketch(const LiveState& state) {
  // In the Cornell box the sketch and the shots with their ambient term differ from the solution by
  // 6 % of the mean alike when this share is unshot.
  constexpr double as_good = 0.1;
  return !state.lacks_specular && state.unshot_share < as_good;
}

}  // namespace lightwell
