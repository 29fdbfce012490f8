// Error and cost of the four form-factor methods.
//
//   form_factor_bench [PLOT.svg]
//
// A closed box of 600 patches (every pair has an exact closed form) and the box with a block in it
// (the reference is the analytic method with many shadow rays). Prints, per method and effort:
// seconds per row, RMS and worst error of F_ij; closed forms per second; and time and memory of
// cities of growing size. With PLOT.svg the program draws error over rays or cells per row.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "bench/grey_scene.h"
#include "bench/stopwatch.h"
#include "mesh/build_patches.h"
#include "mesh/patches/patch_outline.h"
#include "radiosity/closed_forms/pair_exchange.h"
#include "radiosity/form_factors/form_factors.h"
#include "radiosity/rows/memory_budget.h"
#include "scene/parallel.h"
#include "scene/sampling.h"

namespace {

using namespace lightwell;

Scene room(bool with_block) {
  Scene scene = grey_scene();
  add_box(scene, {0, 0, 0}, {1, 1, 1}, true);
  if (with_block) add_box(scene, {0.3, 0.2, 0.0}, {0.3, 0.4, 0.6}, false);
  validate(scene);
  return scene;
}

struct Prepared {
  explicit Prepared(Scene s, double patch)
      : scene(std::move(s)),
        mesh(build_patches(scene, {.max_patch_size = patch, .elements_per_patch_edge = 1})),
        caster(mesh),
        direct_light(scene, mesh) {}
  Scene scene;
  PatchMesh mesh;
  ElementCaster caster;
  DirectLight direct_light;
};

Eigen::MatrixXd dense(const FormFactors& F) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(F.patch_count(), F.patch_count());
  for (int i = 0; i < F.patch_count(); ++i) {
    for (const FormFactor& f : F.row(i)) result(i, f.patch) = f.value;
  }
  return result;
}

struct Point {
  double effort, error;
};
struct Curve {
  std::string name;
  std::vector<Point> points;
};

Eigen::MatrixXd compute(const Prepared& p, const FormFactorOptions& options, double& seconds) {
  std::unique_ptr<FormFactors> F;
  seconds = seconds_of([&] {
    F = compute_form_factors({p.scene, p.caster, p.direct_light}, options);
  });
  return dense(*F);
}

Curve measure(const Prepared& p, const Eigen::MatrixXd& reference, const std::string& name,
              const std::vector<FormFactorOptions>& efforts,
              const std::function<double(const FormFactorOptions&)>& effort_of) {
  Curve curve{.name = name};
  for (const FormFactorOptions& options : efforts) {
    double seconds = 0.0;
    const Eigen::ArrayXXd off = (compute(p, options, seconds) - reference).array();
    const double rms = std::sqrt(off.square().mean());
    const double effort = effort_of(options);
    fmt::print("{:10} {:8.0f} {:10.1f} us/row   RMS {:.1e}   worst {:.1e}\n", name, effort,
               1e6 * seconds / p.mesh.patch_count(), rms, off.abs().maxCoeff());
    curve.points.push_back({effort, rms});
  }
  return curve;
}

std::vector<Curve> measure_all(const Prepared& p, const Eigen::MatrixXd& reference) {
  std::vector<Curve> curves;
  for (const auto& [name, method] : {std::pair{"ray-cast", FormFactorMethod::ray_cast},
                                     std::pair{"auto", FormFactorMethod::automatic}}) {
    std::vector<FormFactorOptions> efforts;
    for (int rays = 64; rays <= 65536; rays *= 4) {
      efforts.push_back({.method = method, .rays_per_patch = rays});
    }
    curves.push_back(measure(p, reference, name, efforts, [](const FormFactorOptions& o) {
      return static_cast<double>(o.rays_per_patch);
    }));
  }
  std::vector<FormFactorOptions> cubes;
  for (const int n : {8, 16, 32, 64, 128, 256}) {
    cubes.push_back({.method = FormFactorMethod::hemicube, .hemicube_resolution = n});
  }
  curves.push_back(measure(p, reference, "hemicube", cubes, [](const FormFactorOptions& o) {
    return 3.0 * o.hemicube_resolution * o.hemicube_resolution;
  }));
  return curves;
}

// Draws one line per curve on logarithmic axes.
void draw(const std::string& file, const std::vector<Curve>& curves) {
  constexpr double left = 70, top = 20, width = 520, height = 340;
  constexpr double low_x = 1.5, high_x = 5.5, low_y = -7.0, high_y = -1.5;  // powers of ten
  const auto x = [&](double v) {
    return left + width * (std::log10(v) - low_x) / (high_x - low_x);
  };
  const auto y = [&](double v) {
    return top + height * (high_y - std::log10(v)) / (high_y - low_y);
  };
  std::ofstream out(file);
  out << R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 720 410" font-family="sans-serif" font-size="13">)"
      << "\n<rect width=\"720\" height=\"410\" fill=\"white\"/>\n";
  for (int p = 2; p <= 5; ++p) {
    const double at = x(std::pow(10.0, p));
    out << fmt::format("<path d=\"M{:.1f} {} V{}\" stroke=\"#ddd\"/>", at, top, top + height)
        << fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">10^{}</text>\n", at,
                       top + height + 18, p);
  }
  for (int p = -7; p <= -2; ++p) {
    const double at = y(std::pow(10.0, p));
    out << fmt::format("<path d=\"M{} {:.1f} H{}\" stroke=\"#ddd\"/>", left, at, left + width)
        << fmt::format("<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">10^{}</text>\n", left - 6,
                       at + 4, p);
  }
  const std::vector<std::string> colors = {"#c0392b", "#2471a3", "#229954"};
  for (std::size_t c = 0; c < curves.size(); ++c) {
    std::string path;
    for (const Point& point : curves[c].points) {
      path += fmt::format("{}{:.1f} {:.1f} ", path.empty() ? "M" : "L", x(point.effort),
                          y(std::max(point.error, 1e-12)));
    }
    const Point& last = curves[c].points.back();
    const auto& color = colors[c % colors.size()];
    const bool dashed = c >= colors.size();
    out << fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"{}/>", path,
                       color, dashed ? " stroke-dasharray=\"6 4\"" : "")
        << fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" fill=\"{}\">{}</text>\n",
                       x(last.effort) + 6, y(std::max(last.error, 1e-12)) + 4, color,
                       dashed ? "" : curves[c].name);
  }
  out << fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">rays or cells per row</text>",
                     left + width / 2, top + height + 40)
      << fmt::format(
             "<text transform=\"translate(18 {}) rotate(-90)\" text-anchor=\"middle\">RMS "
             "error of F_ij</text>\n</svg>\n",
             top + height / 2);
}

void count_pairs(const Prepared& p) {
  const std::vector<PatchOutline> outlines = patch_outlines(p.mesh);
  const PairExchange pairs(outlines);
  const int n = p.mesh.patch_count();
  std::vector<double> sums(static_cast<std::size_t>(n), 0.0);
  const double seconds = seconds_of([&] {
    parallel_for(n, 8, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        for (int j = i + 1; j < n; ++j) sums[i] += pairs.between(i, j);
      }
    });
  });
  fmt::print("closed forms, {} patches: {:.1f} million pairs a second\n", n,
             0.5e-6 * n * n / seconds);
}

// A city of n x n blocks on a plain, made of triangles.
Scene city(int n) {
  Scene scene = grey_scene();
  PolygonMesh mesh;
  const auto add_rectangle = [&](const Eigen::Vector3d& corner, const Eigen::Vector3d& u,
                                 const Eigen::Vector3d& v, int cells) {
    const int first = static_cast<int>(mesh.vertices.size());
    for (int b = 0; b <= cells; ++b) {
      for (int a = 0; a <= cells; ++a) mesh.vertices.push_back(corner + (a * u + b * v) / cells);
    }
    for (int b = 0; b < cells; ++b) {
      for (int a = 0; a < cells; ++a) {
        const int at = first + b * (cells + 1) + a, above = at + cells + 1;
        mesh.facets.push_back({.boundary = {at, at + 1, above + 1}});
        mesh.facets.push_back({.boundary = {at, above + 1, above}});
      }
    }
  };
  const Eigen::Vector3d x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  for (int i = 0; i < n * n; ++i) {
    const auto size = [&](std::uint64_t what, double least, double most) {
      return least +
             (most - least) * random_uniform(random_key(static_cast<std::uint64_t>(i), what));
    };
    const double w = size(1, 12, 20), d = size(2, 12, 20), h = size(3, 8, 60);
    const Eigen::Vector3d o(30.0 * (i % n) + 5.0, 30.0 * (i / n) + 5.0, 0.0);
    constexpr int cells = 2;
    add_rectangle(o, w * x, h * z, cells);
    add_rectangle(o + w * x, d * y, h * z, cells);
    add_rectangle(o + w * x + d * y, -w * x, h * z, cells);
    add_rectangle(o + d * y, -d * y, h * z, cells);
    add_rectangle(o + h * z, w * x, d * y, cells);
  }
  const double side = 30.0 * n + 20.0;
  add_rectangle({-10, -10, 0}, side * x, side * y, 2 * n);
  scene.surfaces.push_back({.name = "city", .material = 0, .shape = std::move(mesh)});
  validate(scene);
  return scene;
}

void measure_city(int blocks, double target_error) {
  const Prepared p(city(blocks), 1e4);
  FormFactorReport report;
  const double seconds = seconds_of([&] {
    compute_form_factors({p.scene, p.caster, p.direct_light}, {.target_error = target_error},
                         &report);
  });
  fmt::print(
      "city of {} facets to {:.0e}: {:.1f} s, {:.0f} us/row, {:.0f} rays/row, {:.0f} MB at most\n",
      p.mesh.patch_count(), target_error, seconds, 1e6 * seconds / p.mesh.patch_count(),
      static_cast<double>(report.rays) / p.mesh.patch_count(),
      static_cast<double>(resident_memory().most) / (1 << 20));
}

}  // namespace

int main(int argc, char** argv) {
  const Prepared box(room(false), 0.1), blocked(room(true), 0.1), fine(room(false), 0.05);
  fmt::print("{} threads\n", thread_count());
  count_pairs(box);
  count_pairs(fine);
  double seconds = 0.0;
  FormFactorOptions exact{.method = FormFactorMethod::analytic, .target_error = 1e-5};

  fmt::print("empty box, {} patches, against closed forms\n", box.mesh.patch_count());
  const Eigen::MatrixXd box_reference = compute(box, exact, seconds);
  std::vector<Curve> curves = measure_all(box, box_reference);

  fmt::print("box with a block, {} patches, against closed forms with visibility to 1e-5\n",
             blocked.mesh.patch_count());
  const Eigen::MatrixXd blocked_reference = compute(blocked, exact, seconds);
  for (Curve& curve : measure_all(blocked, blocked_reference)) {
    curve.name += ", block";
    curves.push_back(curve);
  }
  FormFactorOptions usual{.method = FormFactorMethod::analytic, .target_error = 1e-3};
  measure(blocked, blocked_reference, "analytic", {usual}, [](const auto&) { return 0.0; });
  if (argc > 1) draw(argv[1], curves);

  for (const int blocks : {6, 12, 24, 48}) measure_city(blocks, 1e-2);
  measure_city(22, 1e-3);
}
