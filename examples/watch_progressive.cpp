// Progressive refinement (Cohen, Chen, Wallace & Greenberg 1988): the patches with the most unshot
// power shoot first, so that most of the light has arrived after few shots. This program stops when
// 2 % of the power is left.
#include <cmath>
#include <cstdio>

#include "mesh/build_patches.h"
#include "mesh/elements/element_caster.h"
#include "radiosity/paths/light_path.h"
#include "radiosity/solvers/progressive.h"
#include "scene/io/read_scene.h"

using namespace lightwell;

int main(int argc, char** argv) {
  const Scene scene = read_scene(argc > 1 ? argv[1] : "cornell/cornell.toml");
  const PatchMesh mesh = build_patches(scene);
  const ElementCaster caster(mesh);
  const LightPaths paths(scene, caster, 8);  // follows at most 8 mirrors and panes of glass
  const DirectLight direct_light(scene, mesh);
  const FreeLight lamps = cast_free_light(scene, caster, paths, direct_light);

  const ProgressiveOptions options;
  ProgressiveRadiosity progressive(scene, mesh, cast_shots(caster, paths, options.most_rays),
                                   options, {}, lamps);
  std::printf("%d patches\n%8s %14s\n", mesh.patch_count(), "shots", "unshot share");
  int print_at = 1;
  while (progressive.unshot_share() > 0.02 && progressive.step()) {  // a round of shots
    if (progressive.shots() < print_at) continue;
    std::printf("%8d %12.2f %%\n", progressive.shots(), 100 * progressive.unshot_share());
    print_at = 2 * progressive.shots();
  }

  const EnergyBalance watts = progressive.energy();
  std::printf(
      "stopped after %d shots: %.3f W emitted = %.3f absorbed + %.3f escaped + %.3f unshot\n",
      progressive.shots(), watts.emitted, watts.absorbed, watts.escaped, watts.unshot);
  // No energy may be lost. The rounding of floats, 6e-8 in each shot, grows with the root of their
  // number: 4e-6 after 4000 shots.
  const double lost = watts.emitted - watts.absorbed - watts.escaped - watts.unshot;
  return std::abs(lost) < 1e-5 * watts.emitted && progressive.unshot_share() <= 0.02 ? 0 : 1;
}
