// Time and memory of cleaning, merging and meshing triangles.
//
//   meshing_bench [SCENE...]
//
// Without scenes, four of about a million triangles each: walls, curved surfaces, copies of a wall,
// and triangles that overlap in one plane (refused).
#include <fmt/format.h>
#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <functional>
#include <numbers>

#include "mesh/build_patches.h"
#include "mesh/cleaning/planar_regions.h"
#include "mesh/patches/patch_mesh.h"
#include "scene/errors.h"
#include "scene/io/read_scene.h"
#include "scene/parallel.h"
#include "scene/sampling.h"

namespace {

using namespace lightwell;
using Eigen::Vector3d;

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

void add_triangle(PolygonMesh& mesh, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const int first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
  mesh.facets.push_back({.boundary = {first, first + 1, first + 2}});
}

// Adds two triangles for each of columns x rows cells of a surface over the unit square. No two
// triangles share a vertex.
void add_grid(PolygonMesh& mesh, int columns, int rows,
              const std::function<Vector3d(double, double)>& at) {
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const auto corner = [&](int di, int dj) {
        return at(static_cast<double>(i + di) / columns, static_cast<double>(j + dj) / rows);
      };
      add_triangle(mesh, corner(0, 0), corner(1, 0), corner(1, 1));
      add_triangle(mesh, corner(0, 0), corner(1, 1), corner(0, 1));
    }
  }
}

Scene scene_of(PolygonMesh mesh) {
  Scene scene;
  scene.materials.push_back({.name = "grey",
                             .reflectance = Spectrum::Constant(3, 0.5f),
                             .specular = Spectrum::Zero(3),
                             .emission = Spectrum::Zero(3)});
  scene.surfaces.push_back({.name = "soup", .material = 0, .shape = std::move(mesh)});
  return scene;
}

// Six walls of 5 m x 4 m x 3 m in a million triangles.
Scene walls() {
  PolygonMesh mesh;
  constexpr int n = 289;
  const Vector3d size(5, 4, 3);
  for (int axis = 0; axis < 3; ++axis) {
    for (const int end : {0, 1}) {
      add_grid(mesh, n, n, [&](double u, double v) {
        Vector3d p = Vector3d::Zero();
        p[axis] = end * size[axis];
        p[(axis + 1) % 3] = (end ? u : v) * size[(axis + 1) % 3];
        p[(axis + 2) % 3] = (end ? v : u) * size[(axis + 2) % 3];
        return p;
      });
    }
  }
  return scene_of(std::move(mesh));
}

// 64 balls of 15 840 triangles.
Scene balls() {
  PolygonMesh mesh;
  for (int k = 0; k < 64; ++k) {
    const Vector3d center(k % 4, k / 4 % 4, k / 16);
    add_grid(mesh, 88, 90, [&](double u, double v) {
      constexpr double cap = 0.02;  // radians left open at the poles
      const double phi = 2 * std::numbers::pi * (u < 1.0 ? u : 0.0);
      const double theta = std::numbers::pi - cap - (std::numbers::pi - 2 * cap) * v;
      return Vector3d(center + 0.4 * Vector3d(std::sin(theta) * std::cos(phi),
                                              std::sin(theta) * std::sin(phi), std::cos(theta)));
    });
  }
  return scene_of(std::move(mesh));
}

// Triangles in one plane that nearly all overlap.
Scene heap(int count) {
  PolygonMesh mesh;
  for (int i = 0; i < count; ++i) {
    const auto random = [&](int k) { return random_uniform(random_key(i, k)); };
    const Vector3d at(random(0), random(1), 0);
    const double a = 2 * std::numbers::pi * random(2);
    const Vector3d u(std::cos(a), std::sin(a), 0), v(-u.y(), u.x(), 0);
    add_triangle(mesh, at - u - v, at + u - v, at + v);
  }
  return scene_of(std::move(mesh));
}

// A slightly curved wall of 9800 triangles, `copies` times.
Scene copied(int copies) {
  PolygonMesh mesh;
  for (int k = 0; k < copies; ++k) {
    add_grid(mesh, 70, 70, [](double u, double v) { return Vector3d(4 * u, 3 * v, 0.1 * u * v); });
  }
  return scene_of(std::move(mesh));
}

void measure(const std::string& name, const Scene& scene) {
  CleanUpReport report;
  Scene clean;
  const double cleaning = seconds_of([&] { clean = merge_planar_regions(scene, &report); });
  PatchMesh mesh;
  std::string refusal;
  const double meshing = seconds_of([&] {
    try {
      mesh = build_patches(clean);
    } catch (const InputError& error) {
      refusal = error.what();
    }
  });
  fmt::print("{:<28} {:>9} {:>9} {:>9} {:>9} {:>9} {:>8.2f} {:>8.2f} {:>7.0f}\n", name,
             report.facets_before, report.facets_after, mesh.patch_count(), mesh.element_count(),
             mesh.vertex_count(), cleaning, meshing, peak_megabytes());
  if (!refusal.empty()) fmt::print("  refused: {}\n", refusal);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) try {
  fmt::print("{} threads; facets of the scene and after cleaning; seconds; peak of all, MB\n",
             thread_count());
  fmt::print("{:<28} {:>9} {:>9} {:>9} {:>9} {:>9} {:>8} {:>8} {:>7}\n", "scene", "facets", "clean",
             "patches", "elements", "vertices", "clean", "mesh", "MB");
  for (int i = 1; i < argc; ++i) measure(argv[i], read_scene(argv[i]));
  if (argc > 1) return 0;
  measure("walls of triangles", walls());
  measure("balls of triangles", balls());
  measure("copies of a wall", copied(100));
  measure("heap of triangles", heap(1'000'000));
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "meshing_bench: {}\n", error.what());
  return 1;
}
