#pragma once

#include <optional>
#include <string>
#include <vector>

#include "radiosity/solution/cues.h"

namespace lightwell {

/// Steps through lighting cues and fades their light in real time.
class CuePlayer {
 public:
  /// Begins before the first cue.
  explicit CuePlayer(std::vector<Cue> cues) : cues_(std::move(cues)) {}

  bool has_cues() const { return !cues_.empty(); }
  bool is_playing() const { return playing_; }
  /// Begins the fade to the next cue from the solution's effective scales; without effect after the
  /// last cue.
  void go(const RadiositySolution& solution);
  /// Goes to the previous cue at once, without a fade.
  void back(const RadiositySolution& solution);
  /// Plays from the next cue on (after the last: from the first), each following the fade and the
  /// hold of the one before; or stops, which lets a fade end.
  void switch_playing(const RadiositySolution& solution);
  /// Ends a fade where it is, and the playing.
  void stop();
  /// Advances by `seconds`. Returns scales for relight(), or nothing while the light stays.
  std::optional<std::vector<Spectrum>> advance(double seconds, const RadiositySolution& solution);
  /// "cue 2/5 dusk, 1.3 s": the cue, and while it fades or holds the time since its begin. Empty
  /// without cues.
  std::string text() const;

 private:
  void begin(int cue, std::vector<Spectrum> from, const RadiositySolution& solution);

  std::vector<Cue> cues_;
  int cue_ = -1;
  std::optional<CueFade> fade_{};  // until the end of fade and hold
  double seconds_ = 0.0;           // since its begin
  bool arrived_ = false, playing_ = false;
};

}  // namespace lightwell
