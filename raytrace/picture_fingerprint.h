#pragma once

#include "radiosity/journal/fingerprint.h"
#include "radiosity/solution/solution.h"
#include "raytrace/pixel_samples.h"
#include "raytrace/shading/render_options.h"
#include "scene/camera.h"

namespace lightwell {

/// Adds all inputs of a picture except the scene, which identifies the journal, the motions, and
/// the names of layers.
void add_picture_inputs(Fingerprint& print, const ElementCaster& caster,
                        const RadiositySolution& solution, const Camera& camera,
                        const RenderOptions& options);

/// Adds motions and the shutter's interval.
void add_exposure(Fingerprint& print, const Scene& scene, const Exposure& exposure);

}  // namespace lightwell
