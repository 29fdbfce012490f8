#include "viewer/window/light_board.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/errors.h"

namespace lightwell {
namespace {

constexpr float most_light = 100.0f, least_light = 0.01f;  ///< factors of a channel that is on

struct Preset {
  const char* name;
  const char* colour;  ///< as channel_setting() takes it; empty: the channel's own
};
/// Colours of blackbodies relative to a white of 6500 K, sRGB.
constexpr std::array<Preset, 4> presets = {
    {{"", ""}, {"2700 K", "#ffa957"}, {"4000 K", "#ffd1a3"}, {"9000 K", "#d6e1ff"}}};

}  // namespace

LightBoard::LightBoard(const RadiositySolution& solution) : bands_(solution.bands) {
  for (const LightChannel& channel : solution.channels) {
    LightChannel light;
    light.name = channel.name;
    light.energy = channel.energy;
    channels_.push_back(std::move(light));
    names_.push_back(channel.name);
  }
  follow(effective_scales(solution));
}

void LightBoard::follow(const std::vector<Spectrum>& scales) {
  dimmers_.assign(channels_.size(), {});
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    const Spectrum& scale = scales[c];
    Dimmer& dimmer = dimmers_[c];
    dimmer.factor = scale.size() > 0 ? scale.maxCoeff() : 1.0f;
    if (scale.size() == 3 && bands_.wavelengths_nm.empty()) {
      // Ratio of scaled to full luminous flux: colour and dimmer together.
      const Spectrum flux = channels_[c].energy.row(0).transpose().cast<float>();
      const double own = luminous(bands_, flux);
      const double now = luminous(bands_, scale * flux);
      if (own > 0.0) dimmer.factor = static_cast<float>(now / own);
    }
    const bool is_on = dimmer.factor > 0.0f;
    dimmer.colour = is_on ? Spectrum(scale / dimmer.factor) : constant_spectrum(bands_, 1.0f);
    dimmer.before = is_on ? dimmer.factor : 1.0f;
  }
}

void LightBoard::choose(int step) {
  const int count = static_cast<int>(names_.size()) + 1;
  chosen_ = (chosen_ + 1 + step + count) % count - 1;
}

void LightBoard::dim(int steps) {
  if (!is_chosen()) return;
  Dimmer& dimmer = dimmers_[static_cast<std::size_t>(chosen_)];
  const float now = dimmer.factor > 0.0f ? dimmer.factor : (steps > 0 ? 0.5f * least_light : 0.0f);
  const float wanted = now * std::exp2(static_cast<float>(steps) / 3.0f);
  dimmer.factor = wanted < 0.99f * least_light && steps < 0
                      ? 0.0f
                      : std::clamp(wanted, least_light, most_light);
  // Rounding of third stops does not miss full light.
  if (std::abs(dimmer.factor - 1.0f) < 1e-3f) dimmer.factor = 1.0f;
  if (dimmer.factor > 0.0f) dimmer.before = dimmer.factor;
}

void LightBoard::switch_chosen() {
  if (!is_chosen()) return;
  Dimmer& dimmer = dimmers_[static_cast<std::size_t>(chosen_)];
  dimmer.factor = dimmer.factor > 0.0f ? 0.0f : dimmer.before;
}

std::string LightBoard::next_colour() {
  if (!is_chosen()) return "choose a channel first: ]";
  const auto c = static_cast<std::size_t>(chosen_);
  Dimmer& dimmer = dimmers_[c];
  const int next = (dimmer.preset + 1) % static_cast<int>(presets.size());
  const Preset& preset = presets[static_cast<std::size_t>(next)];
  try {
    dimmer.colour = *preset.colour
                        ? channel_scale(channels_[c], bands_, channel_setting(preset.colour))
                        : constant_spectrum(bands_, 1.0f);
  } catch (const InputError& error) {
    return error.what();
  }
  dimmer.preset = next;
  return fmt::format("{}: {}", names_[c], *preset.name ? preset.name : "its own colour");
}

std::vector<Spectrum> LightBoard::scales() const {
  std::vector<Spectrum> scales;
  for (const Dimmer& dimmer : dimmers_) scales.push_back(dimmer.factor * dimmer.colour);
  return scales;
}

std::string LightBoard::text() const {
  std::string text;
  for (std::size_t c = 0; c < names_.size(); ++c) {
    const Dimmer& dimmer = dimmers_[c];
    const std::string value =
        dimmer.factor > 0.0f ? fmt::format("{:.3g} %", 100.0f * dimmer.factor) : "off";
    const char* const colour = presets[static_cast<std::size_t>(dimmer.preset)].name;
    const bool chosen = static_cast<int>(c) == chosen_;
    text += fmt::format("{}{}{} {}{}{}{}", c > 0 ? "  " : "", chosen ? "[" : "", names_[c], value,
                        *colour ? " " : "", colour, chosen ? "]" : "");
  }
  return text;
}

}  // namespace lightwell
