// Sweeps and seconds of the solvers to the default tolerance, and the bandwidth of a pass over the
// rows beside that of memory.
//
//   solver_bench [PLOT.svg] [SCENE...]    default: the Cornell box, a furnished room, a bright room
//
// Prints, per scene and method: sweeps, seconds, the final residual and the largest difference from
// a solution to 1e-10; then gigabytes per second of passes over the rows, beside a plain sum over
// the same memory. With PLOT.svg the program draws residual over seconds for the last scene.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "bench/grey_scene.h"
#include "bench/stopwatch.h"
#include "mesh/build_patches.h"
#include "mesh/cleaning/planar_regions.h"
#include "radiosity/solvers/radiosity_system.h"
#include "radiosity/solvers/solve_radiosity.h"
#include "scene/io/read_scene.h"
#include "scene/parallel.h"

namespace {

using namespace lightwell;

// A room with twelve blocks and a luminous panel under its ceiling.
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

Solvable prepare(const std::string& name, const Scene& raw, int patches, int rays = 512) {
  Solvable s{.name = name};
  const Scene scene = merge_planar_regions(raw);
  s.mesh = build_patches(scene, {.auto_patch_count = patches, .elements_per_patch_edge = 1});
  const ElementCaster caster(s.mesh);
  const DirectLight direct_light(scene, s.mesh);
  s.form_factors = compute_form_factors({scene, caster, direct_light}, {.rays_per_patch = rays});
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
  const RadiositySolution reference =
      solve_radiosity(SolverMethod::conjugate_gradients, s.mesh, *s.form_factors,
                      {.tolerance = 1e-10, .max_sweeps = 5000});
  const BandArray& exact = reference.patch_radiosity;
  fmt::print("  reference to 1e-10: {} sweeps\n", reference.history.size());
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
    if (name != "auto") curves.push_back({std::string(name), solution.history});
  }
  return curves;
}

// Least seconds of 15 runs, since machines are shared.
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
  // The plain sum reads the rows as floats; Eigen adds them to several partial sums at once.
  const auto read_all = [&] {
    parallel_for(F.patch_count(), 64, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        const std::span<const FormFactor> row = F.row(i);
        const auto* const numbers = reinterpret_cast<const float*>(row.data());
        sums[i] =
            Eigen::Map<const Eigen::ArrayXf>(numbers, 2 * static_cast<Eigen::Index>(row.size()))
                .sum();
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

// Draws one line per method on logarithmic axes.
void draw(const std::string& file, const std::vector<Curve>& curves) {
  constexpr double left = 70, top = 20, width = 520, height = 340;
  constexpr int low = -7, high = 0;  // powers of ten
  int soonest = 0, latest = -3;
  for (const Curve& curve : curves) {
    const auto power = [](const StepRecord& step) { return std::log10(step.seconds); };
    soonest = std::min(soonest, static_cast<int>(std::floor(power(curve.history.front()))));
    latest = std::max(latest, static_cast<int>(std::ceil(power(curve.history.back()))));
  }
  const auto x = [&](double seconds) {
    return left + width * (std::log10(seconds) - soonest) / (latest - soonest);
  };
  const auto y = [&](double residual) {
    return top +
           height * (high - std::clamp<double>(std::log10(residual), low, high)) / (high - low);
  };
  std::ofstream out(file);
  out << R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 720 410" font-family="sans-serif" font-size="13">)"
      << "\n<rect width=\"720\" height=\"410\" fill=\"white\"/>\n";
  for (int p = soonest; p <= latest; ++p) {
    const double at = x(std::pow(10.0, p));
    out << fmt::format("<path d=\"M{:.1f} {} V{}\" stroke=\"#ddd\"/>", at, top, top + height)
        << fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">10^{}</text>\n", at,
                       top + height + 18, p);
  }
  for (int p = low; p <= high; ++p) {
    const double at = y(std::pow(10.0, p));
    out << fmt::format("<path d=\"M{} {:.1f} H{}\" stroke=\"#ddd\"/>", left, at, left + width)
        << fmt::format("<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">10^{}</text>\n", left - 6,
                       at + 4, p);
  }
  const std::vector<std::string> colors = {"#c0392b", "#2471a3", "#229954", "#8e44ad",
                                           "#d68910", "#117a65", "#5d6d7e"};
  for (std::size_t c = 0; c < curves.size(); ++c) {
    const std::string& color = colors[c % colors.size()];
    std::string path;
    for (const StepRecord& step : curves[c].history) {
      path += fmt::format("{}{:.1f} {:.1f} ", path.empty() ? "M" : "L", x(step.seconds),
                          y(step.residual));
    }
    const double legend = top + 20.0 + 20.0 * static_cast<double>(c);
    out << fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"/>", path,
                       color)
        << fmt::format("<text x=\"{}\" y=\"{}\" fill=\"{}\">{}</text>\n", left + width + 10, legend,
                       color, curves[c].name);
  }
  out << fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">seconds</text>",
                     left + width / 2, top + height + 40)
      << fmt::format(
             "<text transform=\"translate(18 {}) rotate(-90)\" text-anchor=\"middle\">residual "
             "over "
             "the largest B</text>\n</svg>\n",
             top + height / 2);
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
    all.push_back(prepare("furnished room, reflectance 0.5", furnished_room(0.5f), 12000, 2048));
    all.push_back(prepare("furnished room, reflectance 0.9", furnished_room(0.9f), 6000));
  }
  constexpr int most_sweeps = 1000;
  std::vector<Curve> curves;
  for (const Solvable& s : all) {
    curves = compare_solvers(s, most_sweeps);
    measure_passes(s);
  }
  if (argc > 1) draw(argv[1], curves);
}
