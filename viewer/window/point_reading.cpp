#include "viewer/window/point_reading.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "mesh/cleaning/joined_surfaces.h"
#include "mesh/patches/pictured_emission.h"
#include "mesh/patches/round_grid.h"
#include "scene/facet_textures.h"

namespace lightwell {
namespace {

Eigen::Vector3d normal_at(const PatchMesh& mesh, const VisibleHit& seen) {
  if (const RoundGrid* grid = round_grid_of(mesh, seen.hit.facet)) {
    const Eigen::Vector3d front = front_normal(grid->shape, seen.position);
    return seen.hit.from_back ? Eigen::Vector3d(-front) : front;
  }
  return element_center(mesh, seen.hit.element).normal;
}

template <class Named>
std::string name_of(const std::vector<Named>* named, int index, const char* what) {
  const auto i = static_cast<std::size_t>(index);
  if (named && i < named->size() && !(*named)[i].name.empty()) return (*named)[i].name;
  return fmt::format("{} {}", what, index);
}

std::string per_band(const Spectrum& values, const Bands& bands) {
  // Eight bands fit on a line; of more bands the first, the last and six between are shown.
  constexpr Eigen::Index most = 8;
  const Eigen::Index count = values.size(), shown = std::min(count, most);
  std::string text;
  for (Eigen::Index i = 0; i < shown; ++i) {
    const Eigen::Index k = shown == count ? i : i * (count - 1) / (shown - 1);
    text += fmt::format("{}{} {:.4g}", i > 0 ? "  " : "", bands.names[static_cast<std::size_t>(k)],
                        values[k]);
  }
  return text;
}

}  // namespace

PointReading read_point(const PatchMesh& mesh, const Bands& bands, const BandArray& irradiance,
                        const Scene* scene, const VisibleHit& seen, const JoinedSurfaces* names) {
  PointReading reading;
  reading.position = seen.position;
  reading.normal = normal_at(mesh, seen);
  reading.element = seen.hit.element;
  reading.patch = mesh.patch[seen.hit.element];
  reading.irradiance = interpolate(mesh, irradiance, seen.hit);
  reading.reflectance = mesh.reflectance.row(reading.patch).transpose();
  // A textured patch has the texture's mean reflectance; a black back has no texture.
  const int facet = mesh.facet[seen.hit.element];
  const bool is_black = !(reading.reflectance > 0.0f).any();
  if (mesh.textures && mesh.textures->is_textured(facet) && !is_black) {
    reading.reflectance = mesh.textures->reflectance(facet, seen.position);
  }
  reading.lux = luminous(bands, reading.irradiance);
  const Spectrum emission = emission_at(mesh, reading.element, seen.position);
  Spectrum B = emission + reading.reflectance * reading.irradiance;
  if (mesh.patch_behind(reading.patch) >= 0) {
    const Spectrum behind = interpolate(mesh, irradiance, hit_behind(mesh, seen.hit));
    B += mesh.transmittance.row(reading.patch).transpose() * behind;
  }
  reading.luminance = luminous(bands, B) / std::numbers::pi;
  const int surface =
      names ? names->surface_of(mesh, reading.element, seen.position) : mesh.surface[reading.patch];
  reading.surface = name_of(scene ? &scene->surfaces : nullptr, surface, "surface");
  const int material = names && scene ? scene->surfaces[static_cast<std::size_t>(surface)].material
                                      : mesh.material[reading.patch];
  reading.material = name_of(scene ? &scene->materials : nullptr, material, "material");
  return reading;
}

namespace {

std::string within_text(const PointReading& reading) {
  return reading.lux_within < 0.0 ? "" : fmt::format(" within {:.2g}", reading.lux_within);
}

}  // namespace

std::string full_text(const PointReading& reading, const Bands& bands, const ShownUnits& units) {
  // A coordinate that is 0 up to the rounding of rays is shown as 0.
  const double distance = reading.position.norm();
  const Eigen::Vector3d p = reading.position.unaryExpr(
      [&](double x) { return std::abs(x) < 1e-6 * distance ? 0.0 : x / units.metres_per_unit; });
  const Eigen::Vector3d& n = reading.normal;
  const bool relative = units.relative;
  return fmt::format(
      "{}, {}\n"
      "illuminance  {:.5g} {}{}\n"
      "luminance    {:.5g} {}\n"
      "irradiance   {}{}\n"
      "reflectance  {}\n"
      "patch {}, element {}\n"
      "at {:.6g}, {:.6g}, {:.6g} {}\n"
      "facing {:.4f}, {:.4f}, {:.4f}",
      reading.surface, reading.material, reading.lux, relative ? "(relative)" : "lx",
      within_text(reading), reading.luminance, relative ? "(relative)" : "cd/m2",
      per_band(reading.irradiance, bands), relative ? "" : " W/m2",
      per_band(reading.reflectance, bands), reading.patch, reading.element, p.x(), p.y(), p.z(),
      units.unit_name, n.x() + 0.0, n.y() + 0.0, n.z() + 0.0);
}

std::string short_text(const PointReading& reading, const ShownUnits& units) {
  return fmt::format("{:.4g} {}{}  {:.4g} {}\n{}", reading.lux, units.relative ? "rel." : "lx",
                     within_text(reading), reading.luminance, units.relative ? "rel." : "cd/m2",
                     reading.surface);
}

}  // namespace lightwell
