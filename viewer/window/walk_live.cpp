#include <exception>
#include <utility>

#include "radiosity/solution/relight.h"
#include "viewer/window/walk_window.h"

namespace lightwell {

// The light before the first shot: emitters and ambient term.
std::unique_ptr<SolvedScene> WalkWindow::begin(const LiveSolve& live, SolvedScene dark) {
  auto begun = std::make_unique<SolvedScene>(std::move(dark));
  show_light(live.light(), true, *begun);
  return begun;
}

WalkWindow::WalkWindow(LiveSolve& live, SolvedScene begun, const ViewOptions& options,
                       const OpenWindow* opened)
    : WalkWindow(nullptr, begin(live, std::move(begun)), &live, options, opened) {
  arrived_ = live.light();
  show_arriving_light();
}

WalkWindow::WalkWindow(SolvedScene sketched, Preparation& preparation, const ViewOptions& options,
                       const OpenWindow* opened)
    : WalkWindow(nullptr, std::make_unique<SolvedScene>(std::move(sketched)), nullptr, options,
                 opened) {
  preparing_ = &preparation;
  update_text();
}

void WalkWindow::expect(Preview& preview) {
  preview_ = &preview;
}

void WalkWindow::watch() {
  try {
    if (preparing_ && preparing_->is_done()) begin_solving(preparing_->take());
  } catch (...) {
    preparing_ = nullptr;
    failure_ = std::current_exception();
    return close();
  }
  if (preparing_) update_text();
  if (!live_) return;
  if (preview_ && preview_->is_ready()) show_sketch(*std::exchange(preview_, nullptr)->take());
  if (auto light = live_->take_light()) receive(std::move(*light));
  const LiveState state = live_->state();
  if (text_of(state) != text_of(live_state_)) changed_ = true;
  live_state_ = state;
  if (auto solution = live_->take_solution()) show_solution(std::move(*solution));
  update_text();
}

// The sketch is shown until the light of shots is better.
void WalkWindow::begin_solving(PreparedSolve prepared) {
  preparing_ = nullptr;
  prepared_ = std::move(prepared.solve);
  live_ = prepared_.get();
  solving_ = begin(*live_, std::move(prepared.dark));
  lights_ = LightBoard(solving_->solution);
  arrived_ = live_->light();
  live_->start();
}

void WalkWindow::receive(LiveLight light) {
  arrived_ = std::move(light);
  if (solving_ && !surpasses_sketch(live_->state())) return;
  if (solving_) return leave_sketch();
  show_arriving_light();
  meter_unless_exposed();
}

void WalkWindow::show_sketch(SolvedScene sketched) {
  const LiveState state = live_->state();
  if (state.phase == LivePhase::done || surpasses_sketch(state)) return;
  solving_ = show_instead(std::make_unique<SolvedScene>(std::move(sketched)));
}

// Shows the light of shots, and no sketch that is still to come.
void WalkWindow::leave_sketch() {
  preview_ = nullptr;
  if (!solving_) return;
  show_instead(std::move(solving_));
  show_arriving_light();
}

void WalkWindow::show_arriving_light() {
  still_.discard();
  show_light(arrived_, ambient_, *own_);
  view_->light_arrived();
  view_->set_unshot(arrived_.unshot);
  pointer_.light_changed(*view_, true);
  update_pointer();
  changed_ = true;
}

void WalkWindow::show_solution(SolvedScene solved) {
  auto solution = std::make_unique<SolvedScene>(std::move(solved));
  if (lights_.has_channels()) relight(*solution, lights_.scales());  // dimmed during the solving
  show_instead(std::move(solution));
  solving_.reset();
  preview_ = nullptr;
  if (std::exchange(save_when_solved_, false)) save_solution();
}

// Shows light on another mesh. Returns the light that was shown.
std::unique_ptr<SolvedScene> WalkWindow::show_instead(std::unique_ptr<SolvedScene> light) {
  replace_view(*light);
  std::unique_ptr<SolvedScene> before = std::exchange(own_, std::move(light));
  pointer_.light_changed(*view_, false);
  meter_unless_exposed();
  update_pointer();
  return before;
}

bool WalkWindow::is_shooting() const {
  return live_ && live_state_.phase <= LivePhase::paused;
}

void WalkWindow::switch_pause() {
  if (!is_shooting()) return say(nothing_to_solve());
  leave_sketch();
  live_->set_paused(live_state_.phase == LivePhase::shooting);
}

void WalkWindow::shoot_once() {
  if (!is_shooting()) return say(nothing_to_solve());
  leave_sketch();
  live_->step_once();
}

void WalkWindow::switch_ambient() {
  if (preparing_) return say(nothing_to_solve());
  if (!live_ || live_state_.phase > LivePhase::gathering) return say("all light has arrived");
  leave_sketch();
  ambient_ = !ambient_;
  say(ambient_ ? "with a guess of the light to come" : "without a guess of the light to come");
  show_arriving_light();
}

void WalkWindow::stop_shooting() {
  if (!live_) return say(nothing_to_solve());
  if (live_state_.phase == LivePhase::done) return save_solution();
  save_when_solved_ = true;
  live_->stop_shooting();
}

std::string WalkWindow::nothing_to_solve() const {
  return preparing_ ? "the solve is still being prepared" : "nothing is being solved";
}

}  // namespace lightwell
