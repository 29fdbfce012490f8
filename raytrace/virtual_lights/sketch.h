#pragma once

#include "radiosity/direct_light/lit_scene.h"
#include "radiosity/solution/solution.h"
#include "raytrace/virtual_lights/virtual_lights.h"
#include "scene/progress.h"
#include "scene/scene.h"

namespace lightwell {

/// Irradiance at the vertices of a mesh by virtual lights, as a solution without patch radiosities
/// and without an estimate of its error: a first look at a scene, as fine as the mesh. Caustics are
/// those of the virtual lights; 0 if there are none. Vertices of surfaces that neither reflect nor
/// transmit diffuse light stay dark. Vertices that face alike in a cell of a grid, `cell` m long,
/// share their indirect light (0: none do), whose noise neighbours even out. The same bits for any
/// number of threads. Throws Interrupted when progress says stop.
RadiositySolution sketch(const LitScene& lit, const VirtualLights& virtual_lights,
                         double cell = 0.0, const Progress& progress = {});

struct SketchOptions {
  int virtual_lights = 1024;    ///< about as many, at least 1
  int max_specular_depth = 10;  ///< most mirrors and clear surfaces on the way of light
  Progress progress{};
};

/// A first look at a scene within seconds, without a solve: sketch() on a mesh of a few hundred
/// patches, with caustics of a few photons where there are mirrors or glass. The provenance is
/// empty but for the scene's hash. Throws InputError as build_patches() does, and Interrupted when
/// progress says stop.
SolvedScene sketch_scene(const Scene& scene, const SketchOptions& options = {});

}  // namespace lightwell
