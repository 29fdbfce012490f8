#include "radiosity/reconstruct.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "radiosity/interpolation_error.h"
#include "radiosity/light_path.h"

namespace lightwell {
namespace {

constexpr std::uint64_t draft_replica = 1000;

// Patch radiosities less what DirectLight accounts for, patches x columns of its channels.
BandArray without_owned_emission(const PatchMesh& mesh, const DirectLight& direct_light,
                                 const BandArray& patch_radiosity) {
  BandArray B = patch_radiosity;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    const int facet = mesh.facet[mesh.first_element[p]];  // emitters' patches are of one
    if (!direct_light.owns(facet, mesh.is_back[p] != 0)) continue;
    B.row(p).segment(direct_light.first_column(facet), mesh.emission.cols()) -=
        mesh.emission.row(p);
  }
  return B;
}

// The mean of the patches around each vertex, by the area of their elements there.
BandArray to_vertices(const PatchMesh& mesh, const BandArray& of_patches) {
  BandArray sum = BandArray::Zero(mesh.vertex_count(), of_patches.cols());
  Eigen::ArrayXf weight = Eigen::ArrayXf::Zero(mesh.vertex_count());
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto area = static_cast<float>(mesh.element_area[e]);
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      sum.row(mesh.corners[e][c]) += area * of_patches.row(mesh.patch[e]);
      weight[mesh.corners[e][c]] += area;
    }
  }
  return sum.colwise() / weight.max(1e-30f);
}

// First guess for the gather: patch radiosities, smoothed to vertices.
BandArray patch_to_vertex(const PatchMesh& mesh, const DirectLight& direct_light,
                          const BandArray& patch_radiosity) {
  return to_vertices(mesh, without_owned_emission(mesh, direct_light, patch_radiosity));
}

// Scales what is read at vertices (W/m^2 of reflected light, interpolated over elements, in columns
// of every channel) to leave the scene with the power that the patches' equations balanced: between
// vertices that are far apart interpolation cuts peaks off, and would lose it at each reflection.
// One factor a band for the whole scene, since what a patch's own value is off by where light is
// steep, in a corner or beside what stands on it, is more than what it would set right there. But
// peaks that are cut by a notable share of the scene's light, such as the place that a spotlight
// falls on, get it back themselves, or all other surfaces would shine with it. All light together
// says how much, so that channels add up.
void keep_power(const PatchMesh& mesh, const DirectLight& direct_light,
                const BandArray& patch_radiosity, BandArray& radiosity) {
  const Eigen::Index bands = mesh.reflectance.cols();
  const BandArray balanced = channel_sum(
      without_owned_emission(mesh, direct_light, patch_radiosity), static_cast<int>(bands));
  const BandArray read = channel_sum(radiosity, static_cast<int>(bands));
  Eigen::ArrayXXd wanted(mesh.patch_count(), bands);  // W
  for (int p = 0; p < mesh.patch_count(); ++p) {
    wanted.row(p) = mesh.area[p] * balanced.row(p).cast<double>();
  }
  Eigen::ArrayXXd found = Eigen::ArrayXXd::Zero(mesh.patch_count(), bands);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int n = mesh.corner_count(e);
    for (int c = 0; c < n; ++c) {
      found.row(mesh.patch[e]) +=
          mesh.element_area[e] / n * read.row(mesh.corners[e][c]).cast<double>();
    }
  }
  constexpr double most = 1.25;  // more, and elements are too large to tell
  const auto ratio = [most](const Eigen::ArrayXd& a, const Eigen::ArrayXd& b) -> Eigen::ArrayXd {
    return (b > 0.0).select(a / b.max(1e-300), 1.0).max(1.0 / most).min(most);
  };
  // Of all light, and several times what a patch holds in the mean, so that few patches are not all
  // peaks.
  const double notable = std::max(0.002, 4.0 / std::max(1, mesh.patch_count()));
  const double least = notable * wanted.sum();
  const auto is_peak = [&](int p) {
    return std::abs(wanted.row(p).sum() - found.row(p).sum()) > least;
  };
  Eigen::ArrayXd other_wanted = Eigen::ArrayXd::Zero(bands), other_found = other_wanted;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    if (is_peak(p)) continue;
    other_wanted += wanted.row(p).transpose();
    other_found += found.row(p).transpose();
  }
  const Eigen::ArrayXf of_others = ratio(other_wanted, other_found).cast<float>();
  BandArray factor(mesh.patch_count(), bands);
  for (int p = 0; p < mesh.patch_count(); ++p) {
    factor.row(p) = of_others.transpose();
    if (!is_peak(p)) continue;
    factor.row(p) =
        ratio(wanted.row(p).transpose(), found.row(p).transpose()).cast<float>().transpose();
  }
  const BandArray at_vertices = to_vertices(mesh, factor);
  for (Eigen::Index k = 0; k < radiosity.cols(); k += bands) {
    radiosity.middleCols(k, bands) *= at_vertices;
  }
}

BandArray caustics(const Scene& scene, const ElementCaster& caster, const DirectLight& direct_light,
                   const SolveOptions& options) {
  return caustic_irradiance(scene, caster, direct_light, options.caustic_rays,
                            options.form_factors.max_specular_depth, options.progress,
                            options.journal);
}

// Caustics on elements of even size, from which vertices of all others take theirs: on small ones
// there would be too few rays.
class EvenCaustics {
 public:
  EvenCaustics(const Scene& scene, const DirectLight& direct_light, const SolveOptions& options,
               RefinedElements& elements) {
    const LightPaths paths(scene, ElementCaster(elements.base()), 1);
    if (!paths.has_specular()) return;
    const std::vector<int> all = elements.leaves();
    if (starts_coarse(options) && options.mesh.elements_per_patch_edge > 1) elements.split(all);
    const RefinedMesh even = elements.mesh();
    elements.merge(all);
    values_ = BandArray::Zero(elements.vertex_count(), direct_light.column_count());
    const BandArray found = caustics(scene, ElementCaster(even.mesh), direct_light, options);
    if (found.size() == 0) return;
    known_ = elements.vertex_count();
    for (std::size_t v = 0; v < even.vertex.size(); ++v) {
      values_.row(even.vertex[v]) = found.row(static_cast<Eigen::Index>(v));
    }
  }

  BandArray at(const RefinedElements& elements, const std::vector<int>& vertices) {
    if (known_ == 0) return {};
    values_.conservativeResize(elements.vertex_count(), values_.cols());
    for (int v = known_; v < elements.vertex_count(); ++v) {
      values_.row(v).setZero();
      int count = 0;
      for (const int end : elements.ends(v)) {
        if (end < 0) continue;
        values_.row(v) += values_.row(end);
        ++count;
      }
      values_.row(v) /= static_cast<float>(count);
    }
    BandArray result(static_cast<Eigen::Index>(vertices.size()), values_.cols());
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      result.row(static_cast<Eigen::Index>(v)) = values_.row(vertices[v]);
    }
    return result;
  }

 private:
  BandArray values_{};
  int known_ = 0;  // vertices; 0: there are no caustics
};

Draft refined_draft(const Scene& scene, const ElementCaster& caster,
                    const DirectLight& direct_light, const SolveOptions& options,
                    const GatherOptions& gather_options, const BandArray& radiosity,
                    const BandArray& patch_radiosity) {
  RefinedElements elements(caster.mesh());
  EvenCaustics even_caustics(scene, direct_light, options, elements);
  std::vector<int> base_vertices(caster.mesh().vertex_count());
  std::iota(base_vertices.begin(), base_vertices.end(), 0);
  const BandArray caustic = even_caustics.at(elements, base_vertices);
  RefinedSolution found;
  if (direct_light.channel_count() == 1) {
    found = refine_solution(scene, caster, direct_light, radiosity, caustic, elements,
                            gather_options, options.refine);
  } else {
    const DirectLight all_light(scene, caster.mesh(), {}, &direct_light);
    const ChannelLight by_channel{direct_light, radiosity, caustic};
    found = refine_solution(scene, caster, all_light,
                            patch_to_vertex(caster.mesh(), all_light, patch_radiosity),
                            channel_sum(caustic, scene.bands.count()), elements, gather_options,
                            options.refine, &by_channel);
  }
  return {.refined = std::move(found.refined.mesh),
          .direct = std::move(found.draft.direct),
          .indirect = std::move(found.draft.indirect),
          .caustic = even_caustics.at(elements, found.refined.vertex),
          .interpolation_error = std::move(found.error),
          .refinement = found.report};
}

// Of the error in an element's interpolated irradiance, see RadiositySolution. `ray_variance`: at
// vertices, that of a single ray. What one vertex says of it is little more than a guess, so that a
// patch's vertices say it together.
Eigen::ArrayXf gather_noise(const PatchMesh& mesh, const BandArray& irradiance,
                            const Eigen::ArrayXf& ray_variance,
                            std::span<const GatherPoint> points) {
  Eigen::ArrayXd of_patch = Eigen::ArrayXd::Zero(mesh.patch_count());
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int n = mesh.corner_count(e);
    for (int c = 0; c < n; ++c) {
      of_patch[mesh.patch[e]] += mesh.element_area[e] / n * ray_variance[mesh.corners[e][c]];
    }
  }
  const Eigen::ArrayXd reference = error_references(mesh, irradiance);
  Eigen::ArrayXf noise = Eigen::ArrayXf::Zero(mesh.element_count());
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int n = mesh.corner_count(e), p = mesh.patch[e];
    if (!(reference[e] > 0.0) || !(mesh.area[p] > 0.0)) continue;
    double of_corners = 0.0;
    for (int c = 0; c < n; ++c) of_corners += 1.0 / points[mesh.corners[e][c]].rays / n;
    // What is left of independent errors at the corners, over the element: the mean of the sum of
    // squared weights.
    const double interpolated = n == 4 ? 4.0 / 9.0 : 1.0 / 2.0;
    const double variance = of_patch[p] / mesh.area[p] * of_corners * interpolated;
    noise[e] = static_cast<float>(std::sqrt(variance) / reference[e]);
  }
  return noise;
}

// Of patches, with columns of every channel.
BandArray unscaled_radiosity(const RadiositySolution& solution) {
  if (solution.channels.empty()) return solution.patch_radiosity;
  return side_by_side(solution.channels, &LightChannel::patch_radiosity);
}

GatherOptions gather_options(const SolveOptions& options) {
  GatherOptions gather = options.gather;
  gather.progress = options.progress;
  gather.journal = options.journal;
  return gather;
}

}  // namespace

Draft make_draft(const Scene& scene, const ElementCaster& caster, const DirectLight& direct_light,
                 const SolveOptions& options, const RadiositySolution& solution) {
  const BandArray radiosity =
      patch_to_vertex(caster.mesh(), direct_light, unscaled_radiosity(solution));
  GatherOptions gather = gather_options(options);
  if (options.refine.tolerance > 0.0) {
    return refined_draft(scene, caster, direct_light, options, gather, radiosity,
                         solution.patch_radiosity);
  }
  gather.rays = std::max(1, gather.rays / 4);
  gather.replica += draft_replica;
  gather.shadows = {.min_rays = std::max(1, gather.shadows.min_rays / 2),
                    .max_rays = std::max(1, gather.shadows.max_rays / 4)};
  GatheredIrradiance draft = gather_irradiance(scene, caster, direct_light, radiosity,
                                               vertex_gather_points(caster.mesh()), gather);
  return {.direct = std::move(draft.direct),
          .indirect = std::move(draft.indirect),
          .caustic = caustics(scene, caster, direct_light, options)};
}

void reconstruct(const Scene& scene, const ElementCaster& caster, const DirectLight& direct_light,
                 const SolveOptions& options, Draft draft, RadiositySolution& solution) {
  const PatchMesh& mesh = caster.mesh();
  const bool has_caustics = draft.caustic.size() > 0;
  BandArray irradiance = draft.direct + draft.indirect;
  if (has_caustics) irradiance += draft.caustic;
  BandArray radiosity = gatherable_radiosity(mesh, direct_light, irradiance);
  if (draft.refined) keep_power(mesh, direct_light, unscaled_radiosity(solution), radiosity);
  const GatherOptions gather = gather_options(options);
  std::vector<GatherPoint> points = vertex_gather_points(mesh);
  share_rays(mesh, gather.rays, points);
  Eigen::ArrayXf variance;
  if (draft.refined) {
    solution.direct_irradiance = std::move(draft.direct);
    GatheredIrradiance gathered =
        gather_indirect(scene, caster, direct_light, radiosity, points, gather);
    solution.indirect_irradiance = std::move(gathered.indirect);
    variance = std::move(gathered.variance);
  } else {
    GatheredIrradiance gathered =
        gather_irradiance(scene, caster, direct_light, radiosity, points, gather);
    solution.direct_irradiance = std::move(gathered.direct);
    solution.indirect_irradiance = std::move(gathered.indirect);
    variance = std::move(gathered.variance);
  }
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    variance[v] *= static_cast<float>(points[v].rays);
  }
  solution.gather_noise =
      gather_noise(mesh, channel_sum(irradiance, scene.bands.count()), variance, points);
  if (has_caustics) solution.indirect_irradiance += draft.caustic;
  solution.caustic_irradiance = std::move(draft.caustic);
  solution.interpolation_error = std::move(draft.interpolation_error);
  if (solution.channels.empty()) return;
  split_columns(solution.direct_irradiance, &LightChannel::direct_irradiance, solution.channels);
  split_columns(solution.indirect_irradiance, &LightChannel::indirect_irradiance,
                solution.channels);
  split_columns(solution.caustic_irradiance, &LightChannel::caustic_irradiance, solution.channels);
}

}  // namespace lightwell
