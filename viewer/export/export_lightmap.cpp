#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include "radiosity/solution/relight.h"
#include "raytrace/display/display.h"
#include "raytrace/pictures/encode_png.h"
#include "scene/errors.h"
#include "scene/parallel.h"
#include "viewer/export/export.h"
#include "viewer/export/gltf_parts.h"

namespace lightwell {
namespace {

const char* pass_name(Pass pass) {
  return pass == Pass::interpolate ? "interpolate" : pass == Pass::gather ? "gather" : "direct";
}

std::filesystem::path exr_name(const std::filesystem::path& glb, int atlas) {
  std::filesystem::path name = glb;
  return name.replace_filename(fmt::format("{}-lightmap-{}.exr", glb.stem().string(), atlas + 1));
}

/// Layers of a data file: radiosity, illuminance in lx and, where known, the bound of its error.
LayerColumns layers_of(const LightmapAtlas& atlas, const Bands& bands) {
  LayerColumns layers{.names = {"radiosity.R", "radiosity.G", "radiosity.B", "illuminance.Y"},
                      .values = BandArray(atlas.radiosity.rows(), 4)};
  layers.values.leftCols(3) = atlas.radiosity;
  for (Eigen::Index i = 0; i < layers.values.rows(); ++i) {
    layers.values(i, 3) = static_cast<float>(luminous(bands, atlas.irradiance.row(i).transpose()));
  }
  if (atlas.lux_within.size() == 0) return layers;
  layers.names.emplace_back("illuminance.within");
  layers.values.conservativeResize(Eigen::NoChange, 5);
  layers.values.col(4) = atlas.lux_within.col(0);
  return layers;
}

/// Writes an atlas's data as OpenEXR and moves the atlas's irradiance out. `channel`: name of the
/// channel of the light; empty: all channels at their effective scales.
void write_light(const std::filesystem::path& path, LightmapAtlas& atlas, const BakedModel& model,
                 const LightmapLayout& layout, const LightmapOptions& options,
                 const std::string& channel = {}) {
  constexpr float largest_half = 65504.0f;
  const bool is_half = atlas.irradiance.maxCoeff() <= largest_half &&
                       atlas.radiosity.abs().maxCoeff() <= largest_half;
  if (!channel.empty()) atlas.lux_within.resize(0, 0);  // the bound is that of all light
  Image image{.width = atlas.size, .height = atlas.size, .radiance = {}, .layers = {}};
  image.layers = layers_of(atlas, model.bands);
  image.radiance = std::move(atlas.irradiance);
  const Provenance& made = model.provenance;
  write_exr(path, image, model.bands,
            {{"software", fmt::format("lightwell {}", made.version)},
             {"scene", made.scene_file},
             {"sceneHash", fmt::format("{:016x}", made.scene_hash)},
             {"solveOptions", made.options},
             {"content",
              "R, G, B (and bands): irradiance; radiosity; illuminance and bound of its error"},
             {"unit", model.relative_units ? "relative" : "W/m^2; illuminance in lx"},
             {"channel", channel.empty() ? "all in force" : channel},
             {"lightmapPass", pass_name(options.pass)},
             {"texelsPerMetre", layout.texels_per_metre},
             {"padding", static_cast<double>(layout.padding)}},
            {.half = is_half, .compression = ExrCompression::zip});
}

/// Relights with `channel` at scale 1 and the others at 0; without a number all are at scale 1.
void switch_on(std::optional<std::size_t> channel, SolvedScene& solved) {
  const Bands& bands = solved.solution.bands;
  std::vector<Spectrum> scales(solved.solution.channels.size(),
                               constant_spectrum(bands, channel ? 0.0f : 1.0f));
  if (channel) scales[*channel] = constant_spectrum(bands, 1.0f);
  relight(solved, scales);
}

/// The model with all channels at scale 1: charts then are dark only where no channel gives light.
BakedModel with_all_on(const BakedModel& model, SolvedScene& solved) {
  switch_on({}, solved);
  BakedModel all = model;
  const BandArray E = solved.solution.irradiance();
  const BandArray B = vertex_radiosity(solved.mesh, solved.solution);
  for (std::size_t i = 0; i < model.mesh_vertex.size(); ++i) {
    all.irradiance.row(static_cast<Eigen::Index>(i)) = E.row(model.mesh_vertex[i]);
    all.radiosity.row(static_cast<Eigen::Index>(i)) = B.row(model.mesh_vertex[i]);
  }
  return all;
}

std::vector<std::string> lightmap_channel_names(const RadiositySolution& solution) {
  std::vector<std::string> names;
  for (const LightChannel& channel : solution.channels) names.push_back(channel.name);
  return names;
}

/// Radiance times exposure, clipped to [0,1], as 8-bit sRGB.
std::vector<std::uint8_t> shown_bytes(const LightmapAtlas& atlas, double exposure) {
  const auto scale = static_cast<float>(exposure);
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(atlas.radiance.size()));
  parallel_for(static_cast<int>(atlas.radiance.rows()), 1 << 14, [&](int begin, int end) {
    for (Eigen::Index i = begin; i < end; ++i) {
      for (Eigen::Index c = 0; c < 3; ++c) {
        bytes[static_cast<std::size_t>(3 * i + c)] =
            static_cast<std::uint8_t>(255.0f * srgb_encode(scale * atlas.radiance(i, c)) + 0.5f);
      }
    }
  });
  return bytes;
}

/// Number of covered texels that exceed 1 after exposure and are clipped.
std::int64_t clipped(const LightmapAtlas& atlas, double exposure) {
  std::int64_t count = 0;
  for (std::size_t i = 0; i < atlas.face.size(); ++i) {
    const auto row = atlas.radiance.row(static_cast<Eigen::Index>(i));
    if (atlas.face[i] >= 0 && (row * static_cast<float>(exposure) > 1.0f).any()) ++count;
  }
  return count;
}

/// Charts of one part in one atlas, drawn as one primitive.
struct Stretch {
  int part = 0, atlas = 0;
  std::vector<int> charts{};
  std::size_t first_vertex = 0, first_index = 0, index_count = 0;
  std::vector<int> vertices{};  ///< of the model, one for each vertex of the charts
};

std::vector<Stretch> stretches_of(const BakedModel& model, const LightmapLayout& layout) {
  std::map<std::pair<int, int>, std::vector<int>> charts;
  int part = 0;
  for (std::size_t c = 0; c < layout.charts.size(); ++c) {
    const int face = layout.charts[c].faces.front();
    while (face >= model.parts[part].first_face + model.parts[part].face_count) ++part;
    charts[{part, layout.place[c].atlas}].push_back(static_cast<int>(c));
  }
  std::vector<Stretch> stretches;
  for (auto& [key, of_stretch] : charts) {
    stretches.push_back(
        {.part = key.first, .atlas = key.second, .charts = std::move(of_stretch), .vertices = {}});
  }
  return stretches;
}

/// Buffer of geometry with lightmap coordinates, followed by the PNGs of the atlases.
class LightmapBuffer {
 public:
  LightmapBuffer(const BakedModel& model, const LightmapLayout& layout)
      : model_(model), layout_(layout), stretches_(stretches_of(model, layout)) {
    std::string texcoords;
    std::string indices;
    std::size_t vertex_count = 0;
    for (Stretch& s : stretches_) {
      s.first_vertex = vertex_count;
      s.first_index = indices.size() / 4;
      for (const int c : s.charts) append_chart(c, s, texcoords, indices);
      s.index_count = indices.size() / 4 - s.first_index;
      vertex_count += s.vertices.size();
    }
    std::string& bytes = buffer_.bytes();
    for (const Stretch& s : stretches_) {
      for (const int v : s.vertices) append_position(bytes, model, v);
    }
    positions_ = buffer_.end_view("positions", gltf_vertex_data, 12);
    bytes += texcoords;
    texcoords_ = buffer_.end_view("lightmap coordinates", gltf_vertex_data, 8);
    for (const Stretch& s : stretches_) {
      for (const int v : s.vertices) append_bytes(bytes, model.illuminance[v]);
    }
    illuminance_ = buffer_.end_view("illuminance", gltf_vertex_data, 4);
    bytes += indices;
    indices_ = buffer_.end_view("indices", gltf_index_data, 0);
  }

  const std::vector<Stretch>& stretches() const { return stretches_; }
  GltfBuffer& buffer() { return buffer_; }

  /// Adds an image and a texture for each atlas, with the atlas's number.
  void add_pictures(const std::vector<std::string>& pictures, GltfJson& root) {
    for (std::size_t i = 0; i < pictures.size(); ++i) {
      buffer_.bytes() += pictures[i];
      const std::string name = fmt::format("lightmap {}", i + 1);
      const int view = buffer_.end_view(name.c_str(), 0, 0);
      root["images"].push_back({{"name", name}, {"bufferView", view}, {"mimeType", "image/png"}});
      root["textures"].push_back({{"name", name}, {"sampler", 0}, {"source", i}});
    }
    // No mipmaps: at grazing angles coarse levels would mix a chart with its neighbours in the
    // atlas.
    constexpr int linear = 9729, clamp_to_edge = 33071;
    root["samplers"].push_back({{"magFilter", linear},
                                {"minFilter", linear},
                                {"wrapS", clamp_to_edge},
                                {"wrapT", clamp_to_edge}});
  }

  /// Primitive of a stretch. glTF requires sets of texture coordinates to be numbered from 0, so
  /// TEXCOORD_0 and TEXCOORD_1 are both the lightmap's.
  GltfJson primitive(const Stretch& s, int material) {
    const std::size_t first = s.first_vertex, count = s.vertices.size();
    GltfJson attributes = {
        {"POSITION", buffer_.add_positions(positions_, model_, s.vertices, first)}};
    const int texcoord = buffer_.add_accessor(texcoords_, gltf_float, "VEC2", 8, first, count);
    attributes["TEXCOORD_0"] = texcoord;
    attributes["TEXCOORD_1"] = texcoord;
    attributes["_ILLUMINANCE"] =
        buffer_.add_accessor(illuminance_, gltf_float, "SCALAR", 4, first, count);
    return {
        {"attributes", std::move(attributes)},
        {"indices", buffer_.add_accessor(indices_, gltf_unsigned_int, "SCALAR", 4, s.first_index,
                                         s.index_count)},
        {"material", material},
        {"extras",
         {{"side", model_.parts[s.part].is_back ? "back" : "front"}, {"lightmap", s.atlas + 1}}}};
  }

 private:
  void append_chart(int number, Stretch& s, std::string& texcoords, std::string& indices) const {
    const LightmapChart& chart = layout_.charts[number];
    const auto base = static_cast<std::uint32_t>(s.vertices.size());
    for (std::size_t v = 0; v < chart.vertices.size(); ++v) {
      const Eigen::Vector2d at = layout_.texel(number, chart.place[v]) / layout_.size;
      for (const double x : at) append_bytes(texcoords, static_cast<float>(x));
    }
    s.vertices.insert(s.vertices.end(), chart.vertices.begin(), chart.vertices.end());
    const auto triangle = [&](int a, int b, int c) {
      for (const int corner : {a, b, c}) {
        append_bytes(indices, base + static_cast<std::uint32_t>(corner));
      }
    };
    for (const auto& c : chart.corners) {
      triangle(c[0], c[1], c[2]);
      if (c[3] >= 0) triangle(c[0], c[2], c[3]);
    }
  }

  const BakedModel& model_;
  const LightmapLayout& layout_;
  std::vector<Stretch> stretches_;
  GltfBuffer buffer_;
  int positions_ = 0, texcoords_ = 0, illuminance_ = 0, indices_ = 0;
};

/// Adds a mesh for each surface, and a material for each pair of model material and atlas.
void add_surfaces(const BakedModel& model, LightmapBuffer& buffer, GltfJson& root) {
  GltfJson meshes = GltfJson::array();
  std::map<int, std::size_t> mesh_of;
  std::map<std::pair<int, int>, int> material_of;
  for (const Stretch& s : buffer.stretches()) {
    const BakedPart& part = model.parts[s.part];
    const auto [material, is_new] =
        material_of.try_emplace({part.material, s.atlas}, static_cast<int>(material_of.size()));
    if (is_new) {
      GltfJson entry = unlit_material(model.materials[part.material]);
      entry["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", s.atlas}, {"texCoord", 1}};
      root["materials"].push_back(std::move(entry));
    }
    const auto [mesh, is_new_mesh] = mesh_of.try_emplace(part.surface, meshes.size());
    if (is_new_mesh) meshes.push_back({{"name", part.name}, {"primitives", GltfJson::array()}});
    meshes[mesh->second]["primitives"].push_back(buffer.primitive(s, material->second));
  }
  add_lamps(model, buffer.buffer(), meshes, root);
  add_nodes(model, std::move(meshes), root);
}

}  // namespace

std::vector<std::filesystem::path> lightmap_files(const std::filesystem::path& glb, int count) {
  std::vector<std::filesystem::path> files;
  for (int i = 0; i < count; ++i) files.push_back(exr_name(glb, i));
  return files;
}

std::vector<std::filesystem::path> channel_lightmap_files(const std::filesystem::path& glb,
                                                          const std::vector<std::string>& channels,
                                                          int channel, int count) {
  const auto file_word = [](const std::string& name) {
    std::string word;
    for (const char c : name) {
      const bool is_plain =
          (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
      word += is_plain ? c : '_';
    }
    return word;
  };
  std::string word = file_word(channels[static_cast<std::size_t>(channel)]);
  const auto alike = std::ranges::count(channels, word, file_word);
  if (alike > 1) word += fmt::format("_{}", channel + 1);
  std::vector<std::filesystem::path> files;
  for (int i = 0; i < count; ++i) {
    std::filesystem::path file = exr_name(glb, i);
    files.push_back(file.replace_filename(fmt::format("{}-{}.exr", file.stem().string(), word)));
  }
  return files;
}

namespace {

/// Writes the data files of each channel and appends their names to `files`. Returns the entry
/// "channels" of `extras`.
GltfJson write_channels(const std::filesystem::path& path, const BakedModel& lit,
                        SolvedScene& switched, const Scene& scene, const LightmapLayout& layout,
                        const LightmapOptions& options, const std::vector<Spectrum>& scales,
                        std::vector<std::filesystem::path>& files) {
  const std::vector<std::string> names = lightmap_channel_names(switched.solution);
  GltfJson channels = GltfJson::array();
  for (std::size_t c = 0; c < names.size(); ++c) {
    switch_on(c, switched);
    GltfJson written = GltfJson::array();
    const auto of_channel =
        channel_lightmap_files(path, names, static_cast<int>(c), layout.atlas_count);
    for (int i = 0; i < layout.atlas_count; ++i) {
      report(options.run.progress, "lightmaps of channels",
             (static_cast<double>(c) + static_cast<double>(i) / layout.atlas_count) /
                 static_cast<double>(names.size()));
      LightmapAtlas atlas = paint_atlas(layout, i, lit, switched, scene, options);
      write_light(of_channel[i], atlas, lit, layout, options, names[c]);
      files.push_back(of_channel[i]);
      written.push_back(of_channel[i].filename().string());
    }
    const Spectrum& scale = scales[c];
    channels.push_back({{"name", names[c]},
                        {"files", std::move(written)},
                        {"scale", std::vector<float>(scale.begin(), scale.end())}});
  }
  return channels;
}

}  // namespace

LightmapReport write_lightmapped_gltf(const std::filesystem::path& path, const BakedModel& model,
                                      const SolvedScene& solved, const Scene& scene,
                                      const LightmapOptions& options) {
  if (options.per_channel && solved.solution.channels.empty()) {
    throw InputError(
        "the solution keeps no light channels apart, so there is no lightmap of each; solve with "
        "'--channels per-luminaire', or with channels of your own");
  }
  std::optional<SolvedScene> switched;
  std::optional<BakedModel> with_all;
  if (options.per_channel) with_all = with_all_on(model, switched.emplace(solved));
  const BakedModel& lit = with_all ? *with_all : model;
  const LightmapLayout layout = lay_out_lightmap(lit, solved.mesh, options);
  const double exposure = model.color_scale;
  LightmapReport result{.atlases = layout.atlas_count,
                        .charts = static_cast<int>(layout.charts.size()),
                        .texels_per_metre = layout.texels_per_metre,
                        .files = lightmap_files(path, layout.atlas_count)};
  std::vector<std::string> pictures;
  std::int64_t covered = 0, bright = 0;
  for (int i = 0; i < layout.atlas_count; ++i) {
    report(options.run.progress, "lightmap", static_cast<double>(i) / layout.atlas_count);
    LightmapAtlas atlas = paint_atlas(layout, i, lit, solved, scene, options);
    covered += atlas.covered;
    bright += clipped(atlas, exposure);
    pictures.push_back(encode_png(atlas.size, atlas.size, shown_bytes(atlas, exposure)));
    write_light(result.files[i], atlas, model, layout, options);
  }
  const double texels = static_cast<double>(layout.size) * layout.size * layout.atlas_count;
  result.coverage = static_cast<double>(covered) / texels;

  // The model is written after its data, so that every file named in a .glb exists.
  LightmapBuffer buffer(model, layout);
  GltfJson root;
  root["asset"] = gltf_asset(model);
  GltfJson names = GltfJson::array();
  for (const auto& file : result.files) names.push_back(file.filename().string());
  root["asset"]["extras"]["lightmap"] = {
      {"files", std::move(names)},       {"size", layout.size},
      {"padding", layout.padding},       {"texels_per_metre", layout.texels_per_metre},
      {"pass", pass_name(options.pass)}, {"clipped_texels", bright}};
  if (switched) {
    root["asset"]["extras"]["lightmap"]["channels"] =
        write_channels(path, lit, *switched, scene, layout, options,
                       effective_scales(solved.solution), result.files);
  }
  root["extensionsUsed"] = {"KHR_materials_unlit"};
  add_surfaces(model, buffer, root);
  buffer.add_pictures(pictures, root);
  write_glb(path, std::move(root), buffer.buffer());
  return result;
}

}  // namespace lightwell
