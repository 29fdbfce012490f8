#include "raytrace/scene_renderer.h"

#include <utility>

#include "raytrace/caustic_map.h"

namespace lightwell {

SceneRenderer::SceneRenderer(const Scene& scene, const PatchMesh& mesh,
                             const RadiositySolution& solution)
    : scene_(scene), solution_(solution), caster_(mesh), direct_light_(scene, mesh) {}

std::shared_ptr<const CausticMap> SceneRenderer::caustics(const RenderOptions& options) {
  if (!needs_caustic_photons(solution_, options)) return nullptr;
  const std::lock_guard lock(mutex_);
  if (!caustics_ || photons_ != options.photons || max_depth_ != options.max_depth) {
    caustics_ = trace_caustics(scene_, caster_, direct_light_, options.photons, options.max_depth,
                               options.run.progress);
    photons_ = options.photons;
    max_depth_ = options.max_depth;
  }
  return caustics_;
}

Image SceneRenderer::render(const Camera& camera, RenderOptions options, RenderReport* report) {
  validate(options);
  options.caustics = caustics(options);
  return lightwell::render(scene_, caster_, direct_light_, solution_, camera, options, report);
}

}  // namespace lightwell
