// Cost of light channels, and time of relighting.
//
//   relight_bench
//
// The diffuse Cornell box with its light cut into 4, solved without channels and with 4 channels,
// in processor seconds, which do not depend on other work on the machine. Then the weighted sum of
// 4 and of 100 channels on a mesh of 100 000 elements, beside a plain copy of the same arrays in
// memory.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <ctime>
#include <limits>

#include "bench/stopwatch.h"
#include "mesh/build_patches.h"
#include "radiosity/solution/relight.h"
#include "radiosity/solve.h"
#include "scene/io/read_scene.h"
#include "scene/parallel.h"

namespace {

using namespace lightwell;

constexpr int channel_count = 4;

// The Cornell box with the surface "light", a quadrilateral, cut into quarters.
Scene cornell_with_quartered_light() {
  Scene scene = read_scene(LIGHTWELL_CORNELL "/cornell.toml");
  const auto light = std::ranges::find(scene.surfaces, "light", &Surface::name);
  const Surface whole = *light;
  scene.surfaces.erase(light);
  const auto& v = std::get<PolygonMesh>(whole.shape).vertices;
  const auto at = [&](double s, double t) -> Eigen::Vector3d {
    return (1 - s) * (1 - t) * v[0] + s * (1 - t) * v[1] + s * t * v[2] + (1 - s) * t * v[3];
  };
  for (int i = 0; i < channel_count; ++i) {
    const double s = 0.5 * (i % 2), t = 0.5 * (i / 2);
    scene.surfaces.push_back(
        {.name = fmt::format("light {}", i + 1),
         .material = whole.material,
         .shape = PolygonMesh{
             .vertices = {at(s, t), at(s + 0.5, t), at(s + 0.5, t + 0.5), at(s, t + 0.5)},
             .facets = {{.boundary = {0, 1, 2, 3}}}}});
  }
  return scene;
}

double solve(const Scene& scene, const SolveOptions& options, const char* name) {
  const double start = static_cast<double>(std::clock());
  const SolvedScene solved = solve_scene(scene, options);
  const double seconds = (static_cast<double>(std::clock()) - start) / CLOCKS_PER_SEC;
  fmt::print("{:>12}  {} elements, {:.2f} s of all cores (", name, solved.mesh.element_count(),
             seconds);
  for (const PhaseSeconds& phase : solved.solution.seconds) {
    fmt::print(" {} {:.2f}", phase.phase, phase.seconds);
  }
  fmt::print(" )\n");
  return seconds;
}

BandArray ramp(int rows, int bands) {
  BandArray values(rows, bands);
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    values.data()[i] = static_cast<float>(i % 1009) / 1009.0f;
  }
  return values;
}

// A mesh with arbitrary light: relighting time depends on the size of the arrays alone.
SolvedScene lit_mesh(const Scene& scene, double patch_size, int channels) {
  SolvedScene lit{.mesh = build_patches(scene, {.max_patch_size = patch_size})};
  RadiositySolution& s = lit.solution;
  s.bands = scene.bands;
  const int K = s.bands.count();
  for (int c = 0; c < channels; ++c) {
    s.channels.push_back({.name = fmt::format("channel {}", c),
                          .scale = constant_spectrum(s.bands, 1.0f),
                          .patch_radiosity = ramp(lit.mesh.patch_count(), K),
                          .direct_irradiance = ramp(lit.mesh.vertex_count(), K),
                          .indirect_irradiance = ramp(lit.mesh.vertex_count(), K),
                          .energy = BandEnergy::Ones(4, K)});
  }
  s.patch_channel.assign(static_cast<std::size_t>(lit.mesh.patch_count()), 0);
  s.full_emission = ramp(lit.mesh.patch_count(), K);
  return lit;
}

double least_seconds(const std::function<void()>& work) {
  constexpr int times = 20;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < times; ++i) least = std::min(least, lightwell::seconds_of(work));
  return least;
}

void time_the_sum(const Scene& scene, int channels) {
  constexpr double patch_size = 0.0088;  // m
  SolvedScene lit = lit_mesh(scene, patch_size, channels);
  std::vector<BandArray> copies;
  for (const LightChannel& channel : lit.solution.channels) {
    for (const auto quantity : {&LightChannel::patch_radiosity, &LightChannel::direct_irradiance,
                                &LightChannel::indirect_irradiance}) {
      copies.push_back(channel.*quantity);
    }
  }
  const double copying = least_seconds([&] {
    std::size_t i = 0;
    for (const LightChannel& channel : lit.solution.channels) {
      for (const auto quantity : {&LightChannel::patch_radiosity, &LightChannel::direct_irradiance,
                                  &LightChannel::indirect_irradiance}) {
        const BandArray& from = channel.*quantity;
        std::memcpy(copies[i++].data(), from.data(),
                    sizeof(float) * static_cast<std::size_t>(from.size()));
      }
    }
  });
  float factor = 0.5f;
  const double relighting = least_seconds([&] {
    factor *= 1.001f;
    relight(lit, std::vector<Spectrum>(lit.solution.channels.size(),
                                       constant_spectrum(lit.solution.bands, factor)));
  });
  fmt::print(
      "relighting {} elements, {} vertices, {} channels: {:.2f} ms, {:.2f} times a copy of "
      "the same arrays ({:.2f} ms)\n",
      lit.mesh.element_count(), lit.mesh.vertex_count(), channels, 1e3 * relighting,
      relighting / copying, 1e3 * copying);
}

}  // namespace

int main() {
  const Scene scene = cornell_with_quartered_light();
  fmt::print("Cornell box, light in {} parts, {} threads\n", channel_count, thread_count());
  constexpr int many = 100;
  for (const int channels : {channel_count, many}) time_the_sum(scene, channels);
  SolveOptions options;
  const double together = solve(scene, options, "one channel");
  options.channels = channels_per_luminaire(scene);
  const double apart = solve(scene, options, "4 channels");
  fmt::print("4 channels take {:.2f} times as long as all light together\n", apart / together);
}
