#pragma once

#include "mesh/elements/element_caster.h"
#include "radiosity/direct_light/direct_light.h"
#include "scene/scene.h"

namespace lightwell {

/// A scene whose light is computed: its materials, the rays between its surfaces, and its emitters.
/// Holds references only; all three must outlive it and belong to one scene and mesh.
struct LitScene {
  const Scene& scene;
  const ElementCaster& caster;
  const DirectLight& direct_light;

  const PatchMesh& mesh() const { return caster.mesh(); }
};

}  // namespace lightwell
