#include "radiosity/notable_portals.h"

#include <cstddef>
#include <limits>
#include <vector>

namespace lightwell {
namespace {

// Irradiance that errors on each element are relative to, W/m^2, the sum of bands; infinite where
// errors are not judged. `of_parts` is that of each part, the mean of bands.
std::vector<float> references_of_elements(const SolvedScene& patches,
                                          std::span<const double> of_parts) {
  const SceneParts& parts = patches.solution.parts;
  const auto bands = static_cast<double>(patches.mesh.reflectance.cols());
  std::vector<float> references;
  for (int e = 0; e < patches.mesh.element_count(); ++e) {
    const int patch = patches.mesh.patch[e];
    const double E = bands * of_parts[static_cast<std::size_t>(parts.judged_with(patch))];
    references.push_back(parts.is_judged(patch) ? static_cast<float>(E)
                                                : std::numeric_limits<float>::infinity());
  }
  return references;
}

}  // namespace

std::shared_ptr<const Portals> find_notable_portals(const GatherSources& sources,
                                                    const SolvedScene& patches,
                                                    std::span<const double> irradiances,
                                                    const RunControl& run) {
  const ElementCaster caster(patches.mesh);
  const std::vector<float> brightness =
      brightness_of_patches(patches.mesh, sources.all, patches.solution.patch_radiosity);
  return find_portals(
      caster, brightness,
      notable_openings(caster, brightness, references_of_elements(patches, irradiances),
                       sources.openings),
      run);
}

}  // namespace lightwell
