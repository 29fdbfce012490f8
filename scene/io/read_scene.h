#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace lightwell {

/// Reads a scene; the format is told by the extension: .toml (native, docs/scene-format.md), .obj,
/// .ply, .stl, .vs3, .xml (Mitsuba), .gltf, .glb, .rad and .rif (RADIANCE). The result has passed
/// validate(). Throws InputError naming file, line or object, value and remedy.
Scene read_scene(const std::filesystem::path& path);

/// The native format. See docs/scene-format.md for the grammar.
Scene read_toml(const std::filesystem::path& path);

/// Wavefront OBJ + MTL: Kd diffuse, Ks mirror (where illum asks for mirrors), Ni with d or Tf clear
/// glass, Ke emitted radiance in W/(sr m^2); one Surface per object/group and material. Polygons
/// stay polygons. Metres unless `metres_per_unit` says otherwise.
Scene read_obj(const std::filesystem::path& path, double metres_per_unit = 1.0);

/// Geometry only (PLY, STL), one white-ish diffuse material (reflectance 0.5, noted).
Scene read_geometry(const std::filesystem::path& path, double metres_per_unit = 1.0);

/// View3D's three-dimensional geometry, formats 3 and 3a: one Surface per S record, one-sided and
/// diffuse, reflectance 1 - emittance; parts taken up by subsurfaces are cut out of their base.
/// Obstructions are black from both sides. See docs/scene-format.md.
Scene read_vs3(const std::filesystem::path& path);

/// Mitsuba's XML, of 0.5 and 0.6 and of 2 and 3: shapes, BSDFs, area emitters and perspective
/// cameras. One metre per unit; radiance in no known unit (Scene::relative_units). What else the
/// file holds is named in the notes. See docs/scene-format.md.
Scene read_mitsuba(const std::filesystem::path& path);

/// glTF 2.0, text or binary: the default scene's triangles, materials, emission and perspective
/// cameras. Metres, y upwards; emission in no known unit (Scene::relative_units). What else the
/// file holds is named in the notes. See docs/scene-format.md.
Scene read_gltf(const std::filesystem::path& path);

/// RADIANCE: a scene file (.rad) or the variables for rad (.rif), which name scene files and views.
/// Commands in them (xform, genbox ...) are evaluated here and never given to a shell. One metre
/// per unit; radiance in W/(sr m^2) per band, 179 lm/W. What is approximated or left out is named
/// in the notes. See docs/radiance-scenes.md.
Scene read_radiance(const std::filesystem::path& path);

}  // namespace lightwell
