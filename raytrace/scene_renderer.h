#pragma once

#include <memory>
#include <mutex>

#include "mesh/elements/element_caster.h"
#include "radiosity/emitters/direct_light.h"
#include "radiosity/solution/solution.h"
#include "raytrace/render.h"

namespace lightwell {

/// Renders pictures of one solution. What all of them share is made once: the caster of rays, what
/// is known of lamps and sky, and the photons of caustics, which take a second or two. Each picture
/// has the same bits as by render() alone. Keeps references to what it is made of.
class SceneRenderer {
 public:
  SceneRenderer(const Scene& scene, const PatchMesh& mesh, const RadiositySolution& solution);

  /// As render(); RenderOptions::caustics is found here. By any number of threads at once, of which
  /// one traces the photons while the others wait.
  Image render(const Camera& camera, RenderOptions options = {}, RenderReport* report = nullptr);

 private:
  std::shared_ptr<const CausticMap> caustics(const RenderOptions& options);

  const Scene& scene_;
  const RadiositySolution& solution_;
  ElementCaster caster_;
  DirectLight direct_light_;
  std::mutex mutex_{};  // of those below
  int photons_ = 0, max_depth_ = 0;
  std::shared_ptr<const CausticMap> caustics_{};  // by so many photons, followed so far
};

}  // namespace lightwell
