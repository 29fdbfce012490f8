#include "raytrace/virtual_lights/sketch.h"

#include <algorithm>
#include <vector>

#include "mesh/build_patches.h"
#include "radiosity/gather/final_gather.h"
#include "scene/parallel.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// Adds the caustics at vertices.
void add_caustics(const PatchMesh& mesh, const VertexGatherPoints& points,
                  const CausticMap* caustics, RadiositySolution& solution) {
  if (!caustics) return;
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      const int v = mesh.corners[e][c];
      const GatherPoint point = points[v];
      solution.caustic_irradiance.row(v) =
          caustics->irradiance(point.position, point.normal, e).transpose();
    }
  }
  solution.indirect_irradiance += solution.caustic_irradiance;
}

// Vertices of surfaces that send on diffuse light.
std::vector<int> sending_vertices(const PatchMesh& mesh) {
  std::vector<char> sends(static_cast<std::size_t>(mesh.vertex_count()), 0);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int p = mesh.patch[e];
    if (!(mesh.reflectance.row(p) > 0.0f).any() && mesh.patch_behind(p) < 0) continue;
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      sends[static_cast<std::size_t>(mesh.corners[e][c])] = 1;
    }
  }
  std::vector<int> vertices;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (sends[static_cast<std::size_t>(v)] != 0) vertices.push_back(v);
  }
  return vertices;
}

}  // namespace

RadiositySolution sketch(const LitScene& lit, const VirtualLights& virtual_lights,
                         const Progress& progress) {
  const PatchMesh& mesh = lit.mesh();
  const Scene& scene = lit.scene;
  RadiositySolution solution{.bands = scene.bands,
                             .metres_per_unit = scene.metres_per_unit,
                             .unit_name = scene.unit_name,
                             .relative_units = scene.relative_units};
  solution.patch_radiosity = mesh.emission;
  const BandArray dark = BandArray::Zero(mesh.vertex_count(), scene.bands.count());
  solution.direct_irradiance = solution.indirect_irradiance = dark;
  if (virtual_lights.has_specular()) solution.caustic_irradiance = dark;
  const VertexGatherPoints points(mesh);
  const auto light_vertex = [&](int v) {
    const GatherPoint point = points[v];
    const SurfacePoint at{point.position, point.normal, point.facet};
    const auto key = random_key(static_cast<std::uint64_t>(v), RandomPurpose::virtual_light_rays);
    solution.direct_irradiance.row(v) =
        lit.direct_light
            .irradiance(lit.caster,
                        {.at = at,
                         .key = key,
                         .shadows = {.min_rays = 4, .max_rays = 8, .cluster_share = 0.2}})
            .transpose();
    // A quarter of the effort has twice the noise, which the picture interpolates.
    constexpr float effort = 0.25f;
    solution.indirect_irradiance.row(v) =
        virtual_lights
            .indirect_irradiance(lit.caster,
                                 {.at = at, .key = random_key(key, 1), .effort = effort})
            .transpose();
  };
  const std::vector<int> vertices = sending_vertices(mesh);
  const auto count = static_cast<int>(vertices.size());
  constexpr int slice = 512, grain = 16;  // a slice takes less than a second
  for (int first = 0; first < count; first += slice) {
    report(progress, "sketch", static_cast<double>(first) / count);
    parallel_for(std::min(slice, count - first), grain, [&](int begin, int end) {
      for (int i = first + begin; i < first + end; ++i) {
        light_vertex(vertices[static_cast<std::size_t>(i)]);
      }
    });
  }
  report(progress, "sketch", 1.0);
  add_caustics(mesh, points, virtual_lights.caustics(), solution);
  return solution;
}

SolvedScene sketch_scene(const Scene& scene, const SketchOptions& options) {
  constexpr int few_patches = 400, few_photons = 1 << 16;
  SolvedScene sketched{
      .mesh = build_patches(scene, {.auto_patch_count = few_patches}, options.progress)};
  const ElementCaster caster(sketched.mesh);
  const DirectLight direct_light(scene, sketched.mesh);
  const LitScene lit{scene, caster, direct_light};
  VirtualLightOptions lights{.count = options.virtual_lights,
                             .max_specular_depth = options.max_specular_depth,
                             .progress = options.progress};
  if (LightPaths(scene, caster, options.max_specular_depth).has_specular()) {
    lights.caustics = trace_caustics(scene, caster, direct_light, few_photons,
                                     options.max_specular_depth, options.progress);
  }
  sketched.solution = sketch(lit, VirtualLights(lit, lights), options.progress);
  sketched.solution.provenance.scene_hash = scene_hash(scene);
  return sketched;
}

}  // namespace lightwell
