#include "viewer/export/baked_channels.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "scene/errors.h"
#include "viewer/export/appearance.h"
#include "viewer/export/sky_grid.h"

namespace lightwell {
namespace {

/// Solution without light or channels on the same mesh.
SolvedScene unlit(const SolvedScene& solved) {
  SolvedScene result;
  result.mesh = solved.mesh;
  result.solution.bands = solved.solution.bands;
  return result;
}

/// Copies the light of one channel, with all scales 1, into `alone`, which has the same mesh.
void light_alone(const RadiositySolution& solution, std::size_t number, SolvedScene& alone) {
  const LightChannel& channel = solution.channels[number];
  alone.solution.direct_irradiance = channel.direct_irradiance;
  alone.solution.indirect_irradiance = channel.indirect_irradiance;
  BandArray& M = alone.mesh.emission;
  M = solution.full_emission;
  for (Eigen::Index i = 0; i < M.rows(); ++i) {
    const int owner = solution.patch_channel[static_cast<std::size_t>(i)];
    if (owner != static_cast<int>(number)) M.row(i).setZero();
  }
}

/// A channel's scale as a product of an RGB weight and a factor per band of the light. For RGB
/// bands the weight is the scale. A spectral scale has more bands than three: its largest band is
/// the weight, and the factor is scale / weight.
struct Split {
  Eigen::Array3f weight{};
  Spectrum within{};
};

Split split_channels(const Bands& bands, const Spectrum& scale) {
  if (bands.wavelengths_nm.empty()) return {scale.head<3>(), constant_spectrum(bands, 1.0f)};
  const float largest = scale.maxCoeff();
  if (!(largest > 0.0f)) return {Eigen::Array3f::Zero(), constant_spectrum(bands, 1.0f)};
  return {Eigen::Array3f::Constant(largest), scale / largest};
}

/// The terms of luminous() for red, green and blue; for spectral bands one number, their sum.
Spectrum luminous_columns(const Bands& bands, const Spectrum& values) {
  if (!bands.wavelengths_nm.empty()) {
    return Spectrum::Constant(1, static_cast<float>(luminous(bands, values)));
  }
  return static_cast<float>(bands.lumens_per_watt) * bands.xyz.row(1).transpose() * values;
}

BakedChannel bake(const SolvedScene& alone, const LightChannel& channel,
                  const std::vector<Material>& materials, const std::vector<int>& mesh_vertex) {
  const Bands& bands = alone.solution.bands;
  const auto [weight, within] = split_channels(bands, channel.scale);
  const Spectrum flux = channel.energy.row(0).transpose().cast<float>() * within;
  BakedChannel baked{.name = channel.name,
                     .radiance = {},
                     .illuminance = {},
                     .lumens = luminous_columns(bands, flux),
                     .weight = weight};
  const BandArray E = alone.solution.irradiance();
  const BandArray radiance = shown_radiance(alone, materials);
  const auto count = static_cast<Eigen::Index>(mesh_vertex.size());
  baked.radiance.resize(count, 3);
  BandArray arriving(count, bands.count());
  for (Eigen::Index i = 0; i < count; ++i) {
    const int v = mesh_vertex[static_cast<std::size_t>(i)];
    const Spectrum L = radiance.row(v).transpose() * within;
    baked.radiance.row(i) = linear_rgb(bands, L).unaryExpr(&finite_or_black).transpose();
    arriving.row(i) = E.row(v) * within.transpose();
  }
  baked.illuminance = illuminance_shares(arriving, bands);
  return baked;
}

/// Azimuths of a baked sky, in steps of 1.4 degrees; of a sky map 0.7 degrees.
constexpr int sky_columns = 257, map_columns = 513;

/// Channel of a free source; -1 in a solution without channels.
int channel_of(const RadiositySolution& solution, std::size_t source) {
  return source < solution.source_channel.size() ? solution.source_channel[source] : -1;
}

/// Factor per band of a channel's light before conversion to RGB; see Split.
Spectrum factor_within(const RadiositySolution& solution, int channel) {
  if (channel < 0) return constant_spectrum(solution.bands, 1.0f);
  return split_channels(solution.bands, solution.channels[static_cast<std::size_t>(channel)].scale)
      .within;
}

}  // namespace

Bands shown_bands(const Bands& bands) {
  return bands.wavelengths_nm.empty() ? bands : rgb_bands(bands.lumens_per_watt);
}

RgbArray illuminance_shares(const BandArray& irradiance, const Bands& bands) {
  const Bands primaries = shown_bands(bands);
  RgbArray shares(irradiance.rows(), 3);
  for (Eigen::Index i = 0; i < irradiance.rows(); ++i) {
    const Spectrum rgb = linear_rgb(bands, irradiance.row(i).transpose());
    shares.row(i) = luminous_columns(primaries, rgb).unaryExpr(&finite_or_black).transpose();
  }
  return shares;
}

std::optional<BakedSky> bake_sky(const SolvedScene& solved, const Scene& scene) {
  if (!scene.sky) return {};
  const RadiositySolution& s = solved.solution;
  const Sky& sky = *scene.sky;
  auto source = scene.lamps.size();
  BakedSky baked;
  baked.channel = has_dome(sky) ? channel_of(s, source++) : -1;
  baked.axes.col(0) = sky.north;
  baked.axes.col(1) = sky_direction(sky, 90.0, 0.0);
  baked.axes.col(2) = sky.up;
  const SkyGrid grid = sky_grid(sky, sky.kind == SkyKind::map ? map_columns : sky_columns);
  baked.columns = grid.columns;
  baked.rows_above = grid.rows_above;
  baked.rows_below = grid.rows_below;
  const auto rgb = [&](const Spectrum& L, int channel) -> Eigen::Array3f {
    return linear_rgb(s.bands, L * factor_within(s, channel)).unaryExpr(&finite_or_black);
  };
  baked.radiance.resize(grid.radiance.rows(), 3);
  for (Eigen::Index i = 0; i < grid.radiance.rows(); ++i) {
    baked.radiance.row(i) = rgb(grid.radiance.row(i).transpose(), baked.channel).transpose();
  }
  if (!sky.sun) return baked;
  baked.sun = sky.sun->direction;
  baked.cosine_of_edge = sky.sun->cosine_of_edge();
  baked.sun_channel = channel_of(s, source);
  baked.sun_radiance =
      rgb(sky.sun->irradiance / static_cast<float>(sky.sun->solid_angle()), baked.sun_channel);
  return baked;
}

BandArray irradiance_with_all_on(const RadiositySolution& solution) {
  if (solution.channels.empty()) return solution.irradiance();
  BandArray light = BandArray::Zero(solution.direct_irradiance.rows(), solution.bands.count());
  for (const LightChannel& channel : solution.channels) {
    light += channel.direct_irradiance + channel.indirect_irradiance;
  }
  return light;
}

std::vector<ElementKind> kinds_with_all_on(const SolvedScene& solved,
                                           const std::vector<Material>& materials) {
  const RadiositySolution& s = solved.solution;
  if (s.channels.empty()) return element_kinds(solved, materials);
  SolvedScene all = unlit(solved);
  all.mesh.emission = s.full_emission;
  return element_kinds(all.mesh, irradiance_with_all_on(s), materials);
}

std::vector<BakedLampFace> bake_lamps(const SolvedScene& solved,
                                      const std::vector<Material>& materials,
                                      const DrawnLamps& lamps) {
  const RadiositySolution& s = solved.solution;
  std::vector<BakedLampFace> faces;
  if (lamps.faces().empty()) return faces;
  const auto rgb = [&](const BandArray& L, std::size_t f, const Spectrum& factor) {
    const Spectrum row = L.row(static_cast<Eigen::Index>(f)).transpose() * factor;
    return Eigen::Array3f(linear_rgb(s.bands, row).unaryExpr(&finite_or_black));
  };
  const BandArray L =
      lamps.radiance(solved.mesh, shown_radiance(solved, materials), solved.mesh.source_scale);
  for (std::size_t f = 0; f < lamps.faces().size(); ++f) {
    const DrawnLamps::Face& face = lamps.faces()[f];
    faces.push_back({.lamp = face.lamp,
                     .outline = face.outline,
                     .radiance = rgb(L, f, constant_spectrum(s.bands, 1.0f))});
  }
  SolvedScene alone = s.channels.empty() ? SolvedScene() : unlit(solved);
  for (std::size_t c = 0; c < s.channels.size(); ++c) {
    light_alone(s, c, alone);
    BandArray scale =
        BandArray::Zero(static_cast<Eigen::Index>(s.source_channel.size()), s.bands.count());
    for (std::size_t i = 0; i < s.source_channel.size(); ++i) {
      if (s.source_channel[i] == static_cast<int>(c))
        scale.row(static_cast<Eigen::Index>(i)) = 1.0f;
    }
    const BandArray of_channel =
        lamps.radiance(alone.mesh, shown_radiance(alone, materials), scale);
    const Spectrum within = factor_within(s, static_cast<int>(c));
    for (std::size_t f = 0; f < faces.size(); ++f) {
      faces[f].by_channel.push_back(rgb(of_channel, f, within));
    }
  }
  std::vector<BakedLampFace> lit;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto has_light = [](const Eigen::Array3f& light) { return (light > 0.0f).any(); };
    if (lamps.faces()[f].shines || has_light(faces[f].radiance) ||
        std::ranges::any_of(faces[f].by_channel, has_light)) {
      lit.push_back(std::move(faces[f]));
    }
  }
  return lit;
}

std::vector<BakedCue> bake_cues(const RadiositySolution& solution, const std::vector<Cue>& cues) {
  std::vector<BakedCue> baked;
  for (const Cue& cue : cues) {
    BakedCue& to = baked.emplace_back(BakedCue{.name = cue.name,
                                               .weights = {},
                                               .fade_up = cue.fade_up,
                                               .fade_down = cue.fade_down,
                                               .wait = cue.wait,
                                               .hold = cue.hold});
    for (std::size_t c = 0; c < cue.scales.size(); ++c) {
      const Split split = split_channels(solution.bands, cue.scales[c]);
      const Spectrum within = factor_within(solution, static_cast<int>(c));
      const bool is_on = (split.weight > 0.0f).any();
      if (is_on && (split.within - within).abs().maxCoeff() > 1e-6f) {  // rounding of scales
        throw InputError(fmt::format(
            "cue '{}': channel '{}' has another spectrum in the solution, of which a page holds "
            "one; relight the solution with '--channel {}=on' first",
            cue.name, solution.channels[c].name, solution.channels[c].name));
      }
      to.weights.push_back(split.weight);
    }
  }
  return baked;
}

std::vector<BakedChannel> bake_channels(const SolvedScene& solved,
                                        const std::vector<Material>& materials,
                                        const std::vector<int>& mesh_vertex) {
  const RadiositySolution& s = solved.solution;
  std::vector<BakedChannel> baked;
  if (s.channels.empty()) return baked;
  SolvedScene alone = unlit(solved);
  for (std::size_t c = 0; c < s.channels.size(); ++c) {
    light_alone(s, c, alone);
    baked.push_back(bake(alone, s.channels[c], materials, mesh_vertex));
  }
  return baked;
}

}  // namespace lightwell
