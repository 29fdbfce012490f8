#include "radiosity/refine/shared_gathers.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "mesh/patches/area_shares.h"
#include "mesh/patches/translucency.h"
#include "radiosity/gather/patch_power.h"
#include "radiosity/refine/error_reference.h"

namespace lightwell {
namespace {

// The smallest crumbs that share: two records and one vertex, or enough to save half of the
// gathers.
constexpr std::size_t fewest_read = 8, fewest_unread = 3;
// Largest mean area of a crumb's vertices as a share of the typical one: three levels of splits.
constexpr double largest_share = 1.0 / 64.0;
// Vertices of a group. Four records of 32 save seven of eight gathers, two of 64 all but 3 %.
constexpr std::size_t group_of_read = 32, group_of_unread = 64, fewest_of_four = 16;

// The vertices of a patch in groups of neighbours.
class VertexGroups {
 public:
  VertexGroups(const PatchMesh& mesh, std::size_t most) : mesh_(mesh), most_(most) {}

  // Halves the vertices across the longest side of their box until each group is small enough, and
  // calls visit(group).
  template <class Visit>
  void visit(std::span<int> vertices, Visit&& visit_group) const {
    if (vertices.size() <= most_) {
      visit_group(vertices);
      return;
    }
    Eigen::AlignedBox3d box;
    for (const int v : vertices) box.extend(mesh_.position(v));
    Eigen::Index axis = 0;
    box.sizes().maxCoeff(&axis);
    std::ranges::sort(vertices, {}, [&](int v) { return std::pair(mesh_.position(v)[axis], v); });
    visit(vertices.first(vertices.size() / 2), visit_group);
    visit(vertices.subspan(vertices.size() / 2), visit_group);
  }

  // The vertex nearest to the middle, then each time the one farthest from those chosen; normals
  // count like places, relative to the size of the group.
  std::vector<int> records(std::span<const int> group, int count) const {
    Eigen::AlignedBox3d box;
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    for (const int v : group) {
      box.extend(mesh_.position(v));
      normal += mesh_.vertex_normal[v];
    }
    normal /= static_cast<double>(group.size());
    const double size2 = std::max(box.diagonal().squaredNorm(), 1e-30);
    const auto apart = [&](int v, const Eigen::Vector3d& at, const Eigen::Vector3d& n) {
      return (mesh_.position(v) - at).squaredNorm() / size2 +
             (mesh_.vertex_normal[v] - n).squaredNorm();
    };
    const Eigen::Vector3d middle = box.center();
    std::vector<int> chosen{*std::ranges::min_element(
        group, {}, [&](int v) { return std::pair(apart(v, middle, normal), v); })};
    std::vector<double> nearest(group.size(), std::numeric_limits<double>::infinity());
    while (static_cast<int>(chosen.size()) < count) {
      const int last = chosen.back();
      std::size_t farthest = 0;
      for (std::size_t i = 0; i < group.size(); ++i) {
        const double to_last = apart(group[i], mesh_.position(last), mesh_.vertex_normal[last]);
        nearest[i] = group[i] == last ? -1.0 : std::min(nearest[i], to_last);
        if (nearest[i] > nearest[farthest]) farthest = i;
      }
      chosen.push_back(group[farthest]);
    }
    return chosen;
  }

 private:
  const PatchMesh& mesh_;
  std::size_t most_;
};

void share(const VertexGroups& groups, std::span<int> vertices, bool is_read,
           std::vector<InterpolatedVertex>& entries) {
  groups.visit(vertices, [&](std::span<int> group) {
    const std::vector<int> records =
        groups.records(group, is_read && group.size() >= fewest_of_four ? 4 : 2);
    InterpolatedVertex entry;
    std::ranges::copy(records, entry.ends.begin());
    std::ranges::sort(group);
    for (const int v : group) {
      if (std::ranges::find(records, v) != records.end()) continue;
      entry.vertex = v;
      entries.push_back(entry);
    }
  });
}

}  // namespace

std::vector<char> unread_patches(const Scene& scene, const PatchMesh& mesh) {
  std::vector<char> unread(static_cast<std::size_t>(mesh.patch_count()), 0);
  for (int p = 0; p < mesh.patch_count(); ++p) {
    const Material& material = scene.materials[static_cast<std::size_t>(mesh.material[p])];
    const bool is_diffuse = material.is_diffuse() || material.is_emitter() || scatters(mesh, p) ||
                            (mesh.emission.row(p) > 0.0f).any();
    unread[static_cast<std::size_t>(p)] = material.is_specular() && !is_diffuse ? 1 : 0;
  }
  return unread;
}

std::vector<char> crumb_patches(const PatchMesh& mesh) {
  const std::vector<double> areas = vertex_areas(mesh);
  const double largest = largest_share * typical_area(areas);
  const std::vector<int> patch = vertex_patches(mesh);
  Eigen::ArrayXd area = Eigen::ArrayXd::Zero(mesh.patch_count()), count = area;
  for (std::size_t v = 0; v < areas.size(); ++v) {
    area[patch[v]] += areas[v];
    count[patch[v]] += 1.0;
  }
  std::vector<char> crumbs(static_cast<std::size_t>(mesh.patch_count()), 0);
  for (int p = 0; p < mesh.patch_count(); ++p) {
    crumbs[static_cast<std::size_t>(p)] = area[p] < largest * count[p] ? 1 : 0;
  }
  return crumbs;
}

SharedGathers find_shared_gathers(const Scene& scene, const PatchMesh& mesh) {
  const std::vector<char> crumbs = crumb_patches(mesh), unread = unread_patches(scene, mesh);
  const std::vector<int> patch = vertex_patches(mesh);
  std::vector<std::vector<int>> vertices(static_cast<std::size_t>(mesh.patch_count()));
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (crumbs[patch[v]] != 0) vertices[patch[v]].push_back(v);
  }
  const VertexGroups of_read(mesh, group_of_read), of_unread(mesh, group_of_unread);
  SharedGathers shared;
  for (std::size_t p = 0; p < vertices.size(); ++p) {
    if (unread[p] == 0 && vertices[p].size() >= fewest_read) {
      share(of_read, vertices[p], true, shared.read);
    }
    if (unread[p] == 0) continue;
    shared.rough.insert(shared.rough.end(), vertices[p].begin(), vertices[p].end());
    if (vertices[p].size() < fewest_unread) continue;
    share(of_unread, vertices[p], false, shared.unread);
  }
  std::vector<char> shares(static_cast<std::size_t>(mesh.vertex_count()), 0);
  for (const InterpolatedVertex& at : shared.unread) shares[at.vertex] = 1;
  std::erase_if(shared.rough, [&](int v) { return shares[v] != 0; });
  return shared;
}

void add_record_errors(const PatchMesh& mesh, std::span<const InterpolatedVertex> unread,
                       const BandArray& irradiance, const SceneParts& parts,
                       Eigen::ArrayXf& error) {
  if (unread.empty()) return;
  std::vector<float> square(static_cast<std::size_t>(mesh.vertex_count()), 0.0f);
  for (const InterpolatedVertex& entry : unread) {
    const auto [a, b, none, other] = entry.ends;
    const float found = 0.75f * (irradiance.row(a) - irradiance.row(b)).square().mean();
    for (const int v : {entry.vertex, a, b}) square[static_cast<std::size_t>(v)] = found;
  }
  const Eigen::ArrayXd reference = error_references(mesh, irradiance, parts);
  for (int e = 0; e < mesh.element_count(); ++e) {
    float largest = 0.0f;
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      largest = std::max(largest, square[static_cast<std::size_t>(mesh.corners[e][c])]);
    }
    if (!(largest > 0.0f) || !(reference[e] > 0.0)) continue;
    error[e] = std::max(error[e], static_cast<float>(std::sqrt(double{largest}) / reference[e]));
  }
}

}  // namespace lightwell
