#include "viewer/export/baked_year.h"

#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include "raytrace/shading/shown_radiance.h"
#include "scene/errors.h"
#include "scene/specular.h"
#include "viewer/export/baked_channels.h"

namespace lightwell {
namespace {

// Linear red, green and blue, W/m^2 of 1 lx, times the luminous efficacy of the bands.
Eigen::Array3f rgb_of_lux(const Bands& bands, const Spectrum& lux) {
  const Spectrum ones = constant_spectrum(bands, 1.0f);
  const double factor = bands.lumens_per_watt / luminous(bands, ones);
  return linear_rgb(bands, lux) * static_cast<float>(factor);
}

// All bands of `bands` from values that may be those of one grey band.
BandArray in_bands(const BandArray& values, const Bands& bands) {
  return values.cols() == 1 ? BandArray(values.replicate(1, bands.count())) : values;
}

// The mean light of the hours as a solution.
SolvedScene mean_of_year(const YearOfLight& year, const Scene& scene,
                         const Provenance& provenance) {
  const DaylightModel& model = year.model;
  const Eigen::Index bands = model.scene().bands.count();
  SolvedScene solved{.mesh = model.mesh()};
  PatchMesh& mesh = solved.mesh;
  mesh.reflectance = in_bands(mesh.reflectance, scene.bands);
  if (mesh.transmittance.size() > 0) mesh.transmittance = in_bands(mesh.transmittance, scene.bands);
  mesh.emission = BandArray::Zero(mesh.patch_count(), scene.bands.count());
  RadiositySolution& solution = solved.solution;
  solution.bands = scene.bands;
  solution.metres_per_unit = scene.metres_per_unit;
  solution.unit_name = scene.unit_name;
  solution.provenance = provenance;
  const Eigen::ArrayXf mean = year.basis.weight.colwise().mean();
  BandArray light = BandArray::Zero(mesh.vertex_count(), bands);
  for (Eigen::Index k = 0; k < mean.size(); ++k) {
    light += mean[k] * year.basis.light.middleCols(k * bands, bands);
  }
  const auto lux_to_watts =
      static_cast<float>(1.0 / luminous(scene.bands, constant_spectrum(scene.bands, 1.0f)));
  solution.indirect_irradiance = in_bands(light.max(0.0f) * lux_to_watts, scene.bands);
  solution.direct_irradiance = BandArray::Zero(mesh.vertex_count(), scene.bands.count());
  solution.caustic_irradiance = solution.direct_irradiance;
  solution.patch_radiosity = BandArray::Zero(mesh.patch_count(), scene.bands.count());
  return solved;
}

// The light of the terms and the reflectance at the vertices of `model`.
void add_light(const YearOfLight& year, const SolvedScene& solved, const Scene& scene,
               const BakedModel& model, BakedYear& baked) {
  const Eigen::Index bands = year.model.scene().bands.count(), terms = year.basis.term_count(),
                     count = model.vertex_count();
  const Spectrum ones = constant_spectrum(scene.bands, 1.0f);
  const Eigen::Array3f white = linear_rgb(scene.bands, ones);
  const std::vector<int> patch = vertex_patches(solved.mesh);
  baked.bands = bands == 1 ? 1 : 3;
  baked.light.resize(count, baked.bands * terms);
  baked.reflectance.resize(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    const int v = model.mesh_vertex[static_cast<std::size_t>(i)];
    const Spectrum rho =
        shown_reflectance(solved.mesh, scene.materials, patch[static_cast<std::size_t>(v)]);
    baked.reflectance.row(i) = (linear_rgb(scene.bands, rho) / white).transpose();
    for (Eigen::Index k = 0; k < terms; ++k) {
      const Spectrum lux = year.basis.light.row(v).segment(k * bands, bands).transpose();
      if (bands == 1) {
        baked.light(i, k) = lux[0];
        continue;
      }
      const Eigen::Array3f rgb = rgb_of_lux(scene.bands, lux);
      for (int c = 0; c < 3; ++c) baked.light(i, c * terms + k) = rgb[c];
    }
  }
}

// Transmittance of a clear pane, a row for each cosine.
RgbArray pane_transmittance(const Material& material, const Bands& bands) {
  const Eigen::Array3f white = linear_rgb(bands, constant_spectrum(bands, 1.0f));
  RgbArray table = RgbArray::Zero(pane_steps + 1, 3);
  for (int i = 1; i <= pane_steps; ++i) {
    const double cosine = static_cast<double>(i) / pane_steps;
    const Eigen::Vector3d direction(std::sqrt(1.0 - cosine * cosine), 0.0, -cosine);
    const SmoothScattering lobes = smooth_scattering(
        {.material = material, .direction = direction, .normal = Eigen::Vector3d::UnitZ()});
    if (lobes.count < 2) continue;
    table.row(i) = (linear_rgb(bands, lobes.sample[1].weight) / white).max(0.0f).transpose();
  }
  return table;
}

void add_panes(const PatchMesh& mesh, const Scene& scene, const BakedModel& model,
               BakedYear& baked) {
  std::map<int, std::uint8_t> number;  // of materials of panes, from 1
  const std::vector<int> none;
  std::vector<char> has_face(static_cast<std::size_t>(mesh.element_count()), 0);
  for (const int e : model.element) has_face[static_cast<std::size_t>(e)] = 1;
  for (const int e : model.element) {
    const int material =
        mesh.material[static_cast<std::size_t>(mesh.patch[static_cast<std::size_t>(e)])];
    const Material& known = scene.materials[static_cast<std::size_t>(material)];
    if (!is_clear_pane(known)) {
      baked.pane_of_face.push_back(0);
      continue;
    }
    const int twin = mesh.twin[static_cast<std::size_t>(e)];
    if (twin >= 0 && twin < e && has_face[static_cast<std::size_t>(twin)]) {
      baked.pane_of_face.push_back(BakedYear::other_side);
      continue;
    }
    const auto [at, is_new] =
        number.try_emplace(material, static_cast<std::uint8_t>(baked.panes.size() + 1));
    if (is_new) baked.panes.push_back(pane_transmittance(known, scene.bands));
    if (baked.panes.size() >= BakedYear::other_side) {
      throw InputError("a page of a year takes at most 254 materials of clear panes");
    }
    baked.pane_of_face.push_back(at->second);
  }
}

}  // namespace

BakedModel bake_year(const YearOfLight& year, const Scene& read, const Provenance& provenance,
                     const JoinedSurfaces* names) {
  const Scene scene = without_light(read);
  const SolvedScene solved = mean_of_year(year, scene, provenance);
  BakedModel model = bake_model(solved, scene, 0.0, names);
  auto baked = std::make_shared<BakedYear>();
  add_light(year, solved, scene, model, *baked);
  add_panes(solved.mesh, scene, model, *baked);
  baked->weight = year.basis.weight;
  baked->error = year.basis.error;
  baked->hours.assign(year.hours.begin(), year.hours.end());
  baked->white = rgb_of_lux(scene.bands, constant_spectrum(scene.bands, 1.0f));
  baked->ground_reflectance = year.ground_reflectance;
  baked->up = year.model.sky().up();
  baked->north = year.model.sky().north();
  baked->place = year.weather.place;
  baked->latitude = year.weather.latitude;
  baked->longitude = year.weather.longitude;
  baked->hours_east = year.weather.hours_east;
  baked->is_leap_year = year.weather.is_leap_year;
  model.year = std::move(baked);
  return model;
}

}  // namespace lightwell
