#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "radiosity/solve.h"

namespace lightwell {

/// Light on a mesh during progressive refinement.
struct LiveLight {
  /// Irradiance of each vertex by the shots so far, W/m^2, vertices x columns: one column a band,
  /// or with channels the bands of the first channel, then of the second, and so on.
  BandArray irradiance{};
  /// Ambient term: the estimated irradiance of every vertex by unshot light, W/m^2, a value for
  /// each column of `irradiance` (Cohen et al. 1988).
  Eigen::ArrayXf ambient{};
  Eigen::ArrayXf unshot{};  ///< unshot light of each patch, lm/m^2, with all channels on
  int shots = 0;
  double unshot_share = 0.0;  ///< unshot power over emitted power, all bands together
};

enum class LivePhase {
  shooting,
  paused,
  gathering,  ///< shooting is over; light is gathered to vertices for the solution
  done,       ///< the solution is ready
  failed,
};

struct LiveState {
  LivePhase phase = LivePhase::paused;
  int shots = 0;
  double unshot_share = 1.0;
  double seconds = 0.0;     ///< of work, without pauses
  std::string step{};       ///< step of the gathering
  double step_share = 0.0;  ///< share of the step, or of a shot, that is done, [0,1]
  /// Estimated time to the end of the shooting, or of the step of the gathering, s; below 0: not
  /// known.
  double seconds_left = -1.0;
  bool converged = false;  ///< shooting reached the tolerance
  /// The scene has mirrors or glass; light that they pass on appears only in the solution.
  bool lacks_specular = false;
  std::string failure{};  ///< the reason, if the phase is failed
};

/// Sets the irradiance of `shown`, a solution of the same mesh: direct_irradiance to the light shot
/// so far, indirect_irradiance to the ambient term or 0. With channels, both are the sums of the
/// channels by their effective scales.
void show_light(const LiveLight& light, bool with_ambient, SolvedScene& shown);

/// A line in plain words: light still to come (unshot power) in percent of the emitted power, steps
/// (shots), seconds, and about how many are left.
std::string text_of(const LiveState& state);

/// A step of a solve, as progress reports name it, in plain words.
std::string plain_words(std::string_view step);

/// "about 40 s left"; empty below 2 s, and where the time is not known.
std::string time_left(double seconds);

/// Progressive refinement that can be watched. Patches shoot, vertices receive after every shot,
/// and at the end a solution is gathered as solve_scene() does. Two ways to run:
/// - in the caller's thread: shoot(), light() and finish();
/// - in a thread of the object's own: start(). The thread that made the object may then call
///   dark() and the members declared below start().
/// With `options.channels` the light of each channel is kept apart from the first shot on. Keeps a
/// reference to the scene.
class LiveSolve {
 public:
  /// Cuts the scene into patches. `options.run.journal` is ignored; the thread of start() ignores
  /// `options.run.progress` too. Throws InputError where nothing emits light.
  LiveSolve(const Scene& scene, const SolveOptions& options, const Provenance& provenance);
  /// Ends the thread: after the present sixteen rows of form factors or thousand vertices of a
  /// shot, and at the next report while gathering.
  ~LiveSolve();
  /// Asks the thread to end, as the destructor does, without waiting.
  void ask_to_end();
  LiveSolve(const LiveSolve&) = delete;
  LiveSolve& operator=(const LiveSolve&) = delete;

  /// Returns the mesh before the first shot: irradiance 0, radiosity that of the emitters, channels
  /// if the options have them.
  SolvedScene dark() const;

  /// Shoots until `shots` patches have shot in all, or the tolerance is reached: one patch at a
  /// time up to a hundred, then in rounds. The same bits for any number of threads. Not to be
  /// called after start(). Throws Interrupted when `options.run.progress` returns false.
  void shoot(int shots);
  /// Returns the light by the shots so far. Not to be called after start().
  LiveLight light() const;
  /// Gathers a solution from the shots so far. The solution's energy balance has the unshot power,
  /// its outcome whether the tolerance was reached. Not to be called after start().
  SolvedScene finish();

  /// Begins a thread that shoots until the tolerance or max_shots is reached, and then gathers.
  /// `watch`, for tests, is called in the thread before each step of shooting ("shoot") and with
  /// the gathering's progress; its result is ignored.
  void start(const Progress& watch = {});
  void set_paused(bool paused);
  /// Shoots one patch, then pauses.
  void step_once();
  /// Ends the shooting before the tolerance is reached, and gathers.
  void stop_shooting();

  LiveState state() const;
  /// Returns the latest light if there is new light since the last call, at most about twenty times
  /// a second.
  std::optional<LiveLight> take_light();
  /// Returns the solution in the first call after the gathering; else nothing.
  std::optional<SolvedScene> take_solution();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lightwell
