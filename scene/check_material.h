#pragma once

#include <string>

#include "scene/scene.h"

namespace lightwell {

/// Throws InputError with the sentence `what`, and with the scene's file if there is one.
[[noreturn]] void refuse_scene(const Scene& scene, const std::string& what);

/// Refuses light, in `unit`, that is no number, below 0, or beyond what floats can add up. `of`
/// names the material or lamp, `what` the quantity. Throws InputError.
void check_light(const Scene& scene, const std::string& of, const char* what, const char* unit,
                 const Spectrum& values);

/// Checks a material: shares between 0 and 1 that add up to at most 1, roughness, index of
/// refraction, coat, metal, pictures. Throws InputError naming the material and the remedy.
void check_material(const Scene& scene, const Material& material);

}  // namespace lightwell
