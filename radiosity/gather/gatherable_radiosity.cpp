#include "radiosity/gather/gatherable_radiosity.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "mesh/patches/patch_sampler.h"
#include "mesh/patches/patch_textures.h"
#include "mesh/patches/pictured_emission.h"
#include "mesh/patches/translucency.h"
#include "radiosity/direct_light/patch_base.h"
#include "radiosity/gather/hemisphere_gather.h"
#include "radiosity/gather/vertex_points.h"
#include "scene/parallel.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// Gains of direct light, vertices x channels. Empty without coats.
BandArray direct_gains(const PatchMesh& mesh, const DirectLight& direct_light,
                       Eigen::Index channels) {
  if (!direct_light.has_coats()) return {};
  const std::vector<int> patch = vertex_patches(mesh);
  BandArray gains = BandArray::Ones(mesh.vertex_count(), channels);
  const VertexGatherPoints points(mesh);
  constexpr int grain = 256;
  parallel_for(mesh.vertex_count(), grain, [&](int begin, int end) {
    for (int v = begin; v < end; ++v) {
      const std::optional<CoatedBase> base = base_of_patch(direct_light, mesh, patch[v]);
      if (!base) continue;
      const GatherPoint point = points[v];
      const SurfacePoint at{point.position, point.normal, point.facet};
      if (channels == direct_light.channel_count()) {
        gains.row(v) = direct_light.base_gains(at, *base).cast<float>().transpose();
      } else {
        gains.row(v).setConstant(static_cast<float>(direct_light.base_gain(at, *base)));
      }
    }
  });
  return gains;
}

// Irradiance at vertices, and its part straight from lights, both vertices x columns.
struct VertexLight {
  const BandArray& irradiance;
  const Eigen::Ref<const BandArray>& direct;
};

// Adds to `at_base`, which is the irradiance, what bases get beyond it by gains of direct light or
// of the rest. Gains are vertices x channels, or empty: 1.
void add_gained(const VertexLight& light, const BandArray& gains, bool of_direct,
                Eigen::Index bands, BandArray& at_base) {
  if (gains.size() == 0) return;
  for (Eigen::Index v = 0; v < at_base.rows(); ++v) {
    for (Eigen::Index k = 0; k < at_base.cols(); k += bands) {
      const float beyond = gains(v, k / bands) - 1.0f;
      if (beyond == 0.0f) continue;
      const auto direct = light.direct.row(v).segment(k, bands);
      auto here = at_base.row(v).segment(k, bands);
      if (of_direct) {
        here += beyond * direct;
      } else {
        here += beyond * (light.irradiance.row(v).segment(k, bands) - direct);
      }
    }
  }
}

// B = rho E_base + M without the emission that `direct_light` owns, and what sheets pass.
BandArray radiosity_of(const PatchMesh& mesh, const DirectLight& direct_light,
                       const BandArray& at_base) {
  const std::vector<int> patch = vertex_patches(mesh);
  const BandArray rho = vertex_reflectance(mesh), emission = vertex_emission(mesh);
  const Eigen::Index bands = mesh.reflectance.cols();
  BandArray B(at_base.rows(), at_base.cols());
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const int p = patch[v], facet = mesh.facet[mesh.first_element[p]];
    for (Eigen::Index k = 0; k < B.cols(); k += bands) {
      B.row(v).segment(k, bands) = rho.row(v) * at_base.row(v).segment(k, bands);
    }
    if (direct_light.owns(facet, mesh.is_back[p] != 0)) continue;
    B.row(v).segment(direct_light.first_column(facet), bands) += emission.row(v);
  }
  add_transmitted(mesh, at_base, B);
  return B;
}

// A number of rays for each of `count` elements, a power of two: at most half a million rays in
// all, which take about a second, and eight for each element at least.
int rays_for(std::size_t count, int most_rays) {
  constexpr std::size_t most_of_all = std::size_t{1} << 19;
  constexpr int fewest = 8;
  int rays = most_rays;
  while (rays / 2 >= fewest && static_cast<std::size_t>(rays) * count > most_of_all) rays /= 2;
  return rays;
}

}  // namespace

BandArray indirect_base_gains(const LitScene& lit, const BandArray& radiosity, int most_rays) {
  if (!lit.direct_light.has_coats()) return {};
  const PatchMesh& mesh = lit.mesh();
  const Eigen::Index bands = mesh.reflectance.cols(), channels = radiosity.cols() / bands;
  std::vector<int> elements;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (lit.direct_light.base_of(mesh.material[mesh.patch[e]])) elements.push_back(e);
  }
  if (elements.empty()) return {};
  const auto count = static_cast<int>(elements.size());
  const GatherPoints points(count, [&](int i) {
    const int e = elements[static_cast<std::size_t>(i)];
    const PatchPoint at = element_center(mesh, e);
    return GatherPoint{.position = at.position, .normal = at.normal, .facet = mesh.facet[e]};
  });
  const GatherOptions options{.rays = rays_for(elements.size(), most_rays)};
  const HemisphereGather hemisphere(lit, radiosity, options, points);
  BandArray to_base(count, channels), arriving(count, channels);
  constexpr int grain = 16;
  parallel_for(count, grain, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const int e = elements[static_cast<std::size_t>(i)];
      const CoatedBase base = *base_of_patch(lit.direct_light, mesh, mesh.patch[e]);
      const Eigen::ArrayX2d light = hemisphere.gather_at_base(
          points[i], random_key(static_cast<std::uint64_t>(e), RandomPurpose::gather_shadows),
          base);
      for (Eigen::Index c = 0; c < channels; ++c) {
        const Eigen::Array2d of_channel = light.middleRows(c * bands, bands).colwise().mean();
        to_base(i, c) = static_cast<float>(of_channel[0]);
        arriving(i, c) = static_cast<float>(of_channel[1]);
      }
    }
  });
  BandArray sum = BandArray::Zero(mesh.vertex_count(), channels), all = sum;
  for (int i = 0; i < count; ++i) {
    const int e = elements[static_cast<std::size_t>(i)];
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      sum.row(mesh.corners[e][c]) += to_base.row(i);
      all.row(mesh.corners[e][c]) += arriving.row(i);
    }
  }
  return (all > 0.0f).select(sum / all, 1.0f);
}

BandArray gatherable_radiosity(const PatchMesh& mesh, const DirectLight& direct_light,
                               const BandArray& irradiance,
                               const Eigen::Ref<const BandArray>& direct) {
  const Eigen::Index bands = mesh.reflectance.cols();
  BandArray at_base = irradiance;
  if (direct.rows() > 0) {
    add_gained({irradiance, direct}, direct_gains(mesh, direct_light, direct.cols() / bands), true,
               bands, at_base);
  }
  return radiosity_of(mesh, direct_light, at_base);
}

BandArray gatherable_radiosity(const PatchMesh& mesh, const DirectLight& direct_light,
                               const RadiositySolution& solution) {
  return gatherable_radiosity(mesh, direct_light, solution.irradiance(),
                              solution.direct_irradiance);
}

BandArray gatherable_radiosity(const LitScene& lit, const BandArray& irradiance,
                               const Eigen::Ref<const BandArray>& direct) {
  const PatchMesh& mesh = lit.mesh();
  if (!lit.direct_light.has_coats()) {
    return gatherable_radiosity(mesh, lit.direct_light, irradiance, direct);
  }
  const Eigen::Index bands = mesh.reflectance.cols();
  BandArray at_base = irradiance;
  const VertexLight light{irradiance, direct};
  add_gained(light, direct_gains(mesh, lit.direct_light, direct.cols() / bands), true, bands,
             at_base);
  // Neighbouring elements average the noise of their gains, and the rays that read the radiosity
  // average it over many elements.
  constexpr int rays = 32;
  const BandArray even = radiosity_of(mesh, lit.direct_light, at_base);
  add_gained(light, indirect_base_gains(lit, even, rays), false, bands, at_base);
  return radiosity_of(mesh, lit.direct_light, at_base);
}

BandArray gatherable_radiosity(const LitScene& lit, const RadiositySolution& solution) {
  return gatherable_radiosity(lit, solution.irradiance(), solution.direct_irradiance);
}

}  // namespace lightwell
