#include "mesh/patch_builder.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>

namespace lightwell {
namespace {

using Eigen::Vector3d;

double polygon_area(const FacetMesh& mesh, const std::array<int, 4>& c) {
  const Vector3d& a = mesh.position[c[0]];
  Vector3d sum = Vector3d::Zero();
  for (int i = 1; i < (c[3] < 0 ? 2 : 3); ++i) {
    sum += (mesh.position[c[i]] - a).cross(mesh.position[c[i + 1]] - a);
  }
  return 0.5 * sum.norm();
}

std::array<int, 4> turned(const std::array<int, 4>& c) {
  return c[3] < 0 ? std::array<int, 4>{c[0], c[2], c[1], -1}
                  : std::array<int, 4>{c[0], c[3], c[2], c[1]};
}

double corner_angle(const FacetMesh& mesh, const std::array<int, 4>& c, int corner) {
  const int count = c[3] < 0 ? 3 : 4;
  const Vector3d& at = mesh.position[c[corner]];
  const Vector3d a = mesh.position[c[(corner + 1) % count]] - at;
  const Vector3d b = mesh.position[c[(corner + count - 1) % count]] - at;
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

// At a reflex corner, the foot of a block or the inner corner of an L-shaped room, what a point
// sees depends on the direction in which the corner is approached: one side may be lit and the
// other in the block's shadow. No one value is right for all, so each element there gets a vertex
// of its own.
void split_reflex_corners(FacetMesh& mesh) {
  // Between straight on (180 degrees) and inside (360), with room for cells that are not quite
  // flat.
  constexpr double least = 200.0 * std::numbers::pi / 180.0;
  constexpr double most = 350.0 * std::numbers::pi / 180.0;
  std::vector<double> angle(mesh.position.size(), 0.0);
  for (const auto& c : mesh.corners) {
    for (int i = 0; i < (c[3] < 0 ? 3 : 4); ++i) angle[c[i]] += corner_angle(mesh, c, i);
  }
  std::vector<char> taken(mesh.position.size(), 0);
  for (auto& c : mesh.corners) {
    for (int i = 0; i < (c[3] < 0 ? 3 : 4); ++i) {
      const int v = c[i];
      if (v >= static_cast<int>(angle.size()) || !(angle[v] > least && angle[v] < most)) continue;
      if (taken[v]) {
        c[i] = static_cast<int>(mesh.position.size());
        mesh.position.push_back(Vector3d(mesh.position[v]));
      }
      taken[v] = 1;
    }
  }
}

}  // namespace

void PatchBuilder::add_facet(int facet, int surface, const Vector3d& normal, FacetMesh mesh) {
  const bool is_flat = !normal.isZero();
  if (is_flat) split_reflex_corners(mesh);
  const int first = static_cast<int>(parent_.size());
  parent_.resize(parent_.size() + mesh.position.size());
  std::iota(parent_.begin() + first, parent_.end(), first);
  pieces_.push_back({.facet = facet,
                     .surface = surface,
                     .first_vertex = first,
                     .normal = normal,
                     .mesh = std::move(mesh)});
}

void PatchBuilder::add_sphere(int facet, int surface, const Sphere& sphere,
                              SphereElements elements) {
  FacetMesh mesh{.position = std::move(elements.position),
                 .corners = std::move(elements.corners),
                 .first_element = std::move(elements.first_element)};
  add_facet(facet, surface, Vector3d::Zero(), std::move(mesh));
  pieces_.back().sphere = static_cast<int>(grids_.size());
  grids_.push_back({.facet = facet,
                    .sphere = sphere,
                    .rings = elements.rings,
                    .sectors = elements.sectors,
                    .element = std::move(elements.element)});
  sphere_area_.push_back(std::move(elements.area));
}

int PatchBuilder::root(int vertex) {
  while (parent_[vertex] != vertex) vertex = parent_[vertex] = parent_[parent_[vertex]];
  return vertex;
}

// Exactly two elements of different facets at an edge, and nothing else: no third facet stands
// there, so radiosity is continuous across it if the surface is smooth.
void PatchBuilder::share_smooth_edges() {
  struct Side {
    int low, high;      // points
    int v_low, v_high;  // vertices there
    int piece;
    bool forward;
  };
  std::vector<Side> sides;
  for (int p = 0; p < static_cast<int>(pieces_.size()); ++p) {
    const int first = pieces_[p].first_vertex;
    for (const auto& [vertex, point] : pieces_[p].mesh.border) {
      if (point[0] < 0 || point[1] < 0) continue;
      const int low = point[0] < point[1] ? 0 : 1;
      sides.push_back(
          {point[low], point[1 - low], first + vertex[low], first + vertex[1 - low], p, low == 0});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.v_low) < std::tie(b.low, b.high, b.v_low);
  });
  constexpr double rounding = 1e-12;  // coplanar facets share even at a limit of 0 degrees
  const double least_cosine = std::cos(smooth_angle_degrees_ * std::numbers::pi / 180.0) - rounding;
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t j = i + 1;
    while (j < sides.size() && sides[j].low == sides[i].low && sides[j].high == sides[i].high) ++j;
    if (j - i == 2) {
      const Side &a = sides[i], &b = sides[i + 1];
      const Piece &pa = pieces_[a.piece], &pb = pieces_[b.piece];
      if (a.piece != b.piece && pa.surface == pb.surface && a.forward != b.forward &&
          pa.normal.dot(pb.normal) >= least_cosine) {
        for (const auto& [one, other] : {std::pair(a.v_low, b.v_low), {a.v_high, b.v_high}}) {
          const int r = root(one), s = root(other);
          parent_[std::max(r, s)] = std::min(r, s);
        }
      }
    }
    i = j;
  }
}

bool PatchBuilder::has_back(const Material& material) const {
  if (material.dielectric) return false;
  return !material.one_sided || (material.emits_both_sides && material.is_emitter());
}

void PatchBuilder::emit_side(const Piece& piece, bool is_back, std::vector<int>& number,
                             PatchMesh& out, std::vector<Vector3d>& positions) {
  const auto vertex = [&](int local) {
    int& n = number[root(piece.first_vertex + local)];
    if (n < 0) {
      n = static_cast<int>(positions.size());
      positions.push_back(piece.mesh.position[local]);
    }
    return n;
  };
  for (int p = 0; p < piece.mesh.patch_count(); ++p) {
    const int patch = static_cast<int>(patch_area_.size());
    out.first_element.push_back(static_cast<int>(out.patch.size()));
    double area = 0.0;
    for (int e = piece.mesh.first_element[p]; e < piece.mesh.first_element[p + 1]; ++e) {
      std::array<int, 4> c = piece.mesh.corners[e];
      for (int& corner : c) corner = corner < 0 ? -1 : vertex(corner);
      out.patch.push_back(patch);
      out.facet.push_back(piece.facet);
      out.corners.push_back(is_back ? turned(c) : c);
      element_area_.push_back(piece.sphere >= 0 ? sphere_area_[piece.sphere][e]
                                                : polygon_area(piece.mesh, piece.mesh.corners[e]));
      area += element_area_.back();
    }
    patch_area_.push_back(area);
    out.surface.push_back(piece.surface);
    out.material.push_back(scene_.surfaces[piece.surface].material);
    out.is_back.push_back(is_back ? 1 : 0);
  }
}

PatchMesh PatchBuilder::finish() {
  share_smooth_edges();
  PatchMesh out;
  std::vector<Vector3d> positions;
  std::vector<int> front(parent_.size(), -1), back(parent_.size(), -1);
  for (Piece& piece : pieces_) {
    const Material& material = scene_.materials[scene_.surfaces[piece.surface].material];
    const int first = static_cast<int>(out.patch.size());
    emit_side(piece, false, front, out, positions);
    const int count = static_cast<int>(out.patch.size()) - first;
    const bool two_sides = has_back(material);
    if (two_sides) emit_side(piece, true, back, out, positions);
    for (int side = 0; side < (two_sides ? 2 : 1); ++side) {
      for (int e = 0; e < count; ++e) {
        out.twin.push_back(two_sides ? first + e + (side == 0 ? count : 0) : -1);
      }
    }
    if (piece.sphere >= 0) {
      for (int& e : grids_[piece.sphere].element) e += first;
    }
    piece.mesh = {};
  }
  const int patch_count = static_cast<int>(patch_area_.size());
  out.first_element.push_back(static_cast<int>(out.patch.size()));
  out.element_area = Eigen::Map<Eigen::ArrayXd>(element_area_.data(),
                                                static_cast<Eigen::Index>(element_area_.size()));
  out.area = Eigen::Map<Eigen::ArrayXd>(patch_area_.data(), patch_count);
  out.reflectance.resize(patch_count, scene_.bands.count());
  out.emission.setZero(patch_count, scene_.bands.count());
  for (int p = 0; p < patch_count; ++p) {
    const Material& m = scene_.materials[out.material[p]];
    const bool is_back = out.is_back[p] != 0;
    if (is_back && m.one_sided) {
      out.reflectance.row(p).setZero();
    } else {
      out.reflectance.row(p) = m.reflectance.transpose();
    }
    if (!is_back || m.emits_both_sides) out.emission.row(p) = m.emission.transpose();
  }
  out.sphere_grids = std::move(grids_);
  build_topology(out, positions);
  return out;
}

}  // namespace lightwell
