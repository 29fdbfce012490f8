// Error of a solve over its time, and its dependence on the tessellation of the scene.
//
//   rooms_bench
//
// Two scenes of sizes that radiosity programs were measured with before:
// - a furnished room of 41 polygons, cut into 708 and into 2832 polygons, also with one surface per
//   polygon;
// - 30 000 patches with 2000 shots (Cohen, Chen, Wallace & Greenberg 1988, "A progressive
// refinement
//   approach to fast radiosity image generation", whose hall took five hours), here a room of 100
//   boxes.
// The error is that of irradiance interpolated at 2000 random points. The reference is a gather of
// 8192 rays at each point, which read reflected light from a solution many times as exact as the
// others. Peak memory is that of the process during a solve on Linux, where the
// peak can be reset; on other systems, since the start.
#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <fstream>
#include <string>
#include <vector>

#include "bench/rooms.h"
#include "bench/stopwatch.h"
#include "mesh/build_patches.h"
#include "mesh/cleaning/planar_regions.h"
#include "mesh/patches/patch_sampler.h"
#include "radiosity/rows/memory_budget.h"
#include "radiosity/solve.h"
#include "raytrace/readings/probe.h"
#include "scene/parallel.h"
#include "scene/sampling.h"

namespace {

using namespace lightwell;

struct Case {
  std::string name{};
  SolveOptions options{};
};

struct Result {
  std::string name{};
  int patches = 0, elements = 0;
  double seconds = 0.0, processor_seconds = 0.0, megabytes = 0.0, estimate = 0.0;
  std::vector<PhaseSeconds> phases{};
  BandArray irradiance{};
};

// Resets the process's peak memory; does nothing but on Linux.
void forget_peak_memory() {
  give_back_free_pages();
  std::ofstream("/proc/self/clear_refs") << "5";  // proc(5): sets VmHWM to VmRSS
}

double peak_megabytes() {
  constexpr double megabyte = 1 << 20;
  return static_cast<double>(resident_memory().most) / megabyte;
}

// Random points on reflecting surfaces that are not hidden, uniform by area.
std::vector<Probe> random_places(const Scene& scene, int count) {
  const PatchMesh mesh = build_patches(scene);
  const ElementCaster caster(mesh);
  std::vector<double> area_to(mesh.patch_count());
  double total = 0.0;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    const bool counts = caster.hidden_elements(p) == 0 && (mesh.reflectance.row(p) > 0.0f).any();
    area_to[p] = total += counts ? mesh.area[p] : 0.0;
  }
  std::vector<Probe> places;
  for (int i = 0; i < count; ++i) {
    const std::uint64_t key = random_key(static_cast<std::uint64_t>(i), 77);
    const double at = (i + random_uniform(random_key(key, 0))) / count * total;
    const auto p = static_cast<int>(std::upper_bound(area_to.begin(), area_to.end() - 1, at) -
                                    area_to.begin());
    const PatchPoint point = PatchSampler(mesh, p).point(random_uniform(random_key(key, 1)),
                                                         random_uniform(random_key(key, 2)));
    places.push_back({point.position, point.normal});
  }
  return places;
}

// Times a whole solve, from raw polygons to the solution.
Result measure(const Scene& scene, const Case& what, const std::vector<Probe>& places) {
  Result result{.name = what.name};
  forget_peak_memory();
  const std::clock_t start = std::clock();
  SolvedScene solved;
  result.seconds =
      seconds_of([&] { solved = solve_scene(merge_planar_regions(scene), what.options); });
  result.processor_seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  result.megabytes = peak_megabytes();
  result.patches = solved.mesh.patch_count();
  result.elements = solved.mesh.element_count();
  result.phases = solved.solution.seconds;
  result.estimate = solved.solution.error_estimate;
  result.irradiance = interpolate_irradiance(ElementCaster(solved.mesh), solved.solution, places);
  return result;
}

BandArray reference(const Scene& raw, double accuracy, const std::vector<Probe>& places) {
  const Scene scene = merge_planar_regions(raw);
  const SolvedScene solved = solve_scene(scene, {.accuracy = Accuracy{.share = accuracy}});
  const ElementCaster caster(solved.mesh);
  return probe_irradiance(scene, caster, DirectLight(scene, solved.mesh), solved.solution, places,
                          {.rays = 8192, .shadows = {.min_rays = 256, .max_rays = 256}});
}

void print(const std::vector<Result>& results, const BandArray& truth) {
  const double mean = truth.cast<double>().mean();
  for (const Result& r : results) {
    const auto error = (r.irradiance - truth).cast<double>();
    fmt::print(
        "{:<46} {:5.2f} CPU s {:5.2f} s {:5.0f} MB {:6} patches {:6} elements  "
        "error {:.2f} %  (estimated {:.2f} %) ",
        r.name, r.processor_seconds, r.seconds, r.megabytes, r.patches, r.elements,
        100.0 * std::sqrt(error.square().mean()) / mean, 100.0 * r.estimate);
    for (const PhaseSeconds& phase : r.phases) fmt::print(" {} {:.2f}", phase.phase, phase.seconds);
    fmt::print(" s\n");
  }
  std::fflush(stdout);
}

SolveOptions to(double accuracy) {
  return {.accuracy = Accuracy{.share = accuracy}};
}

// Large patches, few rays, and elements cut along the bounds of shadows.
SolveOptions coarse_room() {
  return {.mesh = {.max_patch_size = 0.14, .elements_per_patch_edge = 3, .discontinuity = true},
          .form_factors = {.rays_per_patch = 32},
          .gather = {.rays = 128},
          .refine = {.tolerance = 0.0}};
}

void furnished_room() {
  const Scene whole = room_of_polygons(0);
  const std::vector<Probe> places = random_places(merge_planar_regions(whole), 2000);
  std::vector<Result> results;
  for (const auto& [cells, own_names] :
       {std::pair(0, false), {10, false}, {20, false}, {0, true}, {10, true}, {20, true}}) {
    const Scene scene = room_of_polygons(cells, own_names);
    const std::string in =
        fmt::format("{} {}, ", scene_facets(scene).size(), own_names ? "surfaces" : "polygons");
    results.push_back(
        measure(scene, {in + "large patches, --discontinuity", coarse_room()}, places));
    for (const double percent : {5.0, 2.0, 1.4}) {
      results.push_back(measure(
          scene, {in + fmt::format("--accuracy {}%", percent), to(0.01 * percent)}, places));
    }
    results.push_back(measure(scene, {in + "default options", {}}, places));
  }
  print(results, reference(whole, 0.003, places));
}

void hall_of_1988() {
  const Scene scene = room_of_boxes();
  const std::vector<Probe> places = random_places(merge_planar_regions(scene), 2000);
  SolveOptions shots{.mesh = {.max_patch_size = 0.13, .elements_per_patch_edge = 1},
                     .progressive = ProgressiveOptions{.max_shots = 2000},
                     .gather = {.rays = 64, .shadows = {.min_rays = 16, .max_rays = 64}},
                     .refine = {.tolerance = 0.0}};
  std::vector<Result> results;
  results.push_back(measure(scene, {"2000 shots of 30 000 patches", shots}, places));
  for (const double percent : {6.5, 5.0, 2.0, 1.15, 1.0}) {
    results.push_back(
        measure(scene, {fmt::format("--accuracy {}%", percent), to(0.01 * percent)}, places));
  }
  print(results, reference(scene, 0.015, places));
}

}  // namespace

int main() {
  fmt::print("{} threads\n", thread_count());
  hall_of_1988();
  furnished_room();
}
