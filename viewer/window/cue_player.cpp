#include "viewer/window/cue_player.h"

#include <fmt/format.h>

#include <utility>

namespace lightwell {

void CuePlayer::begin(int cue, std::vector<Spectrum> from, const RadiositySolution& solution) {
  cue_ = cue;
  fade_ = fade_to(solution, std::move(from), cues_[static_cast<std::size_t>(cue)]);
  seconds_ = 0.0;
  arrived_ = false;
}

void CuePlayer::go(const RadiositySolution& solution) {
  if (cue_ + 1 < static_cast<int>(cues_.size())) {
    begin(cue_ + 1, effective_scales(solution), solution);
  }
}

void CuePlayer::back(const RadiositySolution& solution) {
  if (cue_ < 1) return;
  playing_ = false;
  begin(cue_ - 1, cues_[static_cast<std::size_t>(cue_ - 1)].scales, solution);
  seconds_ = fade_->seconds;  // without its wait
}

void CuePlayer::switch_playing(const RadiositySolution& solution) {
  playing_ = !playing_;
  if (!playing_ || fade_) return;
  if (cue_ + 1 == static_cast<int>(cues_.size())) cue_ = -1;
  go(solution);
}

void CuePlayer::stop() {
  fade_.reset();
  playing_ = false;
}

std::optional<std::vector<Spectrum>> CuePlayer::advance(double seconds,
                                                        const RadiositySolution& solution) {
  std::optional<std::vector<Spectrum>> scales;
  seconds_ += seconds;
  while (fade_) {
    if (!arrived_) scales = scales_at(*fade_, seconds_);
    if (seconds_ < fade_->seconds) break;
    arrived_ = true;
    const double end = fade_->seconds + cues_[static_cast<std::size_t>(cue_)].hold;
    if (playing_ && seconds_ < end) break;
    const std::vector<Spectrum> there = fade_->to;
    const double left = seconds_ - end;
    fade_.reset();
    playing_ = playing_ && cue_ + 1 < static_cast<int>(cues_.size());
    if (!playing_) break;
    begin(cue_ + 1, there, solution);
    seconds_ = left;
  }
  return scales;
}

std::string CuePlayer::text() const {
  if (!has_cues()) return "";
  if (cue_ < 0) return fmt::format("{} cues", cues_.size());
  return fmt::format("cue {}/{} {}{}", cue_ + 1, cues_.size(),
                     cues_[static_cast<std::size_t>(cue_)].name,
                     fade_ ? fmt::format(", {:.1f} s", seconds_) : "");
}

}  // namespace lightwell
