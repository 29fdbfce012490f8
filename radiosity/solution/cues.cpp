#include "radiosity/solution/cues.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <stdexcept>

#include "radiosity/solution/channel_settings.h"
#include "scene/errors.h"

namespace lightwell {
namespace {

NamedSetting parse_level(const WordedLevel& level) {
  try {
    return {level.channels, channel_setting(level.value), level.place};
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("{}: {}", level.place, error.what()));
  }
}

bool flux_falls(const LightChannel& channel, const Bands& bands, const Spectrum& from,
                const Spectrum& to) {
  // Colours keep the flux to a few roundings of floats, 6e-8 each.
  constexpr double rounding = 1e-6;
  const Spectrum flux = channel.energy.row(0).transpose().cast<float>();
  return luminous(bands, flux * to) < (1.0 - rounding) * luminous(bands, flux * from);
}

}  // namespace

std::vector<Cue> cues_for(const RadiositySolution& solution, std::span<const WordedCue> worded) {
  std::vector<Cue> cues;
  std::vector<Spectrum> scales = effective_scales(solution);
  for (const WordedCue& words : worded) {
    std::vector<NamedSetting> settings;
    for (const WordedLevel& level : words.levels) settings.push_back(parse_level(level));
    std::optional<NamedSetting> others;
    if (words.others) others = parse_level(*words.others);
    scales = apply_settings(solution, settings, std::move(scales), others ? &*others : nullptr);
    cues.push_back({.name = words.name,
                    .scales = scales,
                    .fade_up = words.fade_up,
                    .fade_down = words.fade_down,
                    .wait = words.wait,
                    .hold = words.hold});
  }
  return cues;
}

CueFade fade_to(const RadiositySolution& solution, std::vector<Spectrum> from, const Cue& cue) {
  CueFade result{.from = std::move(from), .to = cue.scales, .wait = cue.wait, .seconds = cue.wait};
  for (std::size_t c = 0; c < cue.scales.size(); ++c) {
    const bool falls =
        flux_falls(solution.channels[c], solution.bands, result.from[c], cue.scales[c]);
    result.fade.push_back(falls ? cue.fade_down : cue.fade_up);
    const bool changes = (result.from[c] != cue.scales[c]).any();
    if (changes) result.seconds = std::max(result.seconds, cue.wait + result.fade.back());
  }
  return result;
}

std::vector<Spectrum> scales_at(const CueFade& fade, double second) {
  if (second >= fade.seconds) return fade.to;
  std::vector<Spectrum> scales = fade.from;
  for (std::size_t c = 0; c < scales.size(); ++c) {
    const double since = second - fade.wait;
    if (since >= fade.fade[c]) {
      scales[c] = fade.to[c];
    } else if (since > 0.0) {
      scales[c] += static_cast<float>(since / fade.fade[c]) * (fade.to[c] - fade.from[c]);
    }
  }
  return scales;
}

std::vector<FadeShare> shares_at(const CueFade& fade, double second) {
  if (second >= fade.seconds) return {{.scales = fade.to}};
  std::set<double> durations;
  for (std::size_t c = 0; c < fade.fade.size(); ++c) {
    if ((fade.from[c] != fade.to[c]).any()) durations.insert(fade.fade[c]);
  }
  std::vector<FadeShare> shares;
  const auto add = [&](const std::vector<Spectrum>& scales, double share) {
    if (share > 0.0) shares.push_back({scales, share});
  };
  std::vector<Spectrum> state = fade.from;
  double arrived = 1.0;  // share of its way that the state's last channel has gone
  for (const double duration : durations) {
    const double since = second - fade.wait;
    const double next = since >= duration ? 1.0 : std::max(0.0, since / duration);
    add(state, arrived - next);
    arrived = next;
    for (std::size_t c = 0; c < state.size(); ++c) {
      if (fade.fade[c] == duration) state[c] = fade.to[c];
    }
  }
  add(state, arrived);
  return shares;
}

CueSequence::CueSequence(const RadiositySolution& solution, std::span<const Cue> cues) {
  std::vector<Spectrum> scales = effective_scales(solution);
  for (const Cue& cue : cues) {
    fades_.push_back(fade_to(solution, std::move(scales), cue));
    ends_.push_back(seconds() + fades_.back().seconds + cue.hold);
    scales = cue.scales;
  }
}

CueSequence::Moment CueSequence::moment(double second) const {
  // The cue of the first end after `second`.
  const auto next = std::upper_bound(ends_.begin(), ends_.end(), second);
  if (next == ends_.end()) return {fades_.back(), fades_.back().seconds};
  const double begin = next == ends_.begin() ? 0.0 : *(next - 1);
  return {fades_[static_cast<std::size_t>(next - ends_.begin())], second - begin};
}

std::vector<Spectrum> CueSequence::at(double second) const {
  const Moment now = moment(second);
  return scales_at(now.fade, now.second);
}

std::vector<FadeShare> CueSequence::shares_at(double second) const {
  const Moment now = moment(second);
  return lightwell::shares_at(now.fade, now.second);
}

}  // namespace lightwell
