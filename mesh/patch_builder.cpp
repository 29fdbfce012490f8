#include "mesh/patch_builder.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>

#include "mesh/facets/reflex_corners.h"
#include "mesh/patches/parted_topology.h"
#include "mesh/patches/translucency.h"

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

std::array<int, 4> turned_corners(const std::array<int, 4>& c) {
  return c[3] < 0 ? std::array<int, 4>{c[0], c[2], c[1], -1}
                  : std::array<int, 4>{c[0], c[3], c[2], c[1]};
}

}  // namespace

void PatchBuilder::add_piece(Piece piece) {
  piece.first_vertex = shared_.add(piece.mesh.position.size());
  pieces_.push_back(std::move(piece));
}

void PatchBuilder::add_facet(const FacetPlane& plane, double patch_size, FacetMesh mesh) {
  Piece piece{.facet = plane.facet,
              .surface = plane.surface,
              .normal = plane.normal,
              .patch_size = patch_size,
              .mesh = std::move(mesh)};
  if (!plane.normal.isZero()) piece.at_reflex_corner = split_reflex_corners(piece.mesh);
  add_piece(std::move(piece));
}

void PatchBuilder::add_round(int facet, int surface, double patch_size, const RoundShape& shape,
                             RoundElements elements) {
  add_piece({.facet = facet,
             .surface = surface,
             .patch_size = patch_size,
             .mesh = {.position = std::move(elements.position),
                      .corners = std::move(elements.corners),
                      .first_element = std::move(elements.first_element)}});
  pieces_.back().round = static_cast<int>(grids_.size());
  grids_.push_back({.facet = facet,
                    .shape = shape,
                    .rings = elements.rings,
                    .sectors = elements.sectors,
                    .element = std::move(elements.element)});
  round_area_.push_back(std::move(elements.area));
}

// The border edges of all pieces, sorted by their points: sides that meet at an edge are
// consecutive.
std::vector<PatchBuilder::Side> PatchBuilder::border_sides() const {
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
  return sides;
}

namespace {

// Calls visit(one, other) for each edge at which two facets of one surface meet and no third facet
// stands.
template <class Sides, class Pieces, class Visit>
void for_each_joint(const Sides& sides, const Pieces& pieces, Visit&& visit) {
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t j = i + 1;
    while (j < sides.size() && sides[j].low == sides[i].low && sides[j].high == sides[i].high) ++j;
    if (j - i == 2) {
      const auto &a = sides[i], &b = sides[i + 1];
      if (a.piece != b.piece && pieces[a.piece].surface == pieces[b.piece].surface &&
          a.forward != b.forward) {
        visit(a, b);
      }
    }
    i = j;
  }
}

}  // namespace

// The normal at a piece's vertex of the smooth surface for which the piece stands.
Vector3d PatchBuilder::normal_at(int piece, int vertex) const {
  const Piece& p = pieces_[piece];
  return normals_.at(p.facet, p.mesh.position[vertex - p.first_vertex], p.normal);
}

// Shares vertices across smooth joints, where radiosity is continuous. A joint is smooth by the
// normals of its facets, or by the normals at vertices where the surface has such.
void PatchBuilder::share_smooth_edges(const std::vector<Side>& sides) {
  constexpr double rounding = 1e-12;  // coplanar facets share even at a limit of 0 degrees
  const double least_cosine = std::cos(smooth_angle_degrees_ * std::numbers::pi / 180.0) - rounding;
  for_each_joint(sides, pieces_, [&](const Side& a, const Side& b) {
    const std::array<std::pair<int, int>, 2> ends = {{{a.v_low, b.v_low}, {a.v_high, b.v_high}}};
    const bool is_smooth = std::ranges::all_of(ends, [&](const auto& end) {
      return normal_at(a.piece, end.first).dot(normal_at(b.piece, end.second)) >= least_cosine;
    });
    if (!is_smooth) return;
    for (const auto& [one, other] : ends) shared_.join(one, other);
  });
}

FacetPatch PatchBuilder::facet_patch(const Part& part) const {
  const Piece& piece = pieces_[part.piece];
  const Material& material = scene_.materials[scene_.surfaces[piece.surface].material];
  // Patches of emitters stay within a facet, because the closed forms of their light are for one
  // facet.
  FacetPatch patch{.surface = piece.surface,
                   .may_join = piece.round < 0 && !material.is_emitter(),
                   .facet = part.piece,
                   .normal = piece.normal};
  for (int e = piece.mesh.first_element[part.patch]; e < piece.mesh.first_element[part.patch + 1];
       ++e) {
    const auto& c = piece.mesh.corners[e];
    patch.area += polygon_area(piece.mesh, c);
    for (int i = 0; i < (c[3] < 0 ? 3 : 4); ++i) patch.box.extend(piece.mesh.position[c[i]]);
  }
  return patch;
}

std::vector<FacetPatchContact> PatchBuilder::part_contacts(const std::vector<int>& first_part,
                                                           const std::vector<Side>& sides) const {
  std::vector<FacetPatchContact> contacts;
  // A facet of many patches: the two vertices of an edge identify the patch that has the edge.
  std::vector<std::pair<std::uint64_t, int>> part_at;
  const auto key = [](int from, int to) {
    return (static_cast<std::uint64_t>(from) << 32) | static_cast<std::uint64_t>(to);
  };
  for (int p = 0; p < static_cast<int>(pieces_.size()); ++p) {
    const FacetMesh& mesh = pieces_[p].mesh;
    for (int i = 0; i < mesh.patch_count() && mesh.patch_count() > 1; ++i) {
      for (int e = mesh.first_element[i]; e < mesh.first_element[i + 1]; ++e) {
        const int n = mesh.corners[e][3] < 0 ? 3 : 4, first = pieces_[p].first_vertex;
        for (int c = 0; c < n; ++c) {
          part_at.emplace_back(
              key(first + mesh.corners[e][c], first + mesh.corners[e][(c + 1) % n]),
              first_part[p] + i);
        }
      }
    }
  }
  std::sort(part_at.begin(), part_at.end());
  const auto part_of = [&](const Side& side) {
    if (pieces_[side.piece].mesh.patch_count() == 1) return first_part[side.piece];
    const std::uint64_t edge =
        side.forward ? key(side.v_low, side.v_high) : key(side.v_high, side.v_low);
    const auto behind =
        std::ranges::upper_bound(part_at, edge, {}, &std::pair<std::uint64_t, int>::first);
    return behind == part_at.begin() || (behind - 1)->first != edge ? -1 : (behind - 1)->second;
  };
  for_each_joint(sides, pieces_, [&](const Side& a, const Side& b) {
    const int one = part_of(a), other = part_of(b);
    if (one >= 0 && other >= 0) contacts.push_back({one, other});
  });
  return contacts;
}

std::vector<int> PatchBuilder::groups_of(const std::vector<Part>& parts,
                                         const std::vector<int>& first_part,
                                         const std::vector<Side>& sides) const {
  std::vector<int> group(parts.size());
  std::iota(group.begin(), group.end(), 0);
  if (!(curve_angle_degrees_ > 0.0)) return group;
  std::map<double, std::vector<int>> of_size;  // parts by patch size
  for (int i = 0; i < static_cast<int>(parts.size()); ++i) {
    of_size[pieces_[parts[i].piece].patch_size].push_back(i);
  }
  const std::vector<FacetPatchContact> contacts = part_contacts(first_part, sides);
  for (const auto& [size, members] : of_size) {
    std::vector<int> place(parts.size(), -1);
    std::vector<FacetPatch> patches;
    for (const int i : members) {
      place[i] = static_cast<int>(patches.size());
      patches.push_back(facet_patch(parts[i]));
    }
    std::vector<FacetPatchContact> within;
    for (const auto& [one, other] : contacts) {
      if (place[one] >= 0 && place[other] >= 0) within.push_back({place[one], place[other]});
    }
    const std::vector<int> joined =
        group_facets(patches, within, {.patch_size = size, .angle_degrees = curve_angle_degrees_});
    for (std::size_t k = 0; k < members.size(); ++k) group[members[k]] = members[joined[k]];
  }
  return group;
}

std::vector<std::vector<std::vector<PatchBuilder::Part>>> PatchBuilder::patches_of_pieces(
    const std::vector<Side>& sides) const {
  std::vector<Part> parts;
  std::vector<int> first_part;
  for (int p = 0; p < static_cast<int>(pieces_.size()); ++p) {
    first_part.push_back(static_cast<int>(parts.size()));
    for (int i = 0; i < pieces_[p].mesh.patch_count(); ++i) parts.push_back({p, i});
  }
  const std::vector<int> group = groups_of(parts, first_part, sides);
  std::vector<std::vector<std::vector<Part>>> of_piece(pieces_.size());
  std::vector<int> place(parts.size(), -1);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    auto& patches = of_piece[parts[group[i]].piece];
    int& at = place[group[i]];
    if (at < 0) {
      at = static_cast<int>(patches.size());
      patches.emplace_back();
    }
    patches[at].push_back(parts[i]);
  }
  return of_piece;
}

bool PatchBuilder::has_back(const Material& material) const {
  if (material.dielectric) return false;
  return !material.one_sided || (material.emits_both_sides && material.is_emitter());
}

void PatchBuilder::emit_patch(const std::vector<Part>& parts, bool is_back,
                              std::vector<int>& number, PatchMesh& out,
                              std::vector<Vector3d>& positions) {
  const int patch = static_cast<int>(patch_area_.size());
  out.first_element.push_back(static_cast<int>(out.patch.size()));
  double area = 0.0;
  for (const auto& [p, i] : parts) {
    const Piece& piece = pieces_[p];
    const auto vertex = [&](int local) {
      int& n = number[shared_.root(piece.first_vertex + local)];
      if (n < 0) {
        n = static_cast<int>(positions.size());
        positions.push_back(piece.mesh.position[local]);
        out.at_reflex_corner.push_back(0);
      }
      if (!piece.at_reflex_corner.empty() && piece.at_reflex_corner[local]) {
        out.at_reflex_corner[n] = 1;
      }
      return n;
    };
    for (int e = piece.mesh.first_element[i]; e < piece.mesh.first_element[i + 1]; ++e) {
      std::array<int, 4> c = piece.mesh.corners[e];
      for (int& corner : c) corner = corner < 0 ? -1 : vertex(corner);
      out.patch.push_back(patch);
      out.facet.push_back(piece.facet);
      out.corners.push_back(is_back ? turned_corners(c) : c);
      element_area_.push_back(piece.round >= 0 ? round_area_[piece.round][e]
                                               : polygon_area(piece.mesh, piece.mesh.corners[e]));
      area += element_area_.back();
    }
  }
  patch_area_.push_back(area);
  const int surface = pieces_[parts.front().piece].surface;
  out.surface.push_back(surface);
  out.material.push_back(scene_.surfaces[surface].material);
  out.is_back.push_back(is_back ? 1 : 0);
}

PatchMesh PatchBuilder::finish() {
  std::vector<Side> sides = border_sides();
  share_smooth_edges(sides);
  const auto patches = patches_of_pieces(sides);
  sides = {};
  PatchMesh out;
  std::vector<Vector3d> positions;
  std::vector<int> front(shared_.size(), -1), back(shared_.size(), -1);
  for (std::size_t p = 0; p < pieces_.size(); ++p) {
    const Piece& piece = pieces_[p];
    const Material& material = scene_.materials[scene_.surfaces[piece.surface].material];
    const int first = static_cast<int>(out.patch.size());
    for (const auto& parts : patches[p]) emit_patch(parts, false, front, out, positions);
    const int count = static_cast<int>(out.patch.size()) - first;
    const bool two_sides = has_back(material);
    for (const auto& parts : patches[p]) {
      if (two_sides) emit_patch(parts, true, back, out, positions);
    }
    for (int side = 0; side < (two_sides ? 2 : 1); ++side) {
      for (int e = 0; e < count; ++e) {
        out.twin.push_back(two_sides ? first + e + (side == 0 ? count : 0) : -1);
      }
    }
    if (piece.round >= 0) {
      for (int& e : grids_[piece.round].element) e += first;
    }
  }
  pieces_.clear();
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
  set_transmittance(scene_, out);
  out.round_grids = std::move(grids_);
  build_parted_topology(out, positions);
  return out;
}

}  // namespace lightwell
