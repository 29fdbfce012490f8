#pragma once

#include <memory>
#include <mutex>
#include <optional>

#include "mesh/elements/element_caster.h"
#include "radiosity/direct_light/direct_light.h"
#include "radiosity/direct_light/lit_scene.h"
#include "radiosity/solution/solution.h"
#include "raytrace/display/light_meter.h"
#include "raytrace/render.h"

namespace lightwell {

/// Renderer of several pictures of one solution. The caster, the data on lamps and sky, the
/// photons of caustics, which take a second or two, the slant of indirect light on relief, the
/// gains of coated bases and the luminaires are shared by all pictures. Each picture has the same
/// bits as by render() alone. Keeps references to scene, mesh and solution.
class SceneRenderer {
 public:
  SceneRenderer(const Scene& scene, const PatchMesh& mesh, const RadiositySolution& solution);

  /// Renders a picture as render() does, with RenderOptions::caustics, slant, base_gains and
  /// visible_lamps set here. May be called by any number of threads at once, of which one finds
  /// them while the others wait.
  Image render(const Camera& camera, RenderOptions options = {}, RenderReport* report = nullptr);
  /// Finds the records that render() would find for the same camera and options, for pictures that
  /// are to share them as RenderOptions::records.
  std::shared_ptr<const IrradianceRecords> records(const Camera& camera,
                                                   const RenderOptions& options) const;
  /// The light that falls on what a camera sees, as meter_incident_light() returns it.
  std::optional<IncidentLight> incident_light(const Camera& camera) const;

 private:
  std::shared_ptr<const CausticMap> caustics(const RenderOptions& options);
  std::shared_ptr<const BandArray> slant(const RenderOptions& options);
  std::shared_ptr<const BandArray> base_gains(const RenderOptions& options);
  std::shared_ptr<const VisibleLamps> visible_lamps();
  std::shared_ptr<const VirtualLights> virtual_lights(const RenderOptions& options);

  LitScene lit() const { return {scene_, caster_, direct_light_}; }

  const Scene& scene_;
  const RadiositySolution& solution_;
  ElementCaster caster_;
  DirectLight direct_light_;
  std::mutex mutex_{};  // guards the members below
  int photons_ = 0, max_depth_ = 0;
  std::shared_ptr<const CausticMap> caustics_{};  // map of photons_ photons, followed to max_depth_
  int slant_depth_ = 0;
  std::shared_ptr<const BandArray> slant_{};  // for paths of slant_depth_
  std::shared_ptr<const BandArray> base_gains_{};
  std::shared_ptr<const VisibleLamps> visible_lamps_{};
  int virtual_count_ = 0, virtual_depth_ = 0;  // that virtual_lights_ are for
  std::shared_ptr<const CausticMap> virtual_caustics_{};
  std::shared_ptr<const VirtualLights> virtual_lights_{};
};

}  // namespace lightwell
