// Cost and errors of hemicubes.
//
//   hemicube_bench [SCENE.toml]     default: the diffuse Cornell box
//
// Prints, for meshes of several sizes and hemicubes of several resolutions, on one thread:
// - milliseconds for a row by scan conversion (from painting to form factors per patch), for the
//   rays of its cells through ElementCaster, for the same rays through plain Embree in coherent
//   packets, and the ratios;
// - the share of cells in which scan conversion and rays see different elements;
// - the three errors of the hemicube against closed forms: aliasing, proximity, visibility from one
//   point.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

#include "bench/raw_embree.h"
#include "bench/stopwatch.h"
#include "mesh/build_patches.h"
#include "radiosity/closed_forms/polygon_form_factor.h"
#include "radiosity/form_factors/hemicube.h"
#include "radiosity/form_factors/hemicube_view.h"
#include "scene/io/read_scene.h"
#include "scene/parallel.h"
#include "scene/sampling.h"

namespace {

using namespace lightwell;
using Eigen::Vector3d;

// Traces the cells of a hemicube in packets of 16 along its rows, the fastest query of Embree for
// such rays. Returns the number of hits.
int trace_packets(RTCScene scene, const HemicubeEye& eye, const HemicubeCells& cells) {
  constexpr int lanes = 16;
#if RTC_VERSION_MAJOR >= 4
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
#endif
  alignas(64) std::array<int, lanes> valid;
  valid.fill(-1);
  const Eigen::Vector3f origin = eye.position.cast<float>();
  const Eigen::Matrix3f frame = eye.frame.cast<float>();
  int hits = 0;
  RTCRayHit16 q{};
  for (int f = 0; f < HemicubeCells::face_count; ++f) {
    for (int row = 0; row < cells.rows(f); ++row) {
      for (int begin = 0; begin < cells.resolution(); begin += lanes) {
        for (int k = 0; k < lanes; ++k) {
          const Eigen::Vector3f d = frame * cells.direction(f, row, begin + k).cast<float>();
          q.ray.org_x[k] = origin.x();
          q.ray.org_y[k] = origin.y();
          q.ray.org_z[k] = origin.z();
          q.ray.dir_x[k] = d.x();
          q.ray.dir_y[k] = d.y();
          q.ray.dir_z[k] = d.z();
          q.ray.tnear[k] = 1e-5f;
          q.ray.tfar[k] = 1e30f;
          q.ray.mask[k] = ~0u;
          q.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
        }
#if RTC_VERSION_MAJOR >= 4
        rtcIntersect16(valid.data(), scene, &q, &arguments);
#else
        rtcIntersect16(valid.data(), scene, &context, &q);
#endif
        for (int k = 0; k < lanes; ++k) hits += q.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID;
      }
    }
  }
  return hits;
}

void print_speed(const Scene& scene, int patch_count) {
  const PatchMesh mesh =
      build_patches(scene, {.auto_patch_count = patch_count, .elements_per_patch_edge = 1});
  const ElementCaster caster(mesh);
  const LightPaths paths(scene, caster, 8);
  const RawScene embree(mesh, "threads=1");
  const HemicubeScan scan(caster);
  HemicubeScan::Scratch scratch;
  fmt::print("\n{} patches, {} elements\n", mesh.patch_count(), mesh.element_count());
  fmt::print(
      "  cells   row ms   scan ms   rays ms   packets ms   rays/row   packets/row   differ\n");
  for (const int n : {64, 128, 256, 512}) {
    const HemicubeCells cells(n);
    std::vector<int> painted(cells.cell_count()), traced(cells.cell_count());
    const double row =
        seconds_of([&] { hemicube_rows(caster, paths, {.resolution = n}); }) / mesh.patch_count();
    constexpr int eyes = 12;  // spread over the mesh
    double painting = 0.0, rays = 0.0, packets = 0.0;
    int differing = 0, hits = 0;
    for (int k = 0; k < eyes; ++k) {
      const HemicubeEye eye =
          hemicube_eye(mesh, (2 * k + 1) * mesh.patch_count() / (2 * eyes), true);
      painting += seconds_of([&] { scan.draw(eye, cells, scratch, painted); }) / eyes;
      rays += seconds_of([&] { cast_hemicube(caster, eye, cells, traced); }) / eyes;
      packets += seconds_of([&] { hits += trace_packets(embree.scene, eye, cells); }) / eyes;
      for (std::size_t i = 0; i < painted.size(); ++i) differing += painted[i] != traced[i];
    }
    fmt::print("  {:5} {:8.2f} {:9.2f} {:9.1f} {:12.1f} {:10.1f} {:13.1f}   {:.1e}\n", n, 1e3 * row,
               1e3 * painting, 1e3 * rays, 1e3 * packets, rays / row, packets / row,
               differing / (static_cast<double>(eyes) * cells.cell_count()));
    if (hits == 0) fmt::print("  (no packet hit anything)\n");
  }
}

int add_grey(Scene& scene) {
  scene.materials.push_back({.name = "grey",
                             .reflectance = constant_spectrum(scene.bands, 0.5f),
                             .specular = constant_spectrum(scene.bands, 0.0f),
                             .emission = constant_spectrum(scene.bands, 0.0f),
                             .one_sided = true});
  return static_cast<int>(scene.materials.size()) - 1;
}

void add_polygon(Scene& scene, int material, const std::vector<Vector3d>& points) {
  PolygonMesh mesh{.vertices = points, .facets = {Facet{}}};
  for (int i = 0; i < static_cast<int>(points.size()); ++i) mesh.facets[0].boundary.push_back(i);
  scene.surfaces.push_back({.name = "polygon", .material = material, .shape = mesh});
}

std::vector<Vector3d> points_of(const nlohmann::json& polygon) {
  std::vector<Vector3d> points;
  for (const auto& p : polygon) points.emplace_back(p[0], p[1], p[2]);
  return points;
}

// Aliasing: form factors of a differential element to a polygon, the cases of the catalogue with
// the hemicube turned about the normal.
void print_aliasing(const nlohmann::json& catalogue) {
  fmt::print("\nAliasing: element to polygon, error over the catalogue and 32 turns\n");
  fmt::print("  cells        rms      worst    rms before / rms\n");
  double before = 0.0;
  for (const int n : {32, 64, 128, 256, 512, 1024}) {
    const HemicubeCells cells(n);
    std::vector<int> items(cells.cell_count());
    HemicubeScan::Scratch scratch;
    double squares = 0.0, worst = 0.0;
    int count = 0;
    for (const auto& entry : catalogue) {
      const auto& geometry = entry["geometry"];
      if (geometry["type"] != "element-polygon") continue;
      Scene scene;
      add_polygon(scene, add_grey(scene), points_of(geometry["polygon"]));
      const PatchMesh mesh = build_patches(scene, {.max_patch_size = 1e3});
      const ElementCaster caster(mesh);
      const HemicubeScan scan(caster);
      const auto& p = geometry["point"];
      const auto& normal = geometry["normal"];
      const Vector3d z(normal[0], normal[1], normal[2]);
      Vector3d x, y;
      tangent_frame(z, x, y);
      for (int k = 0; k < 32; ++k) {
        const double turn = 2.0 * std::numbers::pi * (k + 0.5) / 32;
        HemicubeEye eye{.position = Vector3d(p[0], p[1], p[2])};
        eye.frame << std::cos(turn) * x + std::sin(turn) * y,
            std::cos(turn) * y - std::sin(turn) * x, z;
        scan.draw(eye, cells, scratch, items);
        double F = 0.0;
        for (int f = 0; f < HemicubeCells::face_count; ++f) {
          for (int row = 0; row < cells.rows(f); ++row) {
            for (int c = 0; c < n; ++c) {
              if (items[cells.first_cell(f) + row * n + c] == hemicube_item::nothing) continue;
              F += cells.delta_form_factor(f, row, c, c + 1);
            }
          }
        }
        const double error = F - entry["value"].get<double>();
        squares += error * error;
        worst = std::max(worst, std::abs(error));
        ++count;
      }
    }
    const double rms = std::sqrt(squares / count);
    fmt::print("  {:5}   {:.2e}   {:.2e}    {:.2f}\n", n, rms, worst, before / rms);
    before = rms;
  }
}

// F_12 of polygon1, cut into patches of `size`, to polygon2.
double mesh_form_factor(const Scene& scene, double size) {
  const PatchMesh mesh =
      build_patches(scene, {.max_patch_size = size, .elements_per_patch_edge = 1});
  const ElementCaster caster(mesh);
  const auto rows = hemicube_rows(caster, LightPaths(scene, caster, 1), {.resolution = 256});
  double F = 0.0, area = 0.0;
  for (int i = 0; i < mesh.patch_count(); ++i) {
    if (mesh.facet_of(i) != 0) continue;
    area += mesh.area[i];
    for (const FormFactor& f : rows[i].shares) {
      if (mesh.facet_of(f.patch) == 1) F += mesh.area[i] * f.value;
    }
  }
  return F / area;
}

// Errors of F_12 over the number of patches: of the catalogue's unoccluded pairs (proximity) and of
// the occluded ones (visibility from one point per patch).
void print_patch_errors(const nlohmann::json& catalogue) {
  constexpr std::array<int, 5> cuts = {1, 2, 4, 8, 16};
  for (const bool occluded : {false, true}) {
    fmt::print("\n{}: error of F12 with an edge of polygon1 cut into k, 256 cells\n",
               occluded ? "Visibility from one point" : "Proximity");
    fmt::print("  {:24} {:>8}", "", "F12");
    for (const int k : cuts) fmt::print("     k = {:<2}", k);
    fmt::print("\n");
    for (const auto& entry : catalogue) {
      const auto& geometry = entry["geometry"];
      if (geometry["type"] != (occluded ? "occluded-polygon-polygon" : "polygon-polygon")) continue;
      const auto first = points_of(geometry["polygon1"]);
      if (first.size() != 4 || (occluded && !geometry["blockers"][0].contains("polygon"))) continue;
      Scene scene;
      const int grey = add_grey(scene);
      add_polygon(scene, grey, first);
      add_polygon(scene, grey, points_of(geometry["polygon2"]));
      if (occluded) add_polygon(scene, grey, points_of(geometry["blockers"][0]["polygon"]));
      const double edge = (first[1] - first[0]).norm();
      fmt::print("  {:24} {:8.5f}", entry["id"].get<std::string>(), entry["value"].get<double>());
      for (const int k : cuts) {
        fmt::print("  {:+.1e}",
                   mesh_form_factor(scene, edge / k * (1.0 + 1e-9)) - entry["value"].get<double>());
      }
      fmt::print("\n");
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  const Scene scene = read_scene(argc > 1 ? argv[1] : LIGHTWELL_CORNELL "/cornell.toml");
  fmt::print("scene {}, one thread\n", scene.file.string());
  const ThreadLimit one(1);
  for (const int patches : {500, 2000, 8000}) print_speed(scene, patches);
  std::ifstream file(LIGHTWELL_TEST_DATA "/analytic/viewfactors.json");
  const auto catalogue = nlohmann::json::parse(file);
  print_aliasing(catalogue);
  print_patch_errors(catalogue);
}
