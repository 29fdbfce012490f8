// The solvers side by side: sweeps and seconds to the default tolerance, and how near a pass over
// the rows comes to what memory can do.
//
//   solver_bench [PLOT.svg] [SCENE...]    default: the Cornell box, a furnished room, a bright room
//
// Prints, per scene and method: sweeps, seconds, the residual left and the largest difference from
// a solution to 1e-10; then passes over the rows of the room in gigabytes a second, beside a plain
// sum over the same memory. With PLOT.svg it draws residual over seconds for the last scene.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "bench/grey_scene.h"
#include "bench/stopwatch.h"
#include "mesh/planar_regions.h"
#include "radiosity/radiosity_system.h"
#include "radiosity/solve_radiosity.h"
#include "scene/io/read_scene.h"
#include "scene/parallel.h"

namespace {

using namespace lightwell;

void add_rectangle(Scene& scene, int material, const Eigen::Vector3d& corner,
                   const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
  scene.surfaces.push_back(
      {.name = fmt::format("face {}", scene.surfaces.size()),
       .material = material,
       .shape = PolygonMesh{.vertices = {corner, corner + u, corner + u + v, corner + v},
                            .facets = {{.boundary = {0, 1, 2, 3}}}}});
}

void add_box(Scene& scene, const Eigen::Vector3d& low, const Eigen::Vector3d& size, bool inwards) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {0, 1}) {
      Eigen::Vector3d corner = low, u = Eigen::Vector3d::Zero(), v = u;
      corner[axis] += side * size[axis];
      u[(axis + 1) % 3] = size[(axis + 1) % 3];
      v[(axis + 2) % 3] = size[(axis + 2) % 3];
      if ((side == 0) != inwards) std::swap(u, v);
      add_rectangle(scene, 0, corner, u, v);
    }
  }
}

// A room with tables' worth of blocks and a panel of light under its ceiling.
Scene furnished_room(float reflectance) {
  Scene scene = grey_scene();
  scene.materials[0].reflectance = constant_spectrum(scene.bands, reflectance);
  Material panel = scene.materials[0];
  panel.name = "panel";
  panel.emission = constant_spectrum(scene.bands, 10.0f);
  scene.materials.push_back(panel);
  add_box(scene, {0, 0, 0}, {5, 4, 2.5}, true);
  for (int i = 0; i < 12; ++i) {
    add_box(scene, {0.4 + 1.2 * (i % 4), 0.5 + 1.2 * (i / 4), 0.0}, {0.7, 0.6, 0.4 + 0.1 * (i % 5)},
            false);
  }
  add_rectangle(scene, 1, {2.0, 1.5, 2.45}, {0, 1, 0}, {1, 0, 0});
  validate(scene);
  return scene;
}

struct Solvable {
  std::string name{};
  PatchMesh mesh{};
  std::unique_ptr<FormFactors> form_factors{};
};

Solvable prepare(const std::string& name, const Scene& raw, int patches) {
  Solvable s{.name = name};
  const Scene scene = merge_planar_regions(raw);
  s.mesh = build_patches(scene, {.auto_patch_count = patches, .elements_per_patch_edge = 1});
  const ElementCaster caster(s.mesh);
  const DirectLight direct_light(scene, s.mesh);
  s.form_factors = compute_form_factors(scene, caster, direct_light);
  return s;
}

double gigabytes(const FormFactors& F) {
  double bytes = 0.0;
  for (int i = 0; i < F.patch_count(); ++i) {
    bytes += static_cast<double>(F.row(i).size_bytes());
    const SpecularRow specular = F.specular_row(i);
    bytes += static_cast<double>(specular.patch.size_bytes()) +
             sizeof(float) * static_cast<double>(specular.value.size());
  }
  return 1e-9 * bytes;
}

struct Curve {
  std::string name{};
  std::vector<StepRecord> history{};
};

std::vector<Curve> compare_solvers(const Solvable& s, int max_sweeps) {
  fmt::print("{}: {} patches, rows {:.3f} GB\n", s.name, s.mesh.patch_count(),
             gigabytes(*s.form_factors));
  const BandArray exact = solve_radiosity(SolverMethod::bicgstab, s.mesh, *s.form_factors,
                                          {.tolerance = 1e-10, .max_sweeps = 5000})
                              .patch_radiosity;
  std::vector<Curve> curves;
  for (const auto& [name, method] : solver_methods) {
    const RadiositySolution solution =
        solve_radiosity(method, s.mesh, *s.form_factors, {.max_sweeps = max_sweeps});
    const BandArray off = (solution.patch_radiosity - exact).abs();
    fmt::print(
        "  {:26} {:5} sweeps {:8.3f} s   residual {:.1e}   off by {:.1e} of the largest B{}\n",
        name == "auto" ? "auto: " + solution.solver : std::string(name), solution.history.size(),
        solution.history.back().seconds, solution.residual, off.maxCoeff() / exact.maxCoeff(),
        solution.outcome == Outcome::converged ? "" : "   (stopped)");
    curves.push_back({std::string(name), solution.history});
  }
  return curves;
}

// The least seconds of some runs: others use the machine too.
double least_seconds(const std::function<void()>& work) {
  double least = seconds_of(work);
  for (int run = 1; run < 15; ++run) least = std::min(least, seconds_of(work));
  return least;
}

void measure_passes(const Solvable& s) {
  const FormFactors& F = *s.form_factors;
  const RadiositySystem system(s.mesh, F);
  const double bytes = gigabytes(F);
  std::vector<double> sums(static_cast<std::size_t>(F.patch_count()), 0.0);
  const auto read_all = [&] {
    parallel_for(F.patch_count(), 64, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        // As plain numbers, four sums at once: nothing but reading.
        const std::span<const FormFactor> row = F.row(i);
        using Words = Eigen::Array<std::int64_t, Eigen::Dynamic, 1>;
        const Words words = Words::Zero(1);
        (void)words;
        const auto* const at = reinterpret_cast<const float*>(row.data());
        sums[i] =
            Eigen::Map<const Eigen::ArrayXf>(at, 2 * static_cast<Eigen::Index>(row.size())).sum();
      }
    });
  };
  for (const int threads : {1, 0}) {
    const ThreadLimit limit(threads);
    const double read = bytes / least_seconds(read_all);
    const double pass = bytes / least_seconds([&] { (void)system.all(system.M); });
    fmt::print(
        "  pass over the rows, {} threads, {} bands: {:.1f} GB/s, {:.0f} % of reading ({:.1f})\n",
        thread_count(), system.bands(), pass, 100.0 * pass / read, read);
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  fmt::print("{} threads\n", thread_count());
  std::vector<Solvable> all;
  if (argc > 2) {
    for (int i = 2; i < argc; ++i) all.push_back(prepare(argv[i], read_scene(argv[i]), 1600));
  } else {
    all.push_back(prepare("Cornell box", read_scene(LIGHTWELL_CORNELL "/cornell.toml"), 1600));
    all.push_back(prepare("furnished room, reflectance 0.5", furnished_room(0.5f), 12000));
    all.push_back(prepare("furnished room, reflectance 0.9", furnished_room(0.9f), 6000));
  }
  constexpr int most_sweeps = 2000;
  std::vector<Curve> curves;
  for (const Solvable& s : all) {
    curves = compare_solvers(s, most_sweeps);
    measure_passes(s);
  }
}
