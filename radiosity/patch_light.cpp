#include "radiosity/patch_light.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "mesh/patches/mesh_bounds.h"
#include "radiosity/gather/patch_power.h"

namespace lightwell {
namespace {

// Patch radiosities without the emission that `direct_light` owns, patches x columns.
BandArray without_owned_emission(const PatchMesh& mesh, const DirectLight& direct_light,
                                 const BandArray& patch_radiosity) {
  BandArray B = patch_radiosity;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    const int facet = mesh.facet[mesh.first_element[p]];  // emitters' patches lie on one facet each
    if (!direct_light.owns(facet, mesh.is_back[p] != 0)) continue;
    B.row(p).segment(direct_light.first_column(facet), mesh.emission.cols()) -=
        mesh.emission.row(p);
  }
  return B;
}

// Area of the elements at each vertex, m^2; above 0 everywhere.
Eigen::ArrayXf area_around_vertices(const PatchMesh& mesh) {
  Eigen::ArrayXf sum = Eigen::ArrayXf::Zero(mesh.vertex_count());
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto area = static_cast<float>(mesh.element_area[e]);
    for (int c = 0; c < mesh.corner_count(e); ++c) sum[mesh.corners[e][c]] += area;
  }
  return sum.max(1e-30f);
}

// Patches that lie near each other and face alike.
class PatchNeighbourhoods {
 public:
  explicit PatchNeighbourhoods(const PatchMesh& mesh)
      : coordinates_(static_cast<std::size_t>(mesh.patch_count()), Coordinates::Zero()) {
    // Opposite normals are as far apart as the ends of the scene.
    constexpr double of_normal = 0.5;
    const double diagonal = mesh_bounds(mesh).diagonal();
    for (int e = 0; e < mesh.element_count(); ++e) {
      const PatchPoint at = element_center(mesh, e);
      Coordinates coordinates;
      coordinates << at.position / diagonal, of_normal * at.normal;
      const int p = mesh.patch[e];
      coordinates_[p] += mesh.element_area[e] / mesh.area[p] * coordinates;
    }
  }

  // Halves the patches across the longest side of their box until no group has more than twice
  // enough(), and calls visit_group(group). Changes the order of the patches.
  template <class Visit>
  void visit(std::span<int> patches, Visit&& visit_group) const {
    if (patches.size() <= 2 * enough()) {
      visit_group(patches);
      return;
    }
    Eigen::AlignedBox<double, 6> box;
    for (const int p : patches) box.extend(coordinates_[p]);
    Eigen::Index axis = 0;
    box.sizes().maxCoeff(&axis);
    std::ranges::sort(patches, {}, [&](int p) { return std::pair(coordinates_[p][axis], p); });
    visit(patches.first(patches.size() / 2), visit_group);
    visit(patches.subspan(patches.size() / 2), visit_group);
  }

 private:
  // Patches that have an error of 1 % together. In corners and beside objects the error of a patch
  // alone is some 14 % in a scene of 20 000 patches, and in proportion to the edge of a patch.
  std::size_t enough() const {
    constexpr std::size_t times_patches = 4000000, fewest = 64;
    return std::max(fewest, times_patches / std::max<std::size_t>(coordinates_.size(), 1));
  }

  using Coordinates = Eigen::Matrix<double, 6, 1>;  // place and normal, means over the patch
  std::vector<Coordinates> coordinates_;
};

// Powers by radiosities of patches and of vertices, W/m^2 of every channel; all channels added.
PatchPowers powers_of(const PatchMesh& mesh, const BandArray& of_patches,
                      const BandArray& at_vertices) {
  const auto bands = static_cast<int>(mesh.reflectance.cols());
  const BandArray B = channel_sum(of_patches, bands);
  Eigen::ArrayXXd balanced(mesh.patch_count(), bands);
  for (int p = 0; p < mesh.patch_count(); ++p) {
    balanced.row(p) = mesh.area[p] * B.row(p).cast<double>();
  }
  return {mesh, std::move(balanced), patch_integral(mesh, channel_sum(at_vertices, bands))};
}

// Factors at vertices that give neighbourhoods and peaks the power that was balanced, vertices x
// bands.
BandArray power_factors(const PatchMesh& mesh, const PatchNeighbourhoods& neighbourhoods,
                        const PatchPowers& powers) {
  BandArray factor(mesh.patch_count(), mesh.reflectance.cols());
  std::vector<int> others;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    if (powers.is_peak(p)) {
      factor.row(p) = powers.factor(std::span(&p, 1)).transpose();
    } else {
      others.push_back(p);
    }
  }
  neighbourhoods.visit(others, [&](std::span<const int> patches) {
    const Eigen::ArrayXf of_all = powers.factor(patches);
    for (const int p : patches) factor.row(p) = of_all.transpose();
  });
  return to_vertices(mesh, factor);
}

// Irradiance of patches that have no light from behind or of their own, W/m^2, as their equations
// balanced it, and 1 where it is known: both patches x columns.
struct PatchIrradiance {
  PatchIrradiance(const PatchMesh& mesh, const BandArray& radiosity)
      : irradiance(BandArray::Zero(radiosity.rows(), radiosity.cols())), is_known(irradiance) {
    const Eigen::Index bands = mesh.reflectance.cols();
    for (int p = 0; p < mesh.patch_count(); ++p) {
      if (mesh.patch_behind(p) >= 0 || (mesh.emission.row(p) > 0.0f).any()) continue;
      for (Eigen::Index k = 0; k < radiosity.cols(); ++k) {
        const float rho = mesh.reflectance(p, k % bands);
        if (!(rho > 0.0f)) continue;
        irradiance(p, k) = radiosity(p, k) / rho;
        is_known(p, k) = 1.0f;
      }
    }
  }

  BandArray irradiance, is_known;
};

}  // namespace

BandArray unscaled_radiosity(const RadiositySolution& solution) {
  if (solution.channels.empty()) return solution.patch_radiosity;
  return side_by_side(solution.channels, &LightChannel::patch_radiosity);
}

BandArray to_vertices(const PatchMesh& mesh, const BandArray& of_patches) {
  BandArray sum = BandArray::Zero(mesh.vertex_count(), of_patches.cols());
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto area = static_cast<float>(mesh.element_area[e]);
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      sum.row(mesh.corners[e][c]) += area * of_patches.row(mesh.patch[e]);
    }
  }
  return sum.colwise() / area_around_vertices(mesh);
}

BandArray shares_of_patches(const PatchMesh& mesh, const BandArray& shares) {
  const BandArray by_area = shares.colwise() / area_around_vertices(mesh);
  BandArray sum = BandArray::Zero(mesh.patch_count(), shares.cols());
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto area = static_cast<float>(mesh.element_area[e]);
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      sum.row(mesh.patch[e]) += area * by_area.row(mesh.corners[e][c]);
    }
  }
  return sum;
}

BandArray gather_patch_shares(const LitScene& lit, const GatherPoints& points,
                              const GatherOptions& options) {
  const PatchMesh& mesh = lit.mesh();
  const Eigen::Index bands = lit.scene.bands.count(), vertices = mesh.vertex_count();
  BandArray shares(mesh.patch_count(), points.size() * bands);
  // Shares of vertices in a block of points take 128 MB, three times over.
  const auto most =
      static_cast<int>(std::max<Eigen::Index>(1, (Eigen::Index{1} << 25) / (vertices * bands)));
  for (int first = 0; first < points.size(); first += most) {
    const int n = std::min(most, points.size() - first);
    const GatherPoints block(n, [&](int i) {
      GatherPoint point = points[first + i];
      if (!point.key) point.key = static_cast<std::uint64_t>(first + i);
      return point;
    });
    const BandArray E = gather_shares(lit, block, options);
    BandArray of_vertices(vertices, n * bands);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index v = 0; v < vertices; ++v) {
        of_vertices.row(v).segment(i * bands, bands) = E.row(i).segment(v * bands, bands);
      }
    }
    shares.middleCols(first * bands, n * bands) = shares_of_patches(mesh, of_vertices);
  }
  return shares;
}

BandArray patch_to_vertex(const PatchMesh& mesh, const DirectLight& direct_light,
                          const BandArray& patch_radiosity) {
  return to_vertices(mesh, without_owned_emission(mesh, direct_light, patch_radiosity));
}

void keep_power(const PatchMesh& mesh, const DirectLight& direct_light,
                const BandArray& patch_radiosity, BandArray& radiosity) {
  const BandArray unowned = without_owned_emission(mesh, direct_light, patch_radiosity);
  const PatchNeighbourhoods neighbourhoods(mesh);
  const Eigen::Index bands = mesh.reflectance.cols();
  for (Eigen::Index k = 0; k < radiosity.cols(); k += bands) {
    const BandArray of_channel = radiosity.middleCols(k, bands);
    const PatchPowers powers = powers_of(mesh, unowned.middleCols(k, bands), of_channel);
    radiosity.middleCols(k, bands) *= power_factors(mesh, neighbourhoods, powers);
  }
}

namespace {

// Patches whose light of lamps is a pool narrower than elements. Rays of lamps give the patches'
// powers: an error of less than a hundred rays may be their noise, as where a lamp far away stands
// for the sun and few of its rays meet the scene.
std::vector<int> find_pools(const LitScene& lit, const PatchPowers& powers,
                            const PatchIrradiance& balanced, int free_rays) {
  const PatchMesh& mesh = lit.mesh();
  double flux = 0.0;
  for (const Lamp& lamp : lit.scene.lamps) flux += double{lamp_flux(lamp).sum()};
  const double noise = 100.0 * flux / free_rays;
  std::vector<int> pools;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    const bool is_known = (balanced.is_known.row(p) > 0.0f).any();
    const bool is_certain = powers.error(p) > noise * double{mesh.reflectance.row(p).maxCoeff()};
    if (is_known && is_certain && powers.is_peak(p) && powers.is_pool(p)) pools.push_back(p);
  }
  return pools;
}

}  // namespace

void spread_pools(const LitScene& lit, const BandArray& patch_radiosity, const BandArray& others,
                  int free_rays, BandArray& direct) {
  if (lit.scene.lamps.empty()) return;
  const PatchMesh& mesh = lit.mesh();
  const BandArray unowned = without_owned_emission(mesh, lit.direct_light, patch_radiosity);
  const PatchPowers powers = powers_of(
      mesh, unowned, gatherable_radiosity(mesh, lit.direct_light, direct + others, direct));
  const PatchIrradiance balanced(mesh, unowned);
  const std::vector<int> pools = find_pools(lit, powers, balanced, free_rays);
  if (pools.empty()) return;
  const BandArray known = to_vertices(mesh, balanced.is_known);
  const BandArray even = to_vertices(mesh, balanced.irradiance);
  for (const int p : pools) {
    for (const int v : corners_of_patch(mesh, p)) {
      const auto is_known = known.row(v) > 0.0f;
      const auto mean = even.row(v) / known.row(v).max(1e-30f);
      direct.row(v) = is_known.select((mean - others.row(v)).max(0.0f), direct.row(v));
    }
  }
}

}  // namespace lightwell
