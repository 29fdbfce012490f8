#pragma once

#include <memory>
#include <optional>
#include <string>

#include "radiosity/solve.h"

namespace lightwell {

/// Light on a mesh while it is being solved for.
struct LiveLight {
  /// At vertices, W/m^2: what was shot so far. A column for each band, or for each band of each
  /// channel after channel.
  BandArray irradiance{};
  /// What the unshot light would add everywhere, W/m^2 (Cohen et al. 1988), by the same columns.
  Eigen::ArrayXf ambient{};
  Eigen::ArrayXf unshot{};  ///< what each patch is still to shoot, lm/m^2, with all channels on
  int shots = 0;
  double unshot_share = 0.0;  ///< unshot power over emitted power, all bands together
};

enum class LivePhase {
  shooting,
  paused,
  gathering,  ///< shooting is over: light is gathered to vertices for a solution worth keeping
  done,       ///< there is a solution
  failed,
};

struct LiveState {
  LivePhase phase = LivePhase::paused;
  int shots = 0;
  double unshot_share = 1.0;
  double seconds = 0.0;     ///< of work, pauses left out
  std::string step{};       ///< what is being gathered
  double step_share = 0.0;  ///< of that done, [0,1]
  bool converged = false;   ///< the tolerance was reached before the gathering
  /// The scene has mirrors or glass, and what light they send on is seen once there is a solution.
  bool lacks_specular = false;
  std::string failure{};  ///< why, if it failed
};

/// Puts light into `shown`, which is of the mesh on which it arrives: in direct_irradiance what was
/// shot, in indirect_irradiance the ambient term or nothing. Where light is kept apart, by the
/// channels' scales in force.
void show_light(const LiveLight& light, bool with_ambient, SolvedScene& shown);

/// The convergence meter: shots, unshot power in percent of what is emitted, seconds.
std::string text_of(const LiveState& state);

/// Progressive refinement that can be watched: patches shoot, vertices receive after every shot,
/// and at the end a solution is gathered as solve_scene does. In the caller's thread with shoot()
/// and finish(), or in one of its own after start(); all members may then be called from the
/// thread that made it. With `options.channels` the light of each is kept apart from the first shot
/// on. Keeps a reference to the scene.
class LiveSolve {
 public:
  /// Cuts the scene into patches. `options.run.journal` is not used; `progress` is not by the
  /// thread that start() begins. Throws InputError where nothing emits light.
  LiveSolve(const Scene& scene, const SolveOptions& options, const Provenance& provenance);
  /// Ends the thread after the shot it is at, or within a second of gathering.
  ~LiveSolve();
  LiveSolve(const LiveSolve&) = delete;
  LiveSolve& operator=(const LiveSolve&) = delete;

  /// The mesh with no light but the emitters' own, with channels where there are any.
  SolvedScene dark() const;

  /// Shoots until `shots` patches have shot in all, or the tolerance is reached: one by one up to a
  /// hundred, then in rounds. The same bits for any number of threads. Not after start(). Throws
  /// Interrupted when progress says stop.
  void shoot(int shots);
  /// The light now. Not after start().
  LiveLight light() const;
  /// Gathers a solution from the shots so far. Its energy balance says what was left unshot, its
  /// outcome whether the tolerance was reached. Not after start().
  SolvedScene finish();

  /// Begins to shoot; when the tolerance is reached, gathers.
  void start();
  void set_paused(bool paused);
  /// Shoots once and pauses again.
  void step_once();
  /// Ends shooting, good enough, and gathers.
  void stop_shooting();

  LiveState state() const;
  /// Light since the last call, if there is any: at most some twenty times a second.
  std::optional<LiveLight> take_light();
  /// Once, when it is there.
  std::optional<SolvedScene> take_solution();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lightwell
