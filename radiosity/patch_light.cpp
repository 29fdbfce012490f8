#include "radiosity/patch_light.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
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
  const Eigen::Index bands = mesh.reflectance.cols();
  const BandArray balanced = channel_sum(
      without_owned_emission(mesh, direct_light, patch_radiosity), static_cast<int>(bands));
  const BandArray read = channel_sum(radiosity, static_cast<int>(bands));
  Eigen::ArrayXXd wanted(mesh.patch_count(), bands);  // W
  for (int p = 0; p < mesh.patch_count(); ++p) {
    wanted.row(p) = mesh.area[p] * balanced.row(p).cast<double>();
  }
  const Eigen::ArrayXXd found = patch_integral(mesh, read);
  constexpr double most = 1.25;  // a larger factor means that elements are too large to trust it
  const auto ratio = [most](const Eigen::ArrayXd& a, const Eigen::ArrayXd& b) -> Eigen::ArrayXd {
    return (b > 0.0).select(a / b.max(1e-300), 1.0).max(1.0 / most).min(most);
  };
  const double least = notable_share(mesh) * wanted.sum();
  const auto is_peak = [&](int p) {
    return std::abs(wanted.row(p).sum() - found.row(p).sum()) > least;
  };
  BandArray factor(mesh.patch_count(), bands);
  std::vector<int> others;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    if (is_peak(p)) {
      factor.row(p) =
          ratio(wanted.row(p).transpose(), found.row(p).transpose()).cast<float>().transpose();
    } else {
      others.push_back(p);
    }
  }
  const PatchNeighbourhoods neighbourhoods(mesh);
  neighbourhoods.visit(others, [&](std::span<const int> patches) {
    Eigen::ArrayXd all_wanted = Eigen::ArrayXd::Zero(bands), all_found = all_wanted;
    for (const int p : patches) {
      all_wanted += wanted.row(p).transpose();
      all_found += found.row(p).transpose();
    }
    const Eigen::ArrayXf of_all = ratio(all_wanted, all_found).cast<float>();
    for (const int p : patches) factor.row(p) = of_all.transpose();
  });
  const BandArray at_vertices = to_vertices(mesh, factor);
  for (Eigen::Index k = 0; k < radiosity.cols(); k += bands) {
    radiosity.middleCols(k, bands) *= at_vertices;
  }
}

}  // namespace lightwell
