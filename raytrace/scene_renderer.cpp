#include "raytrace/scene_renderer.h"

#include <utility>
#include <vector>

#include "raytrace/caustics/caustic_map.h"
#include "raytrace/picture_records.h"
#include "raytrace/shading/indirect_slant.h"
#include "raytrace/shading/picture_base_gains.h"
#include "raytrace/shading/visible_lamps.h"
#include "raytrace/virtual_lights/virtual_lights.h"

namespace lightwell {

SceneRenderer::SceneRenderer(const Scene& scene, const PatchMesh& mesh,
                             const RadiositySolution& solution)
    : scene_(scene), solution_(solution), caster_(mesh), direct_light_(scene, caster_) {}

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

std::shared_ptr<const BandArray> SceneRenderer::slant(const RenderOptions& options) {
  if (options.pass == Pass::gather || options.pass == Pass::virtual_lights) return nullptr;
  const std::lock_guard lock(mutex_);
  if (!slant_ || slant_depth_ != options.max_depth) {
    slant_ = std::make_shared<const BandArray>(
        indirect_slant(scene_, caster_, direct_light_, solution_, options.max_depth));
    slant_depth_ = options.max_depth;
  }
  return slant_;
}

std::shared_ptr<const BandArray> SceneRenderer::base_gains(const RenderOptions& options) {
  if (options.pass == Pass::gather || options.pass == Pass::virtual_lights) return nullptr;
  const std::lock_guard lock(mutex_);
  if (!base_gains_) {
    base_gains_ = std::make_shared<const BandArray>(picture_base_gains(lit(), solution_));
  }
  return base_gains_;
}

std::shared_ptr<const VisibleLamps> SceneRenderer::visible_lamps() {
  const std::lock_guard lock(mutex_);
  if (!visible_lamps_) {
    visible_lamps_ =
        std::make_shared<const VisibleLamps>(scene_, caster_, direct_light_, solution_);
  }
  return visible_lamps_;
}

std::shared_ptr<const VirtualLights> SceneRenderer::virtual_lights(const RenderOptions& options) {
  if (options.pass != Pass::virtual_lights) return nullptr;
  const std::lock_guard lock(mutex_);
  if (!virtual_lights_ || virtual_count_ != options.virtual_lights ||
      virtual_depth_ != options.max_depth || virtual_caustics_ != options.caustics) {
    virtual_lights_ = std::make_shared<const VirtualLights>(
        lit(), VirtualLightOptions{.count = options.virtual_lights,
                                   .max_specular_depth = options.max_depth,
                                   .caustics = options.caustics,
                                   .progress = options.run.progress});
    virtual_count_ = options.virtual_lights;
    virtual_depth_ = options.max_depth;
    virtual_caustics_ = options.caustics;
  }
  return virtual_lights_;
}

Image SceneRenderer::render(const Camera& camera, RenderOptions options, RenderReport* report) {
  validate(options);
  options.caustics = caustics(options);
  options.slant = slant(options);
  options.base_gains = base_gains(options);
  options.visible_lamps = visible_lamps();
  options.found_virtual_lights = virtual_lights(options);
  return lightwell::render(scene_, caster_, direct_light_, solution_, camera, options, report);
}

std::shared_ptr<const IrradianceRecords> SceneRenderer::records(
    const Camera& camera, const RenderOptions& options) const {
  validate(options);
  return find_records(lit(), solution_, camera, CameraRays(camera), options);
}

std::optional<IncidentLight> SceneRenderer::incident_light(const Camera& camera) const {
  const PatchMesh& mesh = caster_.mesh();
  std::vector<char> clear(static_cast<std::size_t>(mesh.element_count()), 0);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto m = static_cast<std::size_t>(mesh.material[mesh.patch[e]]);
    const bool is_clear = m < scene_.materials.size() && scene_.materials[m].dielectric;
    clear[static_cast<std::size_t>(e)] = is_clear ? 1 : 0;
  }
  return meter_incident_light(caster_, solution_.irradiance(), clear, solution_.bands, camera);
}

}  // namespace lightwell
