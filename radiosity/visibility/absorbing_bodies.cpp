#include "radiosity/visibility/absorbing_bodies.h"

#include <Eigen/Geometry>

#include <optional>

#include "scene/io/placed_mesh.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

bool absorbs(const Material& material) {
  return material.dielectric && !material.dielectric->thin &&
         (material.dielectric->absorption > 0.0f).any();
}

// Six times the volume within a closed mesh whose facets face outwards, m^3; below 0 if they face
// inwards.
double volume6(const PolygonMesh& mesh) {
  double sum = 0.0;
  for (const Facet& facet : mesh.facets) {
    const auto corner = [&](std::size_t i) -> const Eigen::Vector3d& {
      return mesh.vertices[static_cast<std::size_t>(facet.boundary[i])];
    };
    for (std::size_t i = 2; i < facet.boundary.size(); ++i) {
      sum += corner(0).dot(corner(i - 1).cross(corner(i)));
    }
  }
  return sum;
}

bool is_whole_body(const Surface& surface) {
  if (surface.motion >= 0) return false;
  if (std::holds_alternative<Sphere>(surface.shape)) return true;
  const auto* mesh = std::get_if<PolygonMesh>(&surface.shape);
  if (!mesh || !is_closed(*mesh)) return false;
  const auto has_no_holes = [](const Facet& facet) { return facet.holes.empty(); };
  return std::ranges::all_of(mesh->facets, has_no_holes) && volume6(*mesh) > 0.0;
}

// A box that all absorbing bodies lie in; nothing if one of them moves, or is not closed, such as
// the water of a pool.
std::optional<Eigen::AlignedBox3d> box_around_bodies(const Scene& scene) {
  Eigen::AlignedBox3d box;
  for (const Surface& surface : scene.surfaces) {
    if (!absorbs(scene.materials[static_cast<std::size_t>(surface.material)])) continue;
    if (!is_whole_body(surface)) return std::nullopt;
    if (const auto* sphere = std::get_if<Sphere>(&surface.shape)) {
      const Eigen::Vector3d reach = Eigen::Vector3d::Constant(sphere->radius);
      box.extend(sphere->center - reach);
      box.extend(sphere->center + reach);
    } else {
      for (const auto& vertex : std::get<PolygonMesh>(surface.shape).vertices) box.extend(vertex);
    }
  }
  return box;
}

// True if a patch may reach into the box. Round patches bulge beyond their corners by less than
// their own size.
bool reaches_into(const Eigen::AlignedBox3d& box, const PatchMesh& mesh, int patch) {
  Eigen::AlignedBox3d around;
  for (int e = mesh.first_element[patch]; e < mesh.first_element[patch + 1]; ++e) {
    for (int c = 0; c < mesh.corner_count(e); ++c) around.extend(mesh.position(mesh.corners[e][c]));
  }
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(around.diagonal().norm());
  return box.intersects(Eigen::AlignedBox3d(around.min() - margin, around.max() + margin));
}

}  // namespace

AbsorbingBodies::AbsorbingBodies(const Scene& scene, const ElementCaster& caster)
    : walks_(scene), box_(box_around_bodies(scene)), round_(scene) {
  for (const Material& material : scene.materials) {
    const bool is_body = material.dielectric && !material.dielectric->thin;
    absorption_.push_back(is_body ? material.dielectric->absorption
                                  : Spectrum(Spectrum::Zero(scene.bands.count())));
  }
  for (const FacetRef& ref : scene_facets(scene)) {
    const auto* polygons = std::get_if<PolygonMesh>(&scene.surfaces[ref.surface].shape);
    normal_.push_back(polygons ? facet_normal(*polygons, polygons->facets[ref.facet])
                               : Eigen::Vector3d::Zero());
  }
  const PatchMesh& mesh = caster.mesh();
  of_patch_.assign(static_cast<std::size_t>(mesh.patch_count()), -1);
  constexpr int grain = 64;
  parallel_for(mesh.patch_count(), grain, [&](int begin, int end) {
    for (int p = begin; p < end; ++p) {
      // Media know the body behind its own surface.
      const int facet = mesh.facet[mesh.first_element[p]];
      const bool is_within_own = mesh.is_back[p] != 0 && walks_.body_of(facet) >= 0;
      // A piece of tinted glass on a table needs no walks all over the room.
      if (is_within_own || (box_ && !reaches_into(*box_, mesh, p))) continue;
      const int body = walks_.before(caster, p).body;
      of_patch_[static_cast<std::size_t>(p)] = coefficient(body) ? body : -1;
    }
  });
  of_facet_.assign(normal_.size(), {not_given, not_given});
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto p = static_cast<std::size_t>(mesh.patch[e]);
    note(mesh.facet[e], mesh.is_back[p] != 0, of_patch_[p]);
  }
}

void AbsorbingBodies::note(int facet, bool is_back, int body) {
  int& known = of_facet_[static_cast<std::size_t>(facet)][is_back ? 1 : 0];
  if (known == not_given) known = body;
  if (known != body) known = by_place;
}

std::shared_ptr<const AbsorbingBodies> AbsorbingBodies::find(const Scene& scene,
                                                             const ElementCaster& caster) {
  if (!MediumWalks(scene).absorbs()) return nullptr;
  const std::shared_ptr<const AbsorbingBodies> found(new AbsorbingBodies(scene, caster));
  for (int p = 0; p < caster.mesh().patch_count(); ++p) {
    if (found->before_patch(p)) return found;
  }
  return nullptr;
}

const Spectrum* AbsorbingBodies::before(const PatchMesh& mesh, const ElementHit& hit) const {
  if (hit.facet < 0 || (hit.from_back && walks_.body_of(hit.facet) >= 0)) return nullptr;
  if (hit.element >= 0) return before_patch(mesh.patch[hit.element]);
  // A pane within a body has the same body on both sides.
  const auto& sides = of_facet_[static_cast<std::size_t>(hit.facet)];
  const int body = sides[hit.from_back ? 1 : 0];
  return coefficient(body == not_given ? sides[0] : body);
}

const Spectrum* AbsorbingBodies::around(const ElementCaster& caster, const SurfacePoint& at) const {
  if (at.facet < 0) return walked(caster, at);
  const bool behind = is_behind(caster, at);
  const int own = walks_.body_of(at.facet);
  if (behind && own >= 0) return coefficient(own);
  const int body = of_facet_[static_cast<std::size_t>(at.facet)][behind ? 1 : 0];
  if (body > by_place) return coefficient(body);
  return walked(caster, at);
}

const Spectrum* AbsorbingBodies::walked(const ElementCaster& caster, const SurfacePoint& at) const {
  if (box_ && !box_->contains(at.position)) return nullptr;
  return coefficient(walks_.around(caster, at).body);
}

bool AbsorbingBodies::is_behind(const ElementCaster& caster, const SurfacePoint& at) const {
  const Eigen::Isometry3d* pose = caster.pose_of(at.facet);
  const RoundShape* shape = round_.of(at.facet);
  Eigen::Vector3d normal = normal_[static_cast<std::size_t>(at.facet)];
  if (shape) normal = front_normal(*shape, pose ? pose->inverse() * at.position : at.position);
  if (pose) normal = pose->linear() * normal;
  return normal.dot(at.normal) < 0.0;
}

}  // namespace lightwell
