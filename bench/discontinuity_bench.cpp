// Error of direct light over the number of elements, with and without receivers cut along critical
// lines.
//
//   discontinuity_bench [PLOT.svg]
//
// A rectangular lamp over a half plane (lines of first degree), a triangular lamp over a square
// (second degree alone) and the Cornell box: the largest and the RMS difference on the floor
// between the true form factor of the lamp and the interpolation of true values at the vertices,
// for even elements and for elements cut along the lines. True values are found by clipping,
// without samples. With PLOT.svg the program draws the errors and their profile across the half
// plane's penumbra.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "bench/grey_scene.h"
#include "mesh/build_patches.h"
#include "mesh/elements/element_caster.h"
#include "mesh/patches/element_quality.h"
#include "radiosity/visibility/point_form_factor.h"
#include "scene/io/read_scene.h"
#include "scene/parallel.h"

namespace {

using namespace lightwell;
using Eigen::Vector3d;

void add_polygon(Scene& scene, const std::string& name, int material,
                 std::vector<Vector3d> vertices) {
  PolygonMesh mesh{.vertices = std::move(vertices), .facets = {{}}};
  for (int i = 0; i < static_cast<int>(mesh.vertices.size()); ++i) {
    mesh.facets[0].boundary.push_back(i);
  }
  scene.surfaces.push_back({.name = name, .material = material, .shape = std::move(mesh)});
}

// Floor (facet 0), lamp at z = 2 (facet 1, clockwise as seen from above) and screen at z = 1.
Scene shadow_scene(const std::vector<Vector3d>& lamp, const std::vector<Vector3d>& screen) {
  Scene scene = grey_scene();
  Material light = scene.materials[0];
  light.name = "light";
  light.emission = constant_spectrum(scene.bands, static_cast<float>(std::numbers::pi));
  scene.materials.push_back(light);
  add_polygon(scene, "floor", 0,
              {{-1.317, -1.213, 0}, {1.231, -1.213, 0}, {1.231, 1.127, 0}, {-1.317, 1.127, 0}});
  add_polygon(scene, "lamp", 1, lamp);
  add_polygon(scene, "screen", 0, screen);
  validate(scene);
  return scene;
}

Scene half_plane() {
  return shadow_scene({{-0.5, -0.5, 2}, {-0.5, 0.5, 2}, {0.5, 0.5, 2}, {0.5, -0.5, 2}},
                      {{-9, -9, 1}, {0, -9, 1}, {0, 9, 1}, {-9, 9, 1}});
}

Scene triangle_over_square() {
  return shadow_scene({{0.05, 0.5, 2}, {0.5, -0.2, 2}, {-0.4, -0.3, 2}},
                      {{-0.3, -0.3, 1}, {0.3, -0.3, 1}, {0.3, 0.3, 1}, {-0.3, 0.3, 1}});
}

struct Quality {
  int elements = 0;  // of the receiver
  double most = 0.0, rms = 0.0;
  double seconds = 0.0;                          // of meshing the scene
  double least_angle = 180.0;                    // degrees
  std::vector<std::array<double, 2>> profile{};  // x, and error of F there, along one line
};

// True form factors from points of the receiver to all emitting patches by exact clipping. Patches
// are larger than the scene, so that every patch of the emitter is a whole facet.
class Truth {
 public:
  explicit Truth(const Scene& scene)
      : mesh_(build_patches(scene, {.max_patch_size = 1e3 * scene_bounds(scene).diagonal()})),
        caster_(mesh_),
        factors_(caster_) {
    for (int p = 0; p < mesh_.patch_count(); ++p) {
      if ((mesh_.emission.row(p) > 0.0f).any()) emitters_.push_back(p);
    }
  }
  std::vector<double> at(const std::vector<ReceivingPoint>& points) const {
    std::vector<double> sum(points.size(), 0.0), F(points.size());
    for (const int emitter : emitters_) {
      factors_.by_closed_form(emitter, points, F, {.max_rays = 4096, .target_error = 1e-6});
      for (std::size_t i = 0; i < F.size(); ++i) sum[i] += F[i];
    }
    return sum;
  }

 private:
  PatchMesh mesh_;
  ElementCaster caster_;
  PointFormFactors factors_;
  std::vector<int> emitters_;
};

// Errors along a line beside the floor's middle that coincides with no mesh line.
std::vector<std::array<double, 2>> profile(const PatchMesh& mesh, const Truth& truth,
                                           const Eigen::ArrayX4d& corner_F) {
  Eigen::AlignedBox3d box;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (mesh.facet[e] != 0) continue;
    for (int i = 0; i < mesh.corner_count(e); ++i) box.extend(mesh.position(mesh.corners[e][i]));
  }
  constexpr int count = 500;
  std::vector<Ray> rays(count);
  std::vector<ReceivingPoint> points(count);
  for (int i = 0; i < count; ++i) {
    points[i].position = box.center() + 0.02137 * box.diagonal().norm() * Vector3d::UnitY();
    points[i].position.x() = box.min().x() + (i + 0.5) / count * box.sizes().x();
    points[i].facet = 0;
    rays[i] = {.origin = points[i].position + 0.5 * Vector3d::UnitZ(),
               .direction = -Vector3d::UnitZ()};
  }
  std::vector<ElementHit> hits(count);
  ElementCaster(mesh).closest_hits(rays, hits);
  const std::vector<double> F = truth.at(points);
  std::vector<std::array<double, 2>> errors;
  for (int i = 0; i < count; ++i) {
    if (hits[i].facet != 0 || hits[i].element < 0) continue;
    const Eigen::Array4d weights = hits[i].weights.cast<double>();
    const double mixed = (weights * corner_F.row(hits[i].element).transpose()).sum();
    errors.push_back({points[i].position.x(), mixed - F[i]});
  }
  return errors;
}

// Errors on facet 0: in each element the corners, where the solver places them, are interpolated at
// 16 inner points.
Quality quality(const Scene& scene, const Truth& truth, const MeshOptions& options) {
  Quality result;
  const auto start = std::chrono::steady_clock::now();
  const PatchMesh mesh = build_patches(scene, options);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  constexpr int side = 4, inside = side * side;
  std::vector<ReceivingPoint> points;
  std::vector<int> elements;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (mesh.facet[e] != 0 || mesh.is_back[mesh.patch[e]] != 0) continue;
    elements.push_back(e);
    for (int i = 0; i < 4; ++i) {  // a triangle repeats its last corner
      points.push_back(receiving_corner(mesh, e, std::min(i, mesh.corner_count(e) - 1)));
    }
    for (int k = 0; k < inside; ++k) {
      const double s = (k % side + 0.5) / side, t = (k / side + 0.5) / side;
      const std::size_t first = points.size() - 4 - static_cast<std::size_t>(k);
      const std::array p{points[first], points[first + 1], points[first + 2], points[first + 3]};
      ReceivingPoint q = p[0];
      q.position = (1 - t) * ((1 - s) * p[0].position + s * p[1].position) +
                   t * ((1 - s) * p[3].position + s * p[2].position);
      points.push_back(q);
    }
  }
  const std::vector<double> E = truth.at(points);
  Eigen::ArrayX4d corner_F = Eigen::ArrayX4d::Zero(mesh.element_count(), 4);
  double squares = 0.0, area = 0.0;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const std::size_t first = i * (4 + inside);
    const double* corner = &E[first];
    const double weight = mesh.element_area[elements[i]] / inside;
    for (int k = 0; k < inside; ++k) {
      const double s = (k % side + 0.5) / side, t = (k / side + 0.5) / side;
      const double mixed = (1 - t) * ((1 - s) * corner[0] + s * corner[1]) +
                           t * ((1 - s) * corner[3] + s * corner[2]);
      const double off = mixed - E[first + 4 + static_cast<std::size_t>(k)];
      result.most = std::max(result.most, std::abs(off));
      squares += weight * off * off;
      area += weight;
    }
    result.least_angle =
        std::min(result.least_angle, element_shape(mesh, elements[i]).least_angle_degrees);
    for (int k = 0; k < 4; ++k) corner_F(elements[i], k) = corner[k];
  }
  result.profile = profile(mesh, truth, corner_F);
  result.elements = static_cast<int>(elements.size());
  result.rms = std::sqrt(squares / area);
  return result;
}

struct Row {
  Quality cut, even;
};

// Cut elements beside even ones of about the same number, never fewer.
std::vector<Row> compare(const Scene& scene, const std::string& name, double unit,
                         const std::vector<double>& sizes) {
  const Truth truth(scene);
  std::vector<Row> rows;
  fmt::print("{}: floor elements, largest and RMS error of F\n", name);
  for (const double size : sizes) {
    Row& row = rows.emplace_back();
    row.cut = quality(scene, truth, {.max_patch_size = size * unit, .discontinuity = true});
    double finer = size * unit;
    do {
      row.even = quality(scene, truth, {.max_patch_size = finer});
      finer *= std::min(0.995, std::sqrt(row.even.elements / double(row.cut.elements)));
    } while (row.even.elements < row.cut.elements);
    fmt::print(
        "  cut {:5} {:.2e} {:.2e}   even {:5} {:.2e} {:.2e}   {:4.1f} and {:4.1f} times better; "
        "least angle {:.1f}, {:.3f} s\n",
        row.cut.elements, row.cut.most, row.cut.rms, row.even.elements, row.even.most, row.even.rms,
        row.even.most / row.cut.most, row.even.rms / row.cut.rms, row.cut.least_angle,
        row.cut.seconds);
  }
  return rows;
}

constexpr double panel_width = 330, panel_height = 270, panel_top = 40;

std::string line(const std::vector<std::array<double, 2>>& points, const std::string& style) {
  std::string path;
  for (const auto& [x, y] : points) {
    path += fmt::format("{}{:.1f} {:.1f} ", path.empty() ? "M" : "L", x, y);
  }
  return fmt::format("<path d=\"{}\" fill=\"none\" {}/>\n", path, style);
}

std::string text(double x, double y, const std::string& what, const std::string& more = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", x, y, more, what);
}

const std::string centred = "text-anchor=\"middle\"", to_left = "text-anchor=\"end\"";
const std::string cut_colour = "#2471a3", even_colour = "#c0392b";

// Error of F across the penumbra of the half plane.
std::string profile_panel(const Row& row, double left) {
  constexpr double low_x = -0.9, high_x = 0.9, high_y = 0.0006;
  const auto place = [&](double x, double y) {
    return std::array{left + panel_width * (x - low_x) / (high_x - low_x),
                      panel_top + panel_height * 0.5 * (1.0 - y / high_y)};
  };
  std::string svg;
  for (const double x : {-0.5, 0.0, 0.5}) {
    svg += line({place(x, -high_y), place(x, high_y)}, "stroke=\"#ddd\"") +
           text(place(x, 0)[0], panel_top + panel_height + 18, fmt::format("{}", x), centred);
  }
  for (const double y : {-high_y, -0.5 * high_y, 0.0, 0.5 * high_y, high_y}) {
    svg += line({place(low_x, y), place(high_x, y)}, "stroke=\"#ddd\"") +
           text(left - 6, place(0, y)[1] + 4, fmt::format("{:g}", y), to_left);
  }
  for (const bool is_cut : {false, true}) {
    std::vector<std::array<double, 2>> points;
    for (const auto& [x, y] : (is_cut ? row.cut : row.even).profile) {
      if (x > low_x && x < high_x) points.push_back(place(x, std::clamp(y, -high_y, high_y)));
    }
    svg += line(points, fmt::format("stroke=\"{}\" stroke-width=\"1.5\"",
                                    is_cut ? cut_colour : even_colour));
  }
  return svg +
         text(left + panel_width / 2, panel_top + panel_height + 38,
              "x across the half plane's penumbra, which ends at -0.5 and 0.5", centred) +
         text(left + panel_width / 2, panel_top - 12,
              fmt::format("error of F: {} elements cut, {} even", row.cut.elements,
                          row.even.elements),
              centred);
}

// Largest error over the number of elements, both logarithmic.
std::string error_panel(const std::vector<Row>& half, const std::vector<Row>& triangle,
                        double left) {
  constexpr double low_x = 2.0, high_x = 4.0, low_y = -4.7, high_y = -2.5;  // powers of ten
  const auto place = [&](double x, double y) {
    return std::array{left + panel_width * (x - low_x) / (high_x - low_x),
                      panel_top + panel_height * (high_y - y) / (high_y - low_y)};
  };
  std::string svg;
  for (const int p : {2, 3, 4}) {
    svg += line({place(p, low_y), place(p, high_y)}, "stroke=\"#ddd\"") +
           text(place(p, 0)[0], panel_top + panel_height + 18, fmt::format("10^{}", p), centred);
  }
  for (const int p : {-4, -3}) {
    svg += line({place(low_x, p), place(high_x, p)}, "stroke=\"#ddd\"") +
           text(left - 6, place(0, p)[1] + 4, fmt::format("10^{}", p), to_left);
  }
  for (const auto& [rows, dash] :
       {std::pair(&half, ""), std::pair(&triangle, " stroke-dasharray=\"6 4\"")}) {
    for (const bool is_cut : {false, true}) {
      std::vector<std::array<double, 2>> points;
      for (const Row& row : *rows) {
        const Quality& q = is_cut ? row.cut : row.even;
        points.push_back(place(std::log10(q.elements), std::log10(q.most)));
      }
      svg += line(points, fmt::format("stroke=\"{}\" stroke-width=\"2\"{}",
                                      is_cut ? cut_colour : even_colour, dash));
    }
  }
  return svg +
         text(left + panel_width / 2, panel_top + panel_height + 38, "elements of the floor",
              centred) +
         text(left + panel_width / 2, panel_top - 12,
              "largest error of F: half plane, triangle (dashed)", centred);
}

void draw(const std::string& file, const std::vector<Row>& half, const std::vector<Row>& triangle) {
  std::ofstream out(file);
  out << R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 820 390" font-family="sans-serif" font-size="12">)"
      << "\n<rect width=\"820\" height=\"390\" fill=\"white\"/>\n"
      << profile_panel(half[4], 60) << error_panel(half, triangle, 470)
      << text(60, 378, "cut along critical lines", fmt::format("fill=\"{}\"", cut_colour))
      << text(230, 378, "even elements", fmt::format("fill=\"{}\"", even_colour)) << "</svg>\n";
}

}  // namespace

int main(int argc, char** argv) {
  fmt::print("{} threads\n", thread_count());
  const std::vector<double> sizes{0.4, 0.28, 0.2, 0.14, 0.1, 0.07};
  const std::vector<Row> half = compare(half_plane(), "square lamp, half plane", 1.0, sizes);
  const std::vector<Row> triangle =
      compare(triangle_over_square(), "triangular lamp, square", 1.0, sizes);
  const Scene cornell = read_scene(LIGHTWELL_CORNELL "/cornell.toml");
  compare(cornell, "Cornell box", 0.2, {0.4, 0.28, 0.2, 0.14});
  if (argc > 1) draw(argv[1], half, triangle);
}
