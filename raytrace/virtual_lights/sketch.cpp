#include "raytrace/virtual_lights/sketch.h"

#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <vector>

#include "mesh/build_patches.h"
#include "mesh/geometry/cut_size.h"
#include "radiosity/gather/vertex_points.h"
#include "radiosity/refine/even_out_noise.h"
#include "scene/parallel.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// Light of caustics at vertices; 0 for none.
BandArray caustic_light(const PatchMesh& mesh, const GatherPoints& points,
                        const CausticMap* caustics) {
  BandArray light = BandArray::Zero(mesh.vertex_count(), mesh.reflectance.cols());
  if (!caustics) return light;
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      const int v = mesh.corners[e][c];
      const GatherPoint point = points[v];
      light.row(v) = caustics->irradiance(point.position, point.normal, e).transpose();
    }
  }
  return light;
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

// The first vertex, for each of `vertices`, that lies in the same cell of a grid and faces alike.
// Furniture of small facets has many vertices in a cell, which even indirect light need not tell
// apart.
std::vector<int> first_in_cell(const GatherPoints& points, std::span<const int> vertices,
                               double cell) {
  if (!(cell > 0.0)) return {vertices.begin(), vertices.end()};
  constexpr double turn = 0.5;  // of a coordinate of the normal: about 30 degrees
  std::map<std::array<double, 6>, int> first;
  std::vector<int> result;
  result.reserve(vertices.size());
  for (const int v : vertices) {
    const GatherPoint point = points[v];
    const Eigen::Array3d at = (point.position.array() / cell).round();
    const Eigen::Array3d facing = (point.normal.array() / turn).round();
    const auto [known, is_new] =
        first.try_emplace({at[0], at[1], at[2], facing[0], facing[1], facing[2]}, v);
    result.push_back(known->second);
  }
  return result;
}

// Lights the vertices of a mesh step by step.
class Sketcher {
 public:
  Sketcher(const LitScene& lit, const VirtualLights& lights, double cell, const Progress& progress)
      : lit_(lit),
        lights_(lights),
        progress_(progress),
        points_(vertex_points(lit.caster)),
        vertices_(sending_vertices(lit.mesh())),
        first_(first_in_cell(points_, vertices_, cell)),
        direct_(BandArray::Zero(lit.mesh().vertex_count(), lit.scene.bands.count())),
        from_lights_(direct_),
        from_rays_(direct_),
        caustics_(caustic_light(lit.mesh(), points_, lights.caustics())) {}

  void add_lights();
  /// Reads the radiosity of the light so far where rays end.
  void add_rays();
  /// Lets neighbouring vertices even out the noise of lights and rays. Caustics keep their edges.
  void even_out();
  RadiositySolution solution() const;

 private:
  BandArray indirect() const { return from_lights_ + from_rays_ + caustics_; }
  template <class Light>
  void for_each_vertex(const Light& light) const;
  void share(BandArray& light) const;

  const LitScene& lit_;
  const VirtualLights& lights_;
  const Progress& progress_;
  GatherPoints points_;
  std::vector<int> vertices_;
  std::vector<int> first_;  // for each of vertices_, the one whose indirect light holds for it
  BandArray direct_, from_lights_, from_rays_, caustics_;
};

// Calls light(vertex, point, key, is_first) for all vertices that send on light; `is_first`: for
// whose indirect light its own is to be found.
template <class Light>
void Sketcher::for_each_vertex(const Light& light) const {
  const auto count = static_cast<int>(vertices_.size());
  constexpr int slice = 512, grain = 16;  // a slice takes less than a second
  for (int first = 0; first < count; first += slice) {
    report(progress_, "sketch", static_cast<double>(first) / count);
    parallel_for(std::min(slice, count - first), grain, [&](int begin, int end) {
      for (int i = first + begin; i < first + end; ++i) {
        const int v = vertices_[static_cast<std::size_t>(i)];
        const GatherPoint point = points_[v];
        light(v, SurfacePoint{point.position, point.normal, point.facet},
              random_key(static_cast<std::uint64_t>(v), RandomPurpose::virtual_light_rays),
              first_[static_cast<std::size_t>(i)] == v);
      }
    });
  }
  report(progress_, "sketch", 1.0);
}

// Gives all vertices of a cell the light of the first.
void Sketcher::share(BandArray& light) const {
  for (std::size_t i = 0; i < vertices_.size(); ++i) light.row(vertices_[i]) = light.row(first_[i]);
}

void Sketcher::add_lights() {
  // A quarter of the effort has twice the noise, which the picture interpolates.
  constexpr float effort = 0.25f;
  for_each_vertex([&](int v, const SurfacePoint& at, std::uint64_t key, bool is_first) {
    direct_.row(v) =
        lit_.direct_light
            .irradiance(lit_.caster,
                        {.at = at,
                         .key = key,
                         .shadows = {.min_rays = 4, .max_rays = 8, .cluster_share = 0.2}})
            .transpose();
    if (!is_first) return;
    from_lights_.row(v) =
        lights_.from_lights(lit_.caster, {.at = at, .key = random_key(key, 1), .effort = effort})
            .transpose();
  });
  share(from_lights_);
}

void Sketcher::add_rays() {
  const BandArray B =
      gatherable_radiosity(lit_.mesh(), lit_.direct_light, direct_ + indirect(), direct_);
  for_each_vertex([&](int v, const SurfacePoint& at, std::uint64_t key, bool is_first) {
    if (!is_first) return;
    from_rays_.row(v) =
        lights_
            .from_rays(lit_.caster, {.at = at, .key = random_key(key, 1), .radiosity = &B},
                       from_lights_.row(v).mean())
            .transpose();
  });
  share(from_rays_);
}

void Sketcher::even_out() {
  // Half of a vertex's light may come from two of a cluster's lights.
  constexpr float noise = 0.5f;
  BandArray E = from_lights_ + from_rays_;
  Eigen::ArrayXf variance = (noise * E.rowwise().mean()).square();
  even_out_noise(lit_.mesh(), {}, static_cast<int>(E.cols()), E, variance);
  from_lights_ = E;
  from_rays_.setZero();
}

RadiositySolution Sketcher::solution() const {
  const Scene& scene = lit_.scene;
  RadiositySolution solution{.bands = scene.bands,
                             .metres_per_unit = scene.metres_per_unit,
                             .unit_name = scene.unit_name,
                             .relative_units = scene.relative_units};
  solution.patch_radiosity = lit_.mesh().emission;
  solution.direct_irradiance = direct_;
  solution.indirect_irradiance = indirect();
  if (lights_.has_specular()) solution.caustic_irradiance = caustics_;
  return solution;
}

}  // namespace

RadiositySolution sketch(const LitScene& lit, const VirtualLights& virtual_lights, double cell,
                         const Progress& progress) {
  Sketcher sketcher(lit, virtual_lights, cell, progress);
  sketcher.add_lights();
  // Rays of the first sweep find light that lacks what their own ends get from rays, a few percent
  // in corners; those of the second find that, too.
  constexpr int sweeps = 2;
  for (int sweep = 0; sweep < sweeps; ++sweep) sketcher.add_rays();
  sketcher.even_out();
  return sketcher.solution();
}

SolvedScene sketch_scene(const Scene& scene, const SketchOptions& options) {
  constexpr int few_photons = 1 << 16;
  const MeshOptions coarse{.auto_patch_count = 400};
  SolvedScene sketched{.mesh = build_patches(scene, coarse, options.progress)};
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
  // A mesh of so many vertices is finer than asked for, where facets are small. Those of larger
  // facets are one element apart and share nothing.
  constexpr int many_vertices = 1 << 15;
  const bool is_fine = sketched.mesh.vertex_count() > many_vertices;
  const double cell = is_fine ? 0.25 * cut_size(scene, coarse).element_size() : 0.0;
  sketched.solution = sketch(lit, VirtualLights(lit, lights), cell, options.progress);
  sketched.solution.provenance.scene_hash = scene_hash(scene);
  return sketched;
}

}  // namespace lightwell
