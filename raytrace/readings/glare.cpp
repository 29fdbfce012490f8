#include "raytrace/readings/glare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <span>
#include <utility>

#include "mesh/patches/patch_textures.h"
#include "mesh/patches/pictured_emission.h"
#include "mesh/patches/translucency.h"
#include "radiosity/emitters/free_source.h"
#include "raytrace/readings/specular_light.h"
#include "scene/lamp_faces.h"

namespace lightwell {
namespace {

using std::numbers::pi;

/// A piece of a source is represented by its middle if its distance is at least this many times its
/// length. The error of the piece's solid angle is then at most 1e-3.
constexpr double far_enough = 16.0;
constexpr int most_halvings = 8;
/// Sample points of an opening along each axis.
constexpr int opening_grid = 8;

/// Sums over the visible parts of each luminaire.
class GlareSum {
 public:
  GlareSum(const Camera& eye, const ElementCaster& caster) : eye_(eye), caster_(caster) {}

  const Eigen::Vector3d& position() const { return eye_.position; }
  bool counts(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d way = point - eye_.position;
    return counts_for_glare(way.dot(eye_.direction), way.dot(eye_.direction.cross(eye_.up)),
                            way.dot(eye_.up));
  }
  /// Returns the first hit of the ray from the eye to a point, up to `share` of the distance.
  ElementHit first_hit(const Eigen::Vector3d& point, double share) const {
    const Ray ray{.origin = eye_.position, .direction = point - eye_.position, .t_max = share};
    ElementHit hit;
    caster_.closest_hits({&ray, 1}, {&hit, 1});
    return hit;
  }
  void add(const std::string& name, const Eigen::Vector3d& point, double solid_angle,
           double luminance) {
    const Eigen::Vector3d way = (point - eye_.position).normalized();
    const double p = position_index(eye_, way);
    if (!number_.contains(name)) {
      number_[name] = sources_.size();
      sources_.push_back({.name = name});
    }
    GlareSource& source = sources_[number_[name]];
    source.solid_angle += solid_angle;
    source.luminance += luminance * solid_angle;  // sum of L w until finish()
    source.share += luminance * luminance / (p * p) * solid_angle;
  }
  std::vector<GlareSource> finish() {
    for (GlareSource& source : sources_) {
      source.luminance /= source.solid_angle;
      const double plain = source.luminance * source.luminance * source.solid_angle;
      source.position_index = std::sqrt(plain / source.share);
    }
    return std::move(sources_);
  }

 private:
  const Camera& eye_;
  const ElementCaster& caster_;
  std::map<std::string, std::size_t> number_{};
  std::vector<GlareSource> sources_{};
};

using Triangle = std::array<Eigen::Vector3d, 3>;

/// Adds a part of an emitting element, split in four until it is small.
void add_triangle(const std::string& name, const Triangle& t, const Eigen::Vector3d& normal,
                  int facet, double luminance, int halvings, GlareSum& sum) {
  const Eigen::Vector3d middle = (t[0] + t[1] + t[2]) / 3.0;
  const Eigen::Vector3d way = middle - sum.position();
  const double d = way.norm();
  const double length =
      std::max({(t[1] - t[0]).norm(), (t[2] - t[1]).norm(), (t[0] - t[2]).norm()});
  if (halvings < most_halvings && length * far_enough > d) {
    const Eigen::Vector3d a = 0.5 * (t[0] + t[1]), b = 0.5 * (t[1] + t[2]), c = 0.5 * (t[2] + t[0]);
    for (const Triangle& part :
         {Triangle{t[0], a, c}, Triangle{a, t[1], b}, Triangle{c, b, t[2]}, Triangle{a, b, c}}) {
      add_triangle(name, part, normal, facet, luminance, halvings + 1, sum);
    }
    return;
  }
  const double cosine = -normal.dot(way) / d;
  if (!(cosine > 0.0) || !sum.counts(middle)) return;
  constexpr double beyond = 1.01;  // a ray hits a sphere slightly off its elements
  if (sum.first_hit(middle, beyond).facet != facet) return;
  const double area = 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm();
  sum.add(name, middle, area * cosine / (d * d), luminance);
}

void add_surfaces(const Scene& scene, const PatchMesh& mesh, GlareSum& sum) {
  const PicturedEmission emission(mesh);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int patch = mesh.patch[e];
    const double luminance = luminous(scene.bands, emission.of_element(e)) / pi;
    if (!(luminance > 0.0)) continue;
    const std::string& name = scene.surfaces[static_cast<std::size_t>(mesh.surface[patch])].name;
    const Eigen::Vector3d normal = element_center(mesh, e).normal;
    const auto corner = [&](int c) { return mesh.position(mesh.corners[e][c]); };
    for (int c = 2; c < mesh.corner_count(e); ++c) {
      add_triangle(name, {corner(0), corner(c - 1), corner(c)}, normal, mesh.facet[e], luminance, 0,
                   sum);
    }
  }
}

/// Adds a lamp by sample points of its opening, each with an equal share of the intensity (see
/// LampOpening). The luminance of a point is I / A and its solid angle A / d^2 over the number of
/// points, with the projected area A seen from the eye.
void add_lamp(const Bands& bands, const Lamp& lamp, const Spectrum& light, double height,
              GlareSum& sum) {
  const double candela = luminous(bands, light);
  if (!(candela > 0.0)) return;
  const double least = rim_of_opening * luminous_area(lamp.opening, 0.0, Eigen::Vector3d::UnitZ());
  constexpr int places = opening_grid * opening_grid;
  for (int i = 0; i < places; ++i) {
    const Eigen::Vector3d point = opening_point(lamp, (i % opening_grid + 0.5) / opening_grid,
                                                (i / opening_grid + 0.5) / opening_grid);
    if (!sum.counts(point) || sum.first_hit(point, way_before_opening).facet >= 0) continue;
    const Eigen::Vector3d from = sum.position() - point;
    const double d = from.norm();
    const double I = candela * relative_intensity(lamp, from / d);
    const double area =
        std::max(luminous_area(lamp.opening, height, lamp.axes.transpose() * from / d), least);
    if (I > 0.0) sum.add(lamp.name, point, area / (places * d * d), I / area);
  }
}

bool has_luminous_area(const Lamp& lamp) {
  return lamp.opening.along_c0 > 0.0 && lamp.opening.along_c90 > 0.0;
}

/// Illuminance of the eye by reflected light alone, lx: off diffuse surfaces, and the luminaires'
/// by way of mirrors, gloss and clear bodies.
double reflected_illuminance(const Scene& scene, const ElementCaster& caster,
                             const DirectLight& direct_light, const RadiositySolution& solution,
                             const Camera& eye, const GatherOptions& gathering) {
  const BandArray reflected = scattered_at_vertices(caster.mesh(), solution.irradiance());
  const GatherPoint point{.position = eye.position, .normal = eye.direction};
  const LitScene lit{scene, caster, direct_light};
  const GatheredIrradiance E = gather_indirect(lit, reflected, std::span(&point, 1), gathering);
  const SpecularIrradiance mirrored =
      specular_irradiance(lit, solution, std::span(&point, 1), {.replica = gathering.replica});
  const Spectrum all = (E.indirect.row(0) + mirrored.irradiance.row(0)).transpose();
  return luminous(scene.bands, all);
}

}  // namespace

double position_index(double sigma, double tau) {
  if (tau > 90.0) {
    const double r = std::tan(sigma * pi / 180.0);
    return 1.0 + (r < 0.6 ? 0.8 : 1.2) * r;
  }
  return std::exp((35.2 - 0.31889 * tau - 1.22 * std::exp(-2.0 * tau / 9.0)) * 1e-3 * sigma +
                  (21.0 + 0.26667 * tau - 0.002963 * tau * tau) * 1e-5 * sigma * sigma);
}

double position_index(const Camera& eye, const Eigen::Vector3d& towards) {
  constexpr double degrees = 180.0 / pi;
  const double ahead = towards.dot(eye.direction), above = towards.dot(eye.up);
  const double beside = std::abs(towards.dot(eye.direction.cross(eye.up)));
  return position_index(std::acos(std::min(1.0, ahead)) * degrees,
                        std::atan2(beside, above) * degrees);
}

bool counts_for_glare(double ahead, double beside, double above) {
  constexpr double most_beside = 3.0, most_above = 1.9;
  return ahead > 0.0 && std::abs(beside) <= most_beside * ahead && above <= most_above * ahead;
}

double glare_share(const Bands& bands, const ElementCaster& caster, const FreeSource& lamp,
                   const Camera& eye, double luminous_height) {
  const auto& light = std::get<LampLight>(lamp.shape);
  if (!has_luminous_area(light.lamp)) return 0.0;
  GlareSum sum(eye, caster);
  add_lamp(bands, light.lamp, lamp.light, luminous_height, sum);
  double share = 0.0;
  for (const GlareSource& source : sum.finish()) share += source.share;
  return share;
}

Glare unified_glare_rating(const Scene& scene, const ElementCaster& caster,
                           const DirectLight& direct_light, const RadiositySolution& solution,
                           const Camera& eye, const GatherOptions& gathering,
                           std::span<const double> luminous_heights) {
  const PatchMesh& mesh = caster.mesh();
  GlareSum sum(eye, caster);
  Glare glare;
  add_surfaces(scene, mesh, sum);
  for (const FreeSource& source : direct_light.free_sources()) {
    const auto* light = std::get_if<LampLight>(&source.shape);
    if (!light) continue;
    if (has_luminous_area(light->lamp)) {
      const double height = luminous_heights.empty()
                                ? 0.0
                                : luminous_heights[static_cast<std::size_t>(source.number)];
      add_lamp(scene.bands, light->lamp, source.light, height, sum);
    } else {
      glare.left_out.push_back(light->lamp.name);
    }
  }
  glare.sources = sum.finish();
  glare.background =
      reflected_illuminance(scene, caster, direct_light, solution, eye, gathering) / pi;
  double all = 0.0;
  for (const GlareSource& source : glare.sources) all += source.share;
  if (all > 0.0 && glare.background > 0.0) {
    glare.ugr = std::max(0.0, 8.0 * std::log10(0.25 / glare.background * all));
  }
  return glare;
}

}  // namespace lightwell
