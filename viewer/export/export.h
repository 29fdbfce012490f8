#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "viewer/export/appearance.h"
#include "viewer/export/baked_model.h"
#include "viewer/export/lightmap.h"

namespace lightwell {

// Each writes a model under a temporary name and renames it; throws std::runtime_error naming the
// file if that fails.

/// glTF 2.0, binary (.glb): metres, y upwards. A node and a mesh for each surface, a primitive for
/// each lit side of it, cameras as nodes. Colours are COLOR_0, linear and unlit
/// (KHR_materials_unlit): radiance times the exposure of the first camera, clipped to [0,1].
/// `extras` of the asset says what 1 stands for; the attribute _ILLUMINANCE holds lx. Surfaces with
/// pictures have them as base colours (PNG in the file), under COLOR_0 that makes up for them.
void write_gltf(const std::filesystem::path& path, const BakedModel& model);

struct LightmapReport {
  int atlases = 0, charts = 0;
  double texels_per_metre = 0.0;
  double coverage = 0.0;  ///< share of the texels that show a surface
  std::vector<std::filesystem::path> files{};
};

/// The data files of a model's first `count` lightmaps: room-lightmap-1.exr, ... beside room.glb.
std::vector<std::filesystem::path> lightmap_files(const std::filesystem::path& glb, int count);

/// The data files of one channel, a number from 0, in the same lightmaps:
/// room-lightmap-1-desk_lamp.exr. Letters, digits and "-" of the name stay; names that come out
/// alike get the channel's number.
std::vector<std::filesystem::path> channel_lightmap_files(const std::filesystem::path& glb,
                                                          const std::vector<std::string>& channels,
                                                          int channel, int count);

/// The same geometry with its light in textures: TEXCOORD_1 (and 0) of each vertex leads into a
/// lightmap, whose PNG in the file is radiance times exposure, clipped, as sRGB. The numbers are
/// written beside it as OpenEXR (see lightmap_files): irradiance in R, G and B, radiosity and
/// illuminance as layers, in half floats unless something is brighter than they go. With
/// LightmapOptions::per_channel files of each channel follow, with its light as it was solved:
/// those times the scales in force add up to the others. What is thrown by lay_out_lightmap, and
/// InputError for a solution without channels, come before any file.
LightmapReport write_lightmapped_gltf(const std::filesystem::path& path, const BakedModel& model,
                                      const SolvedScene& solved, const Scene& scene,
                                      const LightmapOptions& options = {});

/// Stanford PLY, binary: triangles in metres and the scene's axes. Vertices have the first camera's
/// tone-mapped sRGB bytes, `radiosity_<band>` and `irradiance_<band>` (W/m^2) and `illuminance`
/// (lx); faces have `surface` and `material`, whose names are comments of the header.
void write_ply(const std::filesystem::path& path, const BakedModel& model);

/// Wavefront OBJ with an MTL of the same stem beside it: triangles in metres and the scene's axes,
/// an object for each surface, tone-mapped sRGB colours after the coordinates of `v` (an extension
/// that most programs read).
void write_obj(const std::filesystem::path& path, const BakedModel& model);

/// A page for a web browser that holds all it needs: the model, the program that shows it
/// (viewer/export/web) and a library for WebGL 2. `lux_range` is that of the false colours; without
/// one they have what suits the solution. See docs/export.md for the data in it.
void write_walkthrough(const std::filesystem::path& path, const BakedModel& model,
                       const std::optional<LuxRange>& lux_range = {});

}  // namespace lightwell
