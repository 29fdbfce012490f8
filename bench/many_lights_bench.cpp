// Ways to choose among many lights: error and lights asked.
//
//   many_lights_bench [PLOT.svg]
//
// A hall of 60 x 40 x 10 m with 60 machines under 1000 luminous panels, and under 1000 point lamps.
// The direct light of 300 points on floor, walls and machines by each method of ManyLights and by
// several sizes of clusters, against the light of all lights: the root mean square error over the
// mean, the lights that a point asks, and the time of a point against that of asking all. With
// PLOT.svg the program draws error over lights asked.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "bench/grey_scene.h"
#include "bench/stopwatch.h"
#include "mesh/build_patches.h"
#include "mesh/elements/element_caster.h"
#include "radiosity/direct_light/direct_light.h"
#include "scene/sampling.h"

namespace {

using namespace lightwell;
using Eigen::Vector3d;

constexpr double length = 60.0, width = 40.0, height = 10.0, lights_at = 9.5;
constexpr int columns = 40, rows = 25, point_count = 300;

double uniform(int number, int use) {
  return random_uniform(
      random_key(static_cast<std::uint64_t>(number), static_cast<std::uint64_t>(use)));
}

Scene hall(bool with_panels) {
  Scene scene = grey_scene();
  add_box(scene, {0, 0, 0}, {length, width, height}, true);
  for (int k = 0; k < 60; ++k) {
    const Vector3d size(1.2 + 2.4 * uniform(k, 1), 1.2 + 2.4 * uniform(k, 2),
                        1.2 + 2.8 * uniform(k, 3));
    add_box(scene,
            {3.0 + 6.0 * (k % 10) - 0.5 * size.x(), 3.3 + 6.6 * (k / 10) - 0.5 * size.y(), 0.0},
            size, false);
  }
  Material bright = scene.materials[0];
  bright.reflectance.setZero();
  bright.emission.setOnes();
  scene.materials.push_back(bright);
  for (int k = 0; k < columns * rows; ++k) {
    const Vector3d at((k % columns + 0.5) * length / columns, (k / columns + 0.5) * width / rows,
                      lights_at);
    if (with_panels) {
      constexpr double side = 0.6;
      add_rectangle(scene, 1, at - Vector3d(0.5 * side, 0.5 * side, 0), {0, side, 0}, {side, 0, 0});
    } else {
      scene.lamps.push_back({.name = fmt::format("lamp {}", k),
                             .position = at,
                             .intensity = constant_spectrum(scene.bands, 1.0f)});
    }
  }
  return scene;
}

// Points on surfaces below the lights, as rays from above find them.
std::vector<SurfacePoint> points_in(const ElementCaster& caster) {
  std::vector<SurfacePoint> points;
  for (int k = 0; static_cast<int>(points.size()) < point_count; ++k) {
    const Vector3d from(length * uniform(k, 4), width * uniform(k, 5), 9.0 * uniform(k, 6) + 0.3);
    const double z = 2.0 * uniform(k, 7) - 1.0, phi = 6.283185307179586 * uniform(k, 8);
    const double across = std::sqrt(1.0 - z * z);
    const Ray ray{.origin = from, .direction = {across * std::cos(phi), across * std::sin(phi), z}};
    ElementHit hit;
    caster.closest_hits({&ray, 1}, {&hit, 1});
    if (hit.element < 0 || hit.from_back) continue;
    Vector3d normal = element_center(caster.mesh(), hit.element).normal;
    points.push_back({from + hit.t * ray.direction, normal, hit.facet});
  }
  return points;
}

struct Result {
  double error = 0.0, asked = 0.0, seconds = 0.0;
  std::vector<double> light{};  // at each point
};

Result measure(const ElementCaster& caster, const DirectLight& light,
               const std::vector<SurfacePoint>& points, const ShadowOptions& shadows,
               const std::vector<double>& truth) {
  Result result;
  const auto query = [&](std::size_t i) {
    return LightQuery{.at = points[i], .key = static_cast<std::uint64_t>(i), .shadows = shadows};
  };
  result.seconds = seconds_of([&] {
    for (std::size_t i = 0; i < points.size(); ++i) {
      result.light.push_back(light.irradiance(caster, query(i)).mean());
    }
  });
  double squares = 0.0, mean = 0.0;
  const auto count = static_cast<double>(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    result.asked += light.asked(caster, query(i)) / count;
    if (truth.empty()) continue;
    squares += std::pow(result.light[i] - truth[i], 2) / count;
    mean += truth[i] / count;
  }
  if (mean > 0.0) result.error = std::sqrt(squares) / mean;
  return result;
}

struct Method {
  const char* name;
  ManyLights method;
  const char* colour;
};
constexpr std::array<Method, 3> methods{{{"lightcuts", ManyLights::lightcuts, "#2471a3"},
                                         {"sorted", ManyLights::sorted, "#c0392b"},
                                         {"importance", ManyLights::importance, "#1e8449"}}};
constexpr std::array<double, 4> shares{0.1, 0.03, 0.01, 0.003};

struct Curve {
  Method method;
  std::vector<std::array<double, 2>> points{};  // lights asked, error
};

std::vector<Curve> print_table(bool with_panels) {
  const Scene scene = hall(with_panels);
  const PatchMesh mesh = build_patches(scene);
  const ElementCaster caster(mesh);
  const DirectLight light(scene, mesh);
  const std::vector<SurfacePoint> points = points_in(caster);
  ShadowOptions shadows{.min_rays = 16, .max_rays = 64, .many_lights = ManyLights::all};
  const Result all = measure(caster, light, points, shadows, {});
  fmt::print("1000 {}: asking all takes {:.0f} us a point\n\n",
             with_panels ? "panels" : "point lamps", 1e6 * all.seconds / point_count);
  fmt::print("| method | share | lights asked | error | time |\n|---|---|---|---|---|\n");
  std::vector<Curve> curves;
  for (const Method& method : methods) {
    curves.push_back({method});
    for (const double share : shares) {
      shadows.many_lights = method.method;
      shadows.cluster_share = share;
      const Result found = measure(caster, light, points, shadows, all.light);
      fmt::print("| {} | {:g} % | {:.0f} | {:.2f} % | {:.2f} |\n", method.name, 100.0 * share,
                 found.asked, 100.0 * found.error, found.seconds / all.seconds);
      std::fflush(stdout);
      curves.back().points.push_back({found.asked, found.error});
    }
  }
  fmt::print("\n");
  return curves;
}

// Error over lights asked, both logarithmic.
std::string panel(const std::vector<Curve>& curves, const char* title, double left) {
  constexpr double low_x = 0.5, high_x = 3.0, low_y = -4.0, high_y = -0.5;  // powers of ten
  constexpr double panel_width = 300.0, panel_height = 260.0, top = 40.0;
  const auto place = [&](double x, double y) {
    const double px = std::clamp(std::log10(std::max(x, 1e-9)), low_x, high_x),
                 py = std::clamp(std::log10(std::max(y, 1e-9)), low_y, high_y);
    return std::array{left + panel_width * (px - low_x) / (high_x - low_x),
                      top + panel_height * (high_y - py) / (high_y - low_y)};
  };
  std::string svg = fmt::format("<text x=\"{}\" y=\"24\" text-anchor=\"middle\">{}</text>\n",
                                left + 0.5 * panel_width, title);
  for (const double x : {10.0, 100.0, 1000.0}) {
    const auto [px, py] = place(x, 1e-4);
    svg += fmt::format(
        "<path d=\"M{0} {1}V{2}\" stroke=\"#ddd\"/><text x=\"{0}\" y=\"{3}\" "
        "text-anchor=\"middle\">{4}</text>\n",
        px, py, top, py + 18, x);
  }
  for (const double y : {1e-4, 1e-3, 1e-2, 1e-1}) {
    const auto [px, py] = place(1.0, y);
    svg += fmt::format(
        "<path d=\"M{0} {1}H{2}\" stroke=\"#ddd\"/><text x=\"{3}\" y=\"{4}\" "
        "text-anchor=\"end\">{5:g} %</text>\n",
        px, py, left + panel_width, left - 6, py + 4, 100.0 * y);
  }
  double row = top + panel_height - 60.0;
  for (const Curve& curve : curves) {
    std::string path;
    for (const auto& [x, y] : curve.points) {
      const auto [px, py] = place(x, y);
      path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", px, py);
      svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"/>\n", px, py,
                         curve.method.colour);
    }
    svg += fmt::format(
        "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"/>\n"
        "<text x=\"{}\" y=\"{}\" fill=\"{}\">{}</text>\n",
        path, curve.method.colour, left + 12, row, curve.method.colour, curve.method.name);
    row += 18.0;
  }
  return svg;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<Curve> panels = print_table(true), lamps = print_table(false);
  if (argc < 2) return 0;
  std::ofstream(argv[1]) << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 760 350\" "
                            "font-family=\"sans-serif\" font-size=\"12\">\n"
                            "<rect width=\"760\" height=\"350\" fill=\"white\"/>\n"
                         << panel(panels, "1000 panels: error over lights asked", 60.0)
                         << panel(lamps, "1000 point lamps: error over lights asked", 430.0)
                         << "</svg>\n";
  return 0;
}
