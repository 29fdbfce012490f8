#include "viewer/export/appearance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "mesh/patches/pictured_emission.h"
#include "raytrace/display/display.h"
#include "raytrace/display/light_meter.h"
#include "scene/coat.h"
#include "scene/facet_textures.h"
#include "scene/parallel.h"
#include "scene/specular.h"

namespace lightwell {
namespace {

constexpr int vertex_grain = 4096;

}  // namespace

std::vector<ElementKind> element_kinds(const SolvedScene& solved,
                                       const std::vector<Material>& materials) {
  return element_kinds(solved.mesh, solved.solution.irradiance(), materials);
}

std::vector<ElementKind> element_kinds(const PatchMesh& mesh, const BandArray& E,
                                       const std::vector<Material>& materials) {
  std::vector<ElementKind> kinds(static_cast<std::size_t>(mesh.element_count()));
  for (int e = 0; e < mesh.element_count(); ++e) {
    const Material* material = find_material(mesh, materials, e);
    bool lit = (mesh.emission.row(mesh.patch[e]) > 0.0f).any();
    for (int c = 0; c < mesh.corner_count(e); ++c) lit |= (E.row(mesh.corners[e][c]) > 0.0f).any();
    kinds[e] = material && material->dielectric ? ElementKind::glass
               : lit                            ? ElementKind::lit
                                                : ElementKind::unlit;
  }
  return kinds;
}

int first_corner(const PatchMesh& mesh, int element, const BandArray& radiance) {
  const auto& corners = mesh.corners[element];
  if (mesh.corner_count(element) < 4) return 0;
  const auto difference = [&](int a, int b) {
    return (radiance.row(corners[a]) - radiance.row(corners[b])).abs().sum();
  };
  return difference(1, 3) < difference(0, 2) ? 1 : 0;
}

std::vector<std::uint8_t> display_colors(const BandArray& radiance, const Bands& bands,
                                         const Eigen::Array3f& scale) {
  const int count = static_cast<int>(radiance.rows());
  std::vector<std::uint8_t> bytes(std::size_t{3} * radiance.rows());
  parallel_for(count, vertex_grain, [&](int begin, int end) {
    for (int v = begin; v < end; ++v) {
      const Spectrum L = radiance.row(v).transpose();
      const Eigen::Array3f shown = display_rgb(linear_rgb(bands, L) * scale, 1.0);
      for (int c = 0; c < 3; ++c) {
        bytes[std::size_t{3} * v + c] =
            static_cast<std::uint8_t>(255.0f * srgb_encode(shown[c]) + 0.5f);
      }
    }
  });
  return bytes;
}

std::vector<std::uint8_t> display_colors(const BandArray& radiance, const Bands& bands,
                                         double scale) {
  return display_colors(radiance, bands, Eigen::Array3f::Constant(static_cast<float>(scale)));
}

std::vector<std::uint8_t> light_codes(const BandArray& radiance, const Bands& bands,
                                      const Eigen::Array3f& scale) {
  const float floor = std::exp2(-light_code_depth);
  std::vector<std::uint8_t> codes(std::size_t{3} * radiance.rows());
  parallel_for(static_cast<int>(radiance.rows()), vertex_grain, [&](int begin, int end) {
    for (int v = begin; v < end; ++v) {
      const Eigen::Array3f x = linear_rgb(bands, radiance.row(v).transpose()) * scale;
      for (int c = 0; c < 3; ++c) {
        const float light = x[c] > 0.0f ? x[c] : 0.0f;  // NaN becomes black
        const float code = (std::log2(light + floor) + light_code_depth) / light_code_stops;
        codes[std::size_t{3} * v + c] =
            static_cast<std::uint8_t>(255.0f * std::clamp(code, 0.0f, 1.0f) + 0.5f);
      }
    }
  });
  return codes;
}

std::vector<float> vertex_illuminance(const RadiositySolution& solution) {
  return luminous_rows(solution.irradiance(), solution.bands);
}

std::vector<float> luminous_rows(const BandArray& values, const Bands& bands) {
  std::vector<float> result(static_cast<std::size_t>(values.rows()));
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    result[static_cast<std::size_t>(i)] =
        static_cast<float>(luminous(bands, values.row(i).transpose()));
  }
  return result;
}

std::vector<std::uint8_t> error_colors(const SolvedScene& solved) {
  const PatchMesh& mesh = solved.mesh;
  std::vector<float> error(mesh.vertex_count(), 0.0f);
  for (int e = 0; e < mesh.element_count() && solved.solution.interpolation_error.size() > 0; ++e) {
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      float& largest = error[mesh.corners[e][c]];
      largest = std::max(largest, solved.solution.interpolation_error[e]);
    }
  }
  return false_colors(error, {.low = 1e-3, .high = 0.1});
}

namespace {

// 1 for each element of glass.
std::vector<char> clear_elements(const std::vector<ElementKind>& kinds) {
  std::vector<char> clear(kinds.size());
  std::ranges::transform(kinds, clear.begin(),
                         [](ElementKind kind) { return kind == ElementKind::glass ? 1 : 0; });
  return clear;
}

}  // namespace

Image coarse_picture(const ElementCaster& caster, const std::vector<ElementKind>& kinds,
                     const BandArray& radiance, const Camera& camera, int width, const Sky* sky) {
  return coarse_picture(caster, clear_elements(kinds), radiance, camera, width, sky);
}

Metered meter_view(const ElementCaster& caster, const std::vector<ElementKind>& kinds,
                   const ShownLight& light, const Bands& bands, const Camera& camera,
                   const Sky* sky) {
  const auto metered =
      meter_incident_light(caster, light.irradiance, clear_elements(kinds), bands, camera);
  if (metered) return {metered->exposure, metered};
  const BandArray& radiance = light.radiance;
  const Image seen = coarse_picture(caster, kinds, radiance, camera, metering_width, sky);
  if ((seen.radiance > 0.0f).any()) return {exposure_scale(seen, bands), {}};
  return {exposure_scale({static_cast<int>(radiance.rows()), 1, radiance}, bands), {}};
}

double metered_scale(const ElementCaster& caster, const std::vector<ElementKind>& kinds,
                     const ShownLight& light, const Bands& bands, const Camera& camera,
                     const Sky* sky) {
  return meter_view(caster, kinds, light, bands, camera, sky).scale;
}

}  // namespace lightwell
