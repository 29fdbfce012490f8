// Error of irradiance over the number of elements and over time, with and without refinement by the
// solution.
//
//   refinement_bench [SCENE.toml [PLOT.svg]]     default: the diffuse Cornell box
//
// Even elements of falling size and refined elements of falling tolerance, all with the same patch
// size: RMS difference over the mean between interpolated irradiance and irradiance gathered with
// many rays, at random points of reflecting surfaces; and the time of refinement as a share of all
// other phases. Seconds are processor seconds, which do not depend on other work on the machine.
// With PLOT.svg the program draws error over elements.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <fstream>
#include <string>
#include <vector>

#include "mesh/patches/patch_sampler.h"
#include "radiosity/solve.h"
#include "scene/io/read_scene.h"
#include "scene/parallel.h"
#include "scene/sampling.h"

namespace {

using namespace lightwell;

struct Truth {
  std::vector<GatherPoint> points{};
  BandArray irradiance{};
  double mean = 0.0;
};

Truth truth_of(const Scene& scene) {
  constexpr int count = 4096, edge = 4, rays = 8192;
  const SolvedScene fine =
      solve_scene(scene, {.mesh = {.elements_per_patch_edge = edge}, .refine = {.tolerance = 0.0}});
  const ElementCaster caster(fine.mesh);
  const DirectLight direct_light(scene, fine.mesh);
  std::vector<double> area_to(fine.mesh.patch_count());
  double total = 0.0;
  for (int p = 0; p < fine.mesh.patch_count(); ++p) {
    const bool counts = (fine.mesh.reflectance.row(p) > 0.0f).any() && !caster.hidden_elements(p);
    if (counts) total += fine.mesh.area[p];
    area_to[p] = total;
  }
  Truth truth;
  const SobolPoints sobol(count);
  for (int i = 0; i < count; ++i) {
    const Eigen::Array4f u = sobol.point(i, 1);
    const auto at = std::upper_bound(area_to.begin(), area_to.end() - 1, u[0] * total);
    const PatchPoint point =
        PatchSampler(fine.mesh, static_cast<int>(at - area_to.begin())).point(u[1], u[2]);
    truth.points.push_back({point.position, point.normal, fine.mesh.facet[point.element]});
  }
  const GatheredIrradiance gathered = gather_irradiance(
      {scene, caster, direct_light},
      gatherable_radiosity(fine.mesh, direct_light, fine.solution.irradiance()), truth.points,
      {.rays = rays, .shadows = {.min_rays = 256, .max_rays = 256}, .replica = 7});
  truth.irradiance = gathered.direct + gathered.indirect;
  truth.mean = truth.irradiance.cast<double>().mean();
  return truth;
}

double rms_error(const SolvedScene& solved, const Truth& truth) {
  const ElementCaster caster(solved.mesh);
  const BandArray E = solved.solution.irradiance();
  double sum = 0.0;
  for (std::size_t i = 0; i < truth.points.size(); ++i) {
    const GatherPoint& at = truth.points[i];
    constexpr double above = 1e-5;
    const Ray ray{.origin = at.position + above * at.normal, .direction = -at.normal};
    ElementHit hit;
    caster.closest_hits({&ray, 1}, {&hit, 1});
    if (hit.element < 0) continue;
    const Eigen::ArrayXd off = (interpolate(solved.mesh, E, hit) -
                                truth.irradiance.row(static_cast<Eigen::Index>(i)).transpose())
                                   .cast<double>();
    sum += off.square().mean() / static_cast<double>(truth.points.size());
  }
  return std::sqrt(sum) / truth.mean;
}

struct Row {
  int elements = 0;
  double error = 0.0, seconds = 0.0;
};

double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

Row measure(const Scene& scene, const Truth& truth, const SolveOptions& options,
            const std::string& name) {
  const double start = cpu_seconds();
  SolveReport report;
  const SolvedScene solved = solve_scene(scene, options, &report);
  const Row row{.elements = solved.mesh.element_count(),
                .error = rms_error(solved, truth),
                .seconds = cpu_seconds() - start};
  double all = 0.0, refining = 0.0;
  for (const PhaseSeconds& phase : solved.solution.seconds) {
    all += phase.seconds;
    if (phase.phase == "refine") refining = phase.seconds;
  }
  fmt::print("{:>14} {:8} elements  error {:.3f} %  {:7.2f} s", name, row.elements,
             100.0 * row.error, row.seconds);
  if (report.refinement.outcome != RefineOutcome::off) {
    fmt::print("  refining takes {:.2f} of what all else does; {} gathers; {}",
               refining / (all - refining), report.refinement.gathers, sentence(report.refinement));
  }
  fmt::print("\n");
  return row;
}

const std::string even_colour = "#c0392b", refined_colour = "#2471a3";
constexpr double width = 560, height = 300, left = 70, top = 40;

// Point of the plot: elements from 10^3 to 10^5 and errors from 0.1 to 10 %, both logarithmic.
std::array<double, 2> place(double elements, double error) {
  constexpr double decades = 2.0;
  return {left + width * (std::log10(elements) - 3.0) / decades,
          top + height * (-1.0 - std::log10(error)) / decades};
}

std::string curve(const std::vector<Row>& rows, const std::string& colour) {
  std::string path, dots;
  for (const Row& row : rows) {
    const auto [x, y] = place(row.elements, row.error);
    path += fmt::format("{}{:.1f} {:.1f} ", path.empty() ? "M" : "L", x, y);
    dots +=
        fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"/>\n", x, y, colour);
  }
  return fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"/>\n{}", path,
                     colour, dots);
}

void draw(const std::string& file, const std::vector<Row>& even, const std::vector<Row>& refined) {
  std::ofstream out(file);
  out << R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 660 400" font-family="sans-serif" font-size="12">)"
      << "\n<rect width=\"660\" height=\"400\" fill=\"white\"/>\n";
  for (const double elements : {1e3, 1e4, 1e5}) {
    const auto [x, low] = place(elements, 1e-3);
    out << fmt::format(
        "<path d=\"M{0:.1f} {1:.1f} V{2:.1f}\" stroke=\"#ddd\"/>\n"
        "<text x=\"{0:.1f}\" y=\"{3:.1f}\" text-anchor=\"middle\">{4:.0f}</text>\n",
        x, top, low, low + 18, elements);
  }
  for (const double error : {0.1, 0.01, 0.001}) {
    const auto [low, y] = place(1e3, error);
    out << fmt::format(
        "<path d=\"M{0:.1f} {1:.1f} H{2:.1f}\" stroke=\"#ddd\"/>\n"
        "<text x=\"{3:.1f}\" y=\"{4:.1f}\" text-anchor=\"end\">{5:g} %</text>\n",
        low, y, left + width, left - 6, y + 4, 100 * error);
  }
  out << curve(even, even_colour) << curve(refined, refined_colour)
      << fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">elements</text>\n",
                     left + width / 2, top + height + 38)
      << fmt::format(
             "<text x=\"{}\" y=\"24\" text-anchor=\"middle\">RMS error of irradiance, of "
             "the mean</text>\n",
             left + width / 2)
      << fmt::format("<text x=\"430\" y=\"70\" fill=\"{}\">even elements</text>\n", even_colour)
      << fmt::format("<text x=\"430\" y=\"90\" fill=\"{}\">refined by the solution</text>\n",
                     refined_colour)
      << "</svg>\n";
}

}  // namespace

int main(int argc, char** argv) {
  const Scene scene = read_scene(argc > 1 ? argv[1] : LIGHTWELL_CORNELL "/cornell.toml");
  fmt::print("scene {}, {} threads\n", scene.file.string(), thread_count());
  const Truth truth = truth_of(scene);
  std::vector<Row> even, refined;
  for (const int edge : {1, 2, 3, 4, 6}) {
    even.push_back(measure(
        scene, truth, {.mesh = {.elements_per_patch_edge = edge}, .refine = {.tolerance = 0.0}},
        fmt::format("even, {} each", edge)));
  }
  constexpr std::int64_t plenty = 1000000;
  for (const double percent : {4.0, 2.0, 1.0, 0.7, 0.5, 0.35, 0.25}) {
    refined.push_back(
        measure(scene, truth,
                {.refine = {.tolerance = 0.01 * percent, .max_elements = plenty, .max_level = 4}},
                fmt::format("refined, {:g} %", percent)));
  }
  if (argc > 2) draw(argv[2], even, refined);
}
