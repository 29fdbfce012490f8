#include "viewer/window/live_solve.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <limits>
#include <mutex>
#include <thread>
#include <utility>

#include "mesh/build_patches.h"
#include "radiosity/paths/light_path.h"
#include "radiosity/solution/relight.h"
#include "radiosity/solvers/vertex_light.h"
#include "scene/errors.h"
#include "scene/name_in_messages.h"

namespace lightwell {
namespace {

using Clock = std::chrono::steady_clock;

/// Shots that are shown one by one; later shots change little each, and are made in parallel
/// rounds.
constexpr int single_shots = 100;
constexpr std::chrono::milliseconds between_lights{50};

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Time left after `seconds` for a share of the work; below 0: too little is done to tell.
double seconds_left(double seconds, double share) {
  constexpr double least_seconds = 0.5, least_share = 0.02;
  if (seconds < least_seconds || share < least_share) return -1.0;
  return seconds * (1.0 - share) / share;
}

SolveOptions for_a_window(SolveOptions options, const Scene& scene) {
  if (!options.progressive) options.progressive.emplace();
  options.run.journal = nullptr;
  if (gives_light(scene)) return options;
  throw InputError(fmt::format(
      "{}: nothing emits light, so there is nothing to watch arriving; give a material a "
      "'radiance', 'exitance' or 'power' (in OBJ files: Ke) and use it on a surface, or add a lamp",
      name_in_messages(scene)));
}

}  // namespace

struct LiveSolve::Impl {
  Impl(const Scene& of, const SolveOptions& asked, const Provenance& from)
      : scene(of),
        options(for_a_window(asked, of)),
        provenance(from),
        mesh(build_patches(of, options.mesh, options.run.progress)),
        caster(announced("lamps")),
        direct_light(of, announced("lamps"), options.channels),
        paths(of, caster, options.form_factors.max_specular_depth),
        progressive(of, announced("daylight"),
                    interruptible(cast_shots(caster, paths, options.progressive->most_rays)),
                    *options.progressive, options.channels,
                    cast_free_light(of, caster, paths, direct_light, options.free_rays,
                                    options.run.progress)),
        begun(progressive.solution()),
        vertex_light(caster, direct_light, options.run.progress) {
    shown.lacks_specular = std::ranges::any_of(of.surfaces, [&](const Surface& surface) {
      return of.materials[surface.material].is_specular();
    });
  }

  // The mesh, after a report that a phase of the construction begins.
  const PatchMesh& announced(std::string_view phase) const {
    report(options.run.progress, phase, 0.0);
    return mesh;
  }

  // `rows` in slices, between which the thread of start() can end.
  ShotRows interruptible(ShotRows rows) const {
    return [this, rows = std::move(rows)](std::span<const RowRequest> requests,
                                          std::span<EstimatedRow> result) {
      constexpr std::size_t at_once = 16;
      for (std::size_t first = 0; first < requests.size(); first += at_once) {
        if (ending) throw Interrupted();
        const std::size_t count = std::min(at_once, requests.size() - first);
        rows(requests.subspan(first, count), result.subspan(first, count));
      }
    };
  }

  // Makes one shot, or one round up to a total of `shots`. False, with nothing
  // done, if the tolerance, max_shots or `shots` is reached.
  bool step(int shots) {
    const int done = progressive.shots();
    const int most = done < single_shots ? 1 : shots - done;
    step_start = Clock::now();
    if (most < 1 || !progressive.step(most)) return false;
    vertex_light.receive(progressive.last_shots(), [this](std::string_view, double share) {
      const std::lock_guard lock(mutex);
      shown.step_share = share;
      shown.seconds = shooting_seconds + seconds_since(step_start);
      return !ending;
    });
    return true;
  }

  Eigen::ArrayXf unshot() const {
    const BandArray& columns = progressive.unshot();
    const int bands = scene.bands.count();
    Eigen::ArrayXf result = Eigen::ArrayXf::Zero(columns.rows());
    for (Eigen::Index i = 0; i < columns.rows(); ++i) {
      for (Eigen::Index first = 0; first < columns.cols(); first += bands) {
        const Spectrum dB = columns.row(i).segment(first, bands).transpose().abs();
        result[i] += static_cast<float>(luminous(scene.bands, dB));
      }
    }
    return result;
  }

  LiveLight light() const {
    return {vertex_light.irradiance(), progressive.ambient(), unshot(), progressive.shots(),
            progressive.unshot_share()};
  }

  SolvedScene finish(const Progress& progress) const {
    SolvedScene patches;
    patches.mesh = mesh;
    RadiositySolution& s = patches.solution;
    s = progressive.solution();
    s.history.push_back({.residual = s.residual, .seconds = shooting_seconds});
    s.seconds.push_back({"solve", shooting_seconds});
    SolveOptions gathering = options;
    gathering.run.progress = progress;
    SolvedScene solved = gather_to_elements(scene, std::move(patches), gathering);
    solved.solution.provenance.version = provenance.version;
    solved.solution.provenance.options = provenance.options;
    return solved;
  }

  void run(const Progress& watch);
  void shoot_until_stopped(const Progress& watch);
  int wait_for_leave();
  void publish(bool always);

  const Scene& scene;
  SolveOptions options;
  Provenance provenance;
  PatchMesh mesh;
  ElementCaster caster;
  DirectLight direct_light;
  LightPaths paths;
  ProgressiveRadiosity progressive;
  RadiositySolution begun;  ///< before the first shot
  VertexLight vertex_light;
  double shooting_seconds = 0.0;
  Clock::time_point step_start{};  ///< of the present shots, or step of the gathering

  // State shared with the thread of start().
  mutable std::mutex mutex{};
  std::condition_variable wake{};
  std::atomic<bool> ending{false};
  bool paused = false, enough = false;
  int single_steps = 0;
  LiveState shown{};
  std::optional<LiveLight> fresh{};
  std::optional<SolvedScene> solution{};
  Clock::time_point last_published{};
  std::thread thread{};
};

// Waits while paused. Returns the shots to make until the next call; 0: shooting is to end.
int LiveSolve::Impl::wait_for_leave() {
  std::unique_lock lock(mutex);
  shown.phase = paused && single_steps == 0 ? LivePhase::paused : LivePhase::shooting;
  wake.wait(lock, [&] { return ending || enough || !paused || single_steps > 0; });
  if (ending || enough) return 0;
  shown.phase = LivePhase::shooting;
  if (!paused) return std::numeric_limits<int>::max();
  --single_steps;
  return 1;
}

void LiveSolve::Impl::publish(bool always) {
  const Clock::time_point now = Clock::now();
  const double unshot = progressive.unshot_share();
  const bool is_due = always || now - last_published >= between_lights;
  std::optional<LiveLight> copy;
  if (is_due) copy = light();
  const std::lock_guard lock(mutex);
  shown.shots = progressive.shots();
  shown.step_share = 0.0;
  shown.unshot_share = unshot;
  shown.seconds = shooting_seconds;
  shown.seconds_left = seconds_left(shooting_seconds, progressive.done());
  if (!is_due) return;
  fresh = std::move(copy);
  last_published = now;
}

void LiveSolve::Impl::shoot_until_stopped(const Progress& watch) {
  publish(true);
  while (const int most = wait_for_leave()) {
    if (watch) watch("shoot", progressive.done());
    const Clock::time_point start = Clock::now();
    const int until = options.progressive->max_shots;
    const bool shot = step(most == 1 ? std::min(progressive.shots() + 1, until) : until);
    shooting_seconds += seconds_since(start);
    bool is_last = !shot;
    {
      const std::lock_guard lock(mutex);
      is_last |= paused;
    }
    publish(is_last);
    if (!shot) break;
  }
}

void LiveSolve::Impl::run(const Progress& watch) {
  try {
    shoot_until_stopped(watch);
    if (ending) return;
    publish(true);
    {
      const std::lock_guard lock(mutex);
      shown.phase = LivePhase::gathering;
      shown.seconds_left = -1.0;
      shown.converged = progressive.has_converged();
    }
    const Clock::time_point start = Clock::now();
    step_start = start;
    SolvedScene solved = finish([&](std::string_view phase, double share) {
      if (watch) watch(phase, share);
      const std::lock_guard lock(mutex);
      if (shown.step != phase) step_start = Clock::now();
      shown.seconds_left = seconds_left(seconds_since(step_start), share);
      shown.step = phase;
      shown.step_share = share;
      shown.seconds = shooting_seconds + seconds_since(start);
      return !ending;
    });
    const std::lock_guard lock(mutex);
    solution = std::move(solved);
    shown.phase = LivePhase::done;
  } catch (const Interrupted&) {
    // The window was closed.
  } catch (const std::exception& error) {
    const std::lock_guard lock(mutex);
    shown.phase = LivePhase::failed;
    shown.failure = error.what();
  }
}

void show_light(const LiveLight& light, bool with_ambient, SolvedScene& shown) {
  RadiositySolution& s = shown.solution;
  BandArray ambient = BandArray::Zero(light.irradiance.rows(), light.irradiance.cols());
  if (with_ambient) ambient.rowwise() += light.ambient.max(0.0f).transpose();
  if (s.channels.empty()) {
    s.direct_irradiance = light.irradiance;
    s.indirect_irradiance = ambient;
    return;
  }
  split_columns(light.irradiance, &LightChannel::direct_irradiance, s.channels);
  split_columns(ambient, &LightChannel::indirect_irradiance, s.channels);
  relight(shown, effective_scales(s));
}

std::string plain_words(std::string_view step) {
  constexpr std::array<std::pair<std::string_view, const char*>, 11> words = {{
      {"mesh", "cutting surfaces into patches"},
      {"lamps", "light of lamps"},
      {"daylight", "daylight"},
      {"openings", "light through openings"},
      {"solve", "light between surfaces"},
      {"parts", "finding rooms"},
      {"gather", "light at every point"},
      {"refine", "finer patches where light changes"},
      {"balance", "light between rooms"},
      {"caustics", "light by way of mirrors and glass"},
      {"photons", "light by way of mirrors and glass"},
  }};
  const auto* const found =
      std::ranges::find(words, step, [](const auto& pair) { return pair.first; });
  return found == words.end() ? std::string(step) : found->second;
}

std::string time_left(double seconds) {
  constexpr double least = 2.0, minute = 60.0;
  if (seconds < least) return "";
  if (seconds < 2.0 * minute) return fmt::format("about {:.0f} s left", seconds);
  return fmt::format("about {:.0f} min left", seconds / minute);
}

std::string text_of(const LiveState& state) {
  const std::string left = time_left(state.seconds_left);
  const std::string step =
      state.step_share > 0.0
          ? fmt::format("step {} at {:.0f} %", state.shots + 1, 100.0 * state.step_share)
          : fmt::format("step {}", state.shots);
  const std::string meter =
      fmt::format("{:.3g} % still to come, {}, {:.1f} s{}{}", 100.0 * state.unshot_share, step,
                  state.seconds, left.empty() ? "" : ", ", left);
  const char* const lacks =
      state.lacks_specular ? " (light by way of mirrors and glass comes with the solution)" : "";
  switch (state.phase) {
    case LivePhase::shooting:
      return "light spreading: " + meter + lacks;
    case LivePhase::paused:
      return "paused: " + meter + lacks;
    case LivePhase::gathering:
      return fmt::format("finishing: {} {:.0f} %, {:.1f} s{}{}",
                         plain_words(state.step.empty() ? "gather" : state.step),
                         100.0 * state.step_share, state.seconds, left.empty() ? "" : ", ", left);
    case LivePhase::done:
      return state.converged
                 ? fmt::format("solved in {:.1f} s", state.seconds)
                 : fmt::format("solved so far: {:.3g} % of the light left out, {:.1f} s",
                               100.0 * state.unshot_share, state.seconds);
    case LivePhase::failed:
      break;
  }
  return "failed: " + state.failure;
}

LiveSolve::LiveSolve(const Scene& scene, const SolveOptions& options, const Provenance& provenance)
    : impl_(std::make_unique<Impl>(scene, options, provenance)) {}

void LiveSolve::ask_to_end() {
  impl_->ending = true;
  {
    // The lock keeps the wake-up from falling between the thread's test and the thread's wait.
    const std::lock_guard lock(impl_->mutex);
  }
  impl_->wake.notify_all();
}

LiveSolve::~LiveSolve() {
  ask_to_end();
  if (impl_->thread.joinable()) impl_->thread.join();
}

SolvedScene LiveSolve::dark() const {
  SolvedScene dark;
  dark.mesh = impl_->mesh;
  RadiositySolution& s = dark.solution;
  s.bands = impl_->scene.bands;
  s.metres_per_unit = impl_->scene.metres_per_unit;
  s.unit_name = impl_->scene.unit_name;
  s.relative_units = impl_->scene.relative_units;
  s.provenance = impl_->provenance;
  s.patch_radiosity = impl_->begun.patch_radiosity;
  s.direct_irradiance = BandArray::Zero(dark.mesh.vertex_count(), s.bands.count());
  s.indirect_irradiance = s.direct_irradiance;
  s.channels = impl_->begun.channels;
  s.patch_channel = impl_->begun.patch_channel;
  s.source_channel = impl_->begun.source_channel;
  s.full_emission = impl_->begun.full_emission;
  for (LightChannel& channel : s.channels) {
    channel.direct_irradiance = s.direct_irradiance;
    channel.indirect_irradiance = s.direct_irradiance;
  }
  return dark;
}

void LiveSolve::shoot(int shots) {
  const Clock::time_point start = Clock::now();
  while (impl_->progressive.shots() < shots && impl_->step(shots)) {
    const double share = static_cast<double>(impl_->progressive.shots()) / shots;
    report(impl_->options.run.progress, "solve", std::max(share, impl_->progressive.done()));
  }
  impl_->shooting_seconds += seconds_since(start);
}

LiveLight LiveSolve::light() const {
  return impl_->light();
}

SolvedScene LiveSolve::finish() {
  return impl_->finish(impl_->options.run.progress);
}

void LiveSolve::start(const Progress& watch) {
  impl_->thread = std::thread([this, watch] { impl_->run(watch); });
}

void LiveSolve::set_paused(bool paused) {
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->paused = paused;
    impl_->single_steps = 0;
  }
  impl_->wake.notify_all();
}

void LiveSolve::step_once() {
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->paused = true;
    ++impl_->single_steps;
  }
  impl_->wake.notify_all();
}

void LiveSolve::stop_shooting() {
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->enough = true;
  }
  impl_->wake.notify_all();
}

LiveState LiveSolve::state() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->shown;
}

std::optional<LiveLight> LiveSolve::take_light() {
  const std::lock_guard lock(impl_->mutex);
  return std::exchange(impl_->fresh, std::nullopt);
}

std::optional<SolvedScene> LiveSolve::take_solution() {
  const std::lock_guard lock(impl_->mutex);
  return std::exchange(impl_->solution, std::nullopt);
}

}  // namespace lightwell
