// Light is linear in emission: B = sum over channels of s_c B_c. With each luminaire in a channel
// of its own a lamp is dimmed by relight(), without solving again.
#include <chrono>
#include <cmath>
#include <cstdio>

#include "radiosity/solution/relight.h"
#include "radiosity/solve.h"
#include "scene/io/read_scene.h"

using namespace lightwell;

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Area-weighted mean of the radiosity of all patches and bands, W/m^2.
double mean_radiosity(const SolvedScene& solved) {
  const Eigen::ArrayXd B = solved.solution.patch_radiosity.cast<double>().rowwise().mean();
  return (B * solved.mesh.area).sum() / solved.mesh.area.sum();
}

int main(int argc, char** argv) {
  Scene scene = read_scene(argc > 1 ? argv[1] : "cornell/cornell.toml");
  // A bulb beside the lamps of the file: 3 W/sr per band, the same in all directions.
  scene.lamps.push_back({.name = "bulb",
                         .position = {0.45, 0.4, 0.12},  // metres
                         .intensity = constant_spectrum(scene.bands, 3)});
  validate(scene);

  SolveOptions options;
  options.channels = channels_per_luminaire(scene);
  options.refine.tolerance = 0;  // means over patches need neither finer elements
  options.gather.rays = 64;      // nor a good final gather
  double start = seconds();
  SolvedScene dimmed = solve_scene(scene, options);
  std::printf("bulb at 100 %%: mean radiosity %.5f W/m2, solved in %.3f s\n",
              mean_radiosity(dimmed), seconds() - start);

  std::vector<Spectrum> scales = effective_scales(dimmed.solution);  // one for each channel
  scales[find_channel(dimmed.solution, "bulb")] *= 0.3f;
  start = seconds();
  relight(dimmed, scales);
  const double B = mean_radiosity(dimmed);
  std::printf("bulb at 30 %%:  mean radiosity %.5f W/m2, relit in %.3f s\n", B, seconds() - start);

  scene.lamps.back().intensity *= 0.3f;
  const double expected = mean_radiosity(solve_scene(scene, options));
  std::printf("bulb at 30 %%:  mean radiosity %.5f W/m2, solved again\n", expected);
  // Both solves trace the same rays. Each stops when the error of B is below 1e-5 of the largest B
  // (SolverOptions::tolerance).
  return std::abs(B / expected - 1) < 1e-4 ? 0 : 1;
}
