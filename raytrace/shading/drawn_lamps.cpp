#include "raytrace/shading/drawn_lamps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "scene/parallel.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

constexpr int rays_per_face = 64;

/// Free length, m, behind a lamp's opening along `way`, up to `length`.
double free_way(const ElementCaster& caster, const Lamp& lamp, const Eigen::Vector3d& way,
                double length) {
  // Rays begin in front of a ceiling in whose plane the opening may lie, and end before it.
  constexpr double before = 0.002;
  const Ray ray{
      .origin = lamp.position - before * way, .direction = way, .t_max = length + 2.0 * before};
  ElementHit hit;
  caster.closest_elements({&ray, 1}, {&hit, 1});
  return hit.facet < 0 ? length : std::max(0.0, hit.t - 2.0 * before);
}

BodyEnds visible_ends(const ElementCaster& caster, const Lamp& lamp) {
  BodyEnds ends = body_ends(lamp);
  ends.low = -free_way(caster, lamp, lamp.aim(), -ends.low);
  ends.high = free_way(caster, lamp, -lamp.aim(), ends.high);
  return ends;
}

std::vector<ElementHit> hits_from(const ElementCaster& caster,
                                  const std::vector<Eigen::Vector3d>& outline, std::uint64_t face) {
  static const SobolPoints sobol(rays_per_face);
  const Eigen::Vector3d& corner = outline.front();
  const Eigen::Vector3d normal = (outline[1] - corner).cross(outline[2] - corner).normalized();
  Eigen::Vector3d a, b;
  tangent_frame(normal, a, b);
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : outline) middle += p / static_cast<double>(outline.size());
  std::array<Ray, rays_per_face> rays;
  for (int r = 0; r < rays_per_face; ++r) {
    const Eigen::Array4f u = sobol.point(r, random_key(face, RandomPurpose::lamp_face_rays));
    // A point between the middle and the outline.
    const double place = static_cast<double>(u[0]) * static_cast<double>(outline.size());
    const auto side = std::min(static_cast<std::size_t>(place), outline.size() - 1);
    const Eigen::Vector3d on_rim =
        outline[side] + (place - static_cast<double>(side)) *
                            (outline[(side + 1) % outline.size()] - outline[side]);
    const Eigen::Vector3d way = cosine_direction(u[2], u[3]);
    rays[static_cast<std::size_t>(r)] = {
        .origin = middle + std::sqrt(static_cast<double>(u[1])) * (on_rim - middle),
        .direction = way.x() * a + way.y() * b + way.z() * normal};
  }
  std::vector<ElementHit> hits(rays_per_face);
  caster.closest_hits(rays, hits);
  std::erase_if(hits, [](const ElementHit& hit) { return hit.element < 0; });
  return hits;
}

}  // namespace

DrawnLamps::DrawnLamps(const Scene& scene, const ElementCaster& caster) {
  for (std::size_t i = 0; i < scene.lamps.size(); ++i) {
    const Lamp& lamp = scene.lamps[i];
    for (LampFace& face : lamp_faces(lamp, visible_ends(caster, lamp))) {
      Face drawn{.lamp = static_cast<int>(i), .shines = face.shine > 0.0, .place = face.place};
      if (drawn.shines) {
        drawn.emitted = lamp.intensity * static_cast<float>(face.shine);
      }
      drawn.outline = std::move(face.outline);
      faces_.push_back(std::move(drawn));
    }
  }
  parallel_for(static_cast<int>(faces_.size()), 8, [&](int begin, int end) {
    for (auto f = static_cast<std::size_t>(begin); f < static_cast<std::size_t>(end); ++f) {
      if (!faces_[f].shines) faces_[f].seen = hits_from(caster, faces_[f].outline, f);
    }
  });
}

BandArray DrawnLamps::radiance(const PatchMesh& mesh, const BandArray& vertex_radiance,
                               const BandArray& source_scale) const {
  BandArray L = BandArray::Zero(static_cast<Eigen::Index>(faces_.size()), vertex_radiance.cols());
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const Face& face = faces_[f];
    auto row = L.row(static_cast<Eigen::Index>(f));
    if (face.shines) {
      row = face.emitted.transpose();
      if (source_scale.size() > 0) row *= source_scale.row(face.lamp);
      continue;
    }
    // Rays are spread as the cosine, so that E is pi times the mean radiance.
    for (const ElementHit& hit : face.seen) {
      row += interpolate(mesh, vertex_radiance, hit).transpose();
    }
    row *= body_reflectance / rays_per_face;
  }
  return L;
}

}  // namespace lightwell
