#include "raytrace/shading/render_options.h"

#include <fmt/format.h>

#include <stdexcept>
#include <string>

#include "radiosity/paths/caustic_photons.h"

namespace lightwell {

void validate(const RenderOptions& options) {
  const auto fail = [](const std::string& what) { throw std::invalid_argument("render: " + what); };
  const auto within = [&](const char* what, int value, int low, int high) {
    if (value >= low && value <= high) return;
    fail(fmt::format("{} is {}, it must lie between {} and {}", what, value, low, high));
  };
  within("max_subdivision", options.max_subdivision, 0, deepest_subdivision);
  within("max_depth", options.max_depth, 0, deepest_tree);
  within("gather_rays", options.gather_rays, 1, most_gather_rays);
  within("virtual_lights", options.virtual_lights, 1, most_virtual_lights);
  within("photons", options.photons, 0, most_photons);
  within("glossy_rays", options.glossy_rays, 1, 256);
  within("sampling.most", options.sampling.most, 0, SampleOptions::limit);
  within("sampling.least", options.sampling.least, 1, SampleOptions::limit);
  if (!(options.sampling.noise >= 0.0f)) fail("sampling.noise must not be negative");
  if (!(options.contrast > 0.0f)) fail("contrast must be above 0");
  if (!(options.min_contribution >= 0.0f)) fail("min_contribution must not be negative");
}

bool needs_caustic_photons(const RadiositySolution& solution, const RenderOptions& options) {
  return options.pass != Pass::interpolate && options.photons > 0 &&
         solution.caustic_irradiance.size() > 0;
}

}  // namespace lightwell
