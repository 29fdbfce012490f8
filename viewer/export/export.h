#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "raytrace/display/light_meter.h"
#include "viewer/export/baked_model.h"
#include "viewer/export/false_color.h"
#include "viewer/export/lightmap.h"

namespace lightwell {

// Each function writes a model under a temporary name and renames the file. Each throws
// std::runtime_error naming the file if writing fails.

/// Writes glTF 2.0, binary (.glb): metres, y upwards.
/// - A node and a mesh for each surface, a primitive for each part, cameras as nodes.
/// - COLOR_0 is linear and unlit (KHR_materials_unlit): radiance times
///   BakedModel::color_scale, clipped to [0,1]. `extras` of the asset give the radiosity and the
///   luminance of 1.
/// - _ILLUMINANCE holds illuminance in lx.
/// - Pictures are base colours (PNG in the file); COLOR_0 of parts with a picture is multiplied by
///   picture_gain.
void write_gltf(const std::filesystem::path& path, const BakedModel& model);

/// Lightmaps that were written.
struct LightmapReport {
  int atlases = 0, charts = 0;
  double texels_per_metre = 0.0;
  double coverage = 0.0;  ///< share of the texels that show a surface
  std::vector<std::filesystem::path> files{};
};

/// Data files of a model's first `count` lightmaps: room-lightmap-1.exr, ... beside room.glb.
std::vector<std::filesystem::path> lightmap_files(const std::filesystem::path& glb, int count);

/// Data files of one channel, numbered from 0, in the same lightmaps:
/// room-lightmap-1-desk_lamp.exr. Letters, digits and "-" of the channel's name are kept, other
/// characters become "_". Names that become equal get the channel's number, counted from 1.
std::vector<std::filesystem::path> channel_lightmap_files(const std::filesystem::path& glb,
                                                          const std::vector<std::string>& channels,
                                                          int channel, int count);

/// Writes glTF with the geometry of write_gltf and the light in textures.
/// - TEXCOORD_1 (and 0) of each vertex are coordinates in a lightmap. The lightmap's PNG in the
///   file is radiance times BakedModel::color_scale, clipped, as sRGB.
/// - Data is written beside the .glb as OpenEXR (see lightmap_files): irradiance in R, G and B,
///   radiosity and illuminance as layers. Values are half floats, or floats if a value exceeds the
///   range of half floats.
/// - With LightmapOptions::per_channel further files hold the light of each channel at scale 1.
///   Their sum, weighted by the effective scales, is the light of the other files.
/// Throws as lay_out_lightmap does, and InputError if per_channel is set for a solution without
/// channels; both before any file is written.
LightmapReport write_lightmapped_gltf(const std::filesystem::path& path, const BakedModel& model,
                                      const SolvedScene& solved, const Scene& scene,
                                      const LightmapOptions& options = {});

/// Writes Stanford PLY, binary: triangles in metres and the scene's axes.
/// - vertices: the first camera's tone-mapped sRGB bytes, `radiosity_<band>` and
///   `irradiance_<band>` (W/m^2), `illuminance` (lx)
/// - faces: numbers of `surface` and `material`, whose names are comments of the header
void write_ply(const std::filesystem::path& path, const BakedModel& model);

/// Writes Wavefront OBJ with an MTL of the same stem: triangles in metres and the scene's axes, an
/// object for each part. Tone-mapped sRGB colours follow the coordinates of `v`, an extension that
/// most programs read.
void write_obj(const std::filesystem::path& path, const BakedModel& model);

/// True if write_obj() wrote the MTL.
bool is_exported_library(const std::filesystem::path& mtl);

/// Writes a self-contained page for a web browser: the model, the program that draws the model
/// (viewer/export/web) and a library for WebGL 2. `lux_range` is the scale of the false colours;
/// default: lux_range() of the model's illuminance. `white`: light that shows as grey until the
/// page's own choice. docs/export.md describes the data.
void write_walkthrough(const std::filesystem::path& path, const BakedModel& model,
                       const std::optional<LuxRange>& lux_range = {}, const WhitePoint& white = {});

}  // namespace lightwell
