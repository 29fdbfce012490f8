#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "mesh/patches/pictured_emission.h"
#include "mesh/patches/round_grid.h"
#include "mesh/patches/translucency.h"
#include "radiosity/gather/final_gather.h"
#include "radiosity/gather/gatherable_radiosity.h"
#include "radiosity/openings/portals.h"
#include "scene/parallel.h"
#include "scene/sampling.h"
#include "viewer/export/baked_channels.h"
#include "viewer/export/chart_texels.h"
#include "viewer/export/fill_texels.h"
#include "viewer/export/lightmap.h"

namespace lightwell {
namespace {

using Texel = ChartTexels::Texel;

/// Weight of the face's centre in the position of a gather point, which so keeps off the border.
constexpr float hair = 1e-3f;

/// Texels of all charts of an atlas, chart after chart.
std::vector<Texel> texels_of(const LightmapLayout& layout, int atlas, const BakedModel& model,
                             const PatchMesh& mesh) {
  std::vector<int> charts;
  for (std::size_t c = 0; c < layout.charts.size(); ++c) {
    // A chart in its host's gap is not painted: fill_texels fills the gap.
    const bool is_painted = layout.charts[c].host < 0 && layout.place[c].atlas == atlas;
    if (is_painted) charts.push_back(static_cast<int>(c));
  }
  std::vector<std::vector<Texel>> of_chart(charts.size());
  parallel_for(static_cast<int>(charts.size()), 1, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      of_chart[i] = ChartTexels(layout, charts[i], model, mesh).texels();
    }
  });
  std::vector<Texel> all;
  for (std::vector<Texel>& texels : of_chart) {
    all.insert(all.end(), texels.begin(), texels.end());
    std::vector<Texel>().swap(texels);
  }
  return all;
}

/// Value at a texel, interpolated from values at the mesh's vertices.
Spectrum at_texel(const BakedModel& model, const BandArray& of_mesh, const Texel& texel) {
  Spectrum value = Spectrum::Zero(of_mesh.cols());
  const auto& corners = model.faces[texel.face];
  for (int c = 0; c < model.corner_count(texel.face); ++c) {
    value += texel.weights[c] * of_mesh.row(model.mesh_vertex[corners[c]]).transpose();
  }
  return value;
}

GatherPoint gather_point(const BakedModel& model, const PatchMesh& mesh, const Texel& texel,
                         std::uint64_t key) {
  const auto& corners = model.faces[texel.face];
  const int count = model.corner_count(texel.face), e = model.element[texel.face];
  GatherPoint point{.normal = Eigen::Vector3d::Zero(), .facet = mesh.facet[e], .key = key};
  for (int c = 0; c < count; ++c) {
    const double weight = (1.0f - hair) * texel.inside[c] + hair / static_cast<float>(count);
    point.position += weight * model.position[corners[c]];
    point.normal += weight * mesh.vertex_normal[model.mesh_vertex[corners[c]]];
  }
  const PatchPoint center = element_center(mesh, e);
  if (const RoundGrid* grid = round_grid_of(mesh, mesh.facet[e])) {
    point.position = nearest_on(grid->shape, point.position);
    point.normal = round_normal(mesh, *grid, mesh.patch[e], point.position);
  } else {
    point.position -= center.normal.dot(point.position - center.position) * center.normal;
    point.normal = point.normal.norm() > 0.0 ? point.normal.normalized() : center.normal;
  }
  return point;
}

bool has_light(const BakedModel& model, const Texel& texel) {
  const auto& corners = model.faces[texel.face];
  for (int c = 0; c < model.corner_count(texel.face); ++c) {
    if ((model.irradiance.row(corners[c]) > 0.0f).any()) return true;
  }
  return false;
}

/// E at each texel, W/m^2, texels x bands, computed as options.pass asks.
BandArray irradiance_of(const std::vector<Texel>& texels, const BakedModel& model,
                        const SolvedScene& solved, const Scene& scene,
                        const LightmapOptions& options) {
  const RadiositySolution& s = solved.solution;
  const auto count = static_cast<Eigen::Index>(texels.size());
  BandArray E = BandArray::Zero(count, s.bands.count());
  const auto interpolated = [&](const BandArray& of_mesh) {
    parallel_for(static_cast<int>(count), 4096, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        E.row(i) += at_texel(model, of_mesh, texels[i]).transpose();
      }
    });
  };
  if (options.pass == Pass::interpolate) {
    interpolated(s.irradiance());
    return E.max(0.0f);
  }
  std::vector<GatherPoint> points;
  std::vector<int> number;
  for (std::size_t i = 0; i < texels.size(); ++i) {
    // Faces covered by another surface have no light and stay dark.
    if (!has_light(model, texels[i])) continue;
    number.push_back(static_cast<int>(i));
    points.push_back(gather_point(model, solved.mesh, texels[i], i));
  }
  const ElementCaster caster(solved.mesh);
  const DirectLight direct_light(scene, caster);
  GatherOptions gathering{
      .rays = options.gather_rays, .shadows = options.shadows, .run = options.run};
  BandArray found;
  if (options.pass == Pass::direct) {
    interpolated(s.indirect_irradiance);
    found = gather_direct({scene, caster, direct_light}, points, gathering);
  } else {
    if (s.caustic_irradiance.size() > 0) interpolated(s.caustic_irradiance);
    const BandArray B = gatherable_radiosity({scene, caster, direct_light}, s);
    gathering.portals = find_portals(scene, caster, brightness_of_vertices(solved.mesh, B));
    const GatheredIrradiance all =
        gather_irradiance({scene, caster, direct_light}, B, points, gathering);
    found = all.direct + all.indirect;
  }
  for (std::size_t i = 0; i < number.size(); ++i) {
    E.row(number[i]) += found.row(static_cast<Eigen::Index>(i));
  }
  return E.max(0.0f);
}

/// M at a texel; a picture is averaged over the texel.
Spectrum emission_at_texel(const PicturedEmission& emission, const LightmapLayout& layout,
                           const BakedModel& model, const PatchMesh& mesh, const Texel& texel) {
  const int e = model.element[texel.face], patch = mesh.patch[e];
  if (!emission.shines(patch)) return mesh.emission.row(patch).transpose();
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  const auto& corners = model.faces[texel.face];
  for (int c = 0; c < model.corner_count(texel.face); ++c) {
    at += texel.inside[c] * model.position[corners[c]];
  }
  Eigen::Vector3d a, b;
  tangent_frame(element_center(mesh, e).normal, a, b);
  Eigen::Matrix<double, 3, 2> footprint;
  footprint << a, b;
  return emission.over(mesh.facet[e], at, footprint / layout.texels_per_metre);
}

Eigen::Array3f finite_rgb(const Bands& bands, const Spectrum& values) {
  return linear_rgb(bands, values).unaryExpr(&finite_or_black);
}

}  // namespace

LightmapAtlas paint_atlas(const LightmapLayout& layout, int atlas, const BakedModel& model,
                          const SolvedScene& solved, const Scene& scene,
                          const LightmapOptions& options) {
  const PatchMesh& mesh = solved.mesh;
  const Bands& bands = solved.solution.bands;
  const PicturedEmission emission(mesh);
  const std::vector<Texel> texels = texels_of(layout, atlas, model, mesh);
  const BandArray E = irradiance_of(texels, model, solved, scene, options);
  BandArray transmitted = BandArray::Zero(mesh.vertex_count(), bands.count());
  add_transmitted(mesh, solved.solution.irradiance(), transmitted);

  const Eigen::Index size = layout.size;
  LightmapAtlas painted{.size = layout.size};
  painted.irradiance = BandArray::Zero(size * size, bands.count());
  painted.radiosity = BandArray::Zero(size * size, 3);
  painted.radiance = BandArray::Zero(size * size, 3);
  const bool has_bounds = !model.lux_within.empty() && options.pass != Pass::gather;
  if (has_bounds) painted.lux_within = BandArray::Zero(size * size, 1);
  painted.face.assign(static_cast<std::size_t>(size * size), -1);
  std::vector<char> is_known(painted.face.size(), 0);
  for (std::size_t i = 0; i < texels.size(); ++i) {
    const Texel& texel = texels[i];
    const Eigen::Index at = size * texel.y + texel.x;
    const int patch = mesh.patch[model.element[texel.face]];
    const Spectrum M = emission_at_texel(emission, layout, model, mesh, texel);
    const Spectrum rho = mesh.reflectance.row(patch).transpose();
    const Spectrum e = E.row(static_cast<Eigen::Index>(i)).transpose();
    const Spectrum shown = shown_reflectance(mesh, scene.materials, patch);
    const Spectrum sent = M + at_texel(model, transmitted, texel);
    painted.irradiance.row(at) = e.unaryExpr(&finite_or_black).transpose();
    painted.radiosity.row(at).head<3>() = finite_rgb(bands, sent + rho * e).transpose();
    painted.radiance.row(at).head<3>() =
        finite_rgb(bands, (sent + shown * e) / std::numbers::pi_v<float>).transpose();
    if (has_bounds) painted.lux_within(at, 0) = model.lux_within[texel.face];
    is_known[static_cast<std::size_t>(at)] = 1;
    int& face = painted.face[static_cast<std::size_t>(at)];
    if (!texel.is_inside || face >= 0) continue;
    face = texel.face;
    ++painted.covered;
  }
  std::vector<BandArray*> pictures = {&painted.irradiance, &painted.radiosity, &painted.radiance};
  if (has_bounds) pictures.push_back(&painted.lux_within);
  fill_texels(layout.size, std::move(is_known), layout.padding, pictures);
  return painted;
}

}  // namespace lightwell
