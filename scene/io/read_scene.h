#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace lightwell {

/// Files that a scene may refer to: any, or those in the folder of the scene file alone.
enum class References { anywhere, inside_folder };

/// Reads a scene whose format follows from the extension: .toml (native, docs/scene-format.md),
/// .obj, .ply, .stl, .vs3, .xml (Mitsuba), .gltf, .glb, .dae (COLLADA), .fbx, .mgf, .pov and
/// .inc (POV-Ray), .rad and .rif (RADIANCE), .hbjson (Honeybee), .stf (DIALux). The result has
/// passed validate(). Throws InputError naming file, line or object, value and remedy; LimitError
/// for a reference that `references` forbids.
Scene read_scene(const std::filesystem::path& path, References references = References::anywhere);

/// Reads the native format (grammar: docs/scene-format.md).
Scene read_toml(const std::filesystem::path& path);

/// Reads Wavefront OBJ + MTL, one Surface per object/group and material. Kd is diffuse reflectance,
/// Ks mirror reflectance (where illum selects a mirror), Ni with d or Tf clear glass, Ke emitted
/// radiance in W/(sr m^2). Polygons stay polygons. Coordinates are scaled by `metres_per_unit`.
Scene read_obj(const std::filesystem::path& path, double metres_per_unit = 1.0);

/// Reads geometry without materials (PLY, STL): one diffuse material of reflectance 0.5, with a
/// note.
Scene read_geometry(const std::filesystem::path& path, double metres_per_unit = 1.0);

/// Reads View3D's three-dimensional geometry, formats 3 and 3a: one Surface per S record, one-sided
/// and diffuse, reflectance 1 - emittance. Subsurfaces are cut out of their base surface.
/// Obstructions are black on both sides. See docs/scene-format.md.
Scene read_vs3(const std::filesystem::path& path);

/// Reads the XML of Mitsuba 0.5, 0.6, 2 and 3: shapes, BSDFs, emitters and perspective cameras. One
/// unit is a metre; radiance has no known unit (Scene::relative_units). Unread contents are named
/// in the notes. See docs/scene-format.md.
Scene read_mitsuba(const std::filesystem::path& path);

/// Reads glTF 2.0, text or binary: the default scene's triangles, materials, emission, lights and
/// perspective cameras. Metres, y upwards; emission has no known unit (Scene::relative_units).
/// Unread contents are named in the notes. See docs/scene-format.md.
Scene read_gltf(const std::filesystem::path& path);

/// Reads COLLADA 1.4 and 1.5 or FBX 7: polygons of all nodes, materials, lights and cameras. Metres
/// by the file's unit; the file's axis stays upright. Emission has no known unit
/// (Scene::relative_units). Unread contents are named in the notes. See docs/scene-format.md.
Scene read_interchange(const std::filesystem::path& path);

/// Reads the Materials and Geometry Format (Ward 1995). One unit is a metre; exitance is in lm/m^2,
/// 683 lm/W. See docs/scene-format.md.
Scene read_mgf(const std::filesystem::path& path);

/// Reads POV-Ray's scene text: shapes, textures, lights and cameras, with the directives and macros
/// of the language. One unit is a metre; z is turned around, since the text's axes are left-handed.
/// Light has no known unit (Scene::relative_units). Unread contents are named in the notes. See
/// docs/from-pov.md.
Scene read_pov(const std::filesystem::path& path);

/// Reads RADIANCE: a scene file (.rad) or the variables for rad (.rif), which name scene files and
/// views. Commands in the files (xform, genbox ...) are evaluated by this reader, never by a shell.
/// One unit is a metre; radiance is in W/(sr m^2) per band, 179 lm/W. Approximations and omissions
/// are named in the notes. See docs/radiance-scenes.md.
Scene read_radiance(const std::filesystem::path& path);

/// Reads a model of Honeybee (JSON): rooms, faces, openings, shades, RADIANCE modifiers and views.
/// Openings are cut out of their faces. Radiance is in W/(sr m^2) per band, 179 lm/W.
/// Approximations and omissions are named in the notes. See docs/from-honeybee.md.
Scene read_honeybee(const std::filesystem::path& path);

/// Reads DIALux's exchange format STF: rooms as they are placed, their openings, furniture and
/// luminaires. Metres, lumens, 683 lm/W. The photometric file of a luminaire is the one beside the
/// scene that is named like its order number, name or section; without a file the luminaire is an
/// even opening. Approximations and omissions are named in the notes. See docs/scene-format.md.
Scene read_stf(const std::filesystem::path& path);

}  // namespace lightwell
