#include "radiosity/solution/relight.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "scene/errors.h"
#include "scene/io/nearest_name.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

constexpr double largest_factor = 1e6;

[[noreturn]] void refuse(std::string_view text) {
  throw std::invalid_argument(
      fmt::format("'{}' is no setting of a channel; write a factor from 0 to {:g}, a colour "
                  "#rrggbb, both (0.3,#ffd9b0), on or off",
                  text, largest_factor));
}

double parse_factor(std::string_view text, std::string_view whole) {
  if (text == "off") return 0.0;
  if (text == "on") return 1.0;
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_number = error == std::errc() && end == text.data() + text.size();
  if (!is_number || !(value >= 0.0 && value <= largest_factor)) refuse(whole);
  return value;
}

// IEC 61966-2-1.
float linear(int srgb) {
  const float v = static_cast<float>(srgb) / 255.0f;
  return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

Eigen::Array3f parse_colour(std::string_view text, std::string_view whole) {
  constexpr std::size_t length = 7;  // of "#rrggbb"
  if (text.size() != length) refuse(whole);
  Eigen::Array3f colour;
  for (int k = 0; k < 3; ++k) {
    const char* const digits = text.data() + 1 + 2 * k;
    int value = 0;
    const auto [end, error] = std::from_chars(digits, digits + 2, value, 16);
    if (error != std::errc() || end != digits + 2 || value < 0) refuse(whole);
    colour[k] = linear(value);
  }
  if (!(colour > 0.0f).any()) {
    throw std::invalid_argument(
        fmt::format("'{}' is black, which leaves no light of any colour; write off", whole));
  }
  return colour;
}

// out = sum_c s_c in_c. Several rows at a time make the short loop over bands long enough for SIMD
// instructions. The light of channels that are off is not read: memory bounds the speed.
void add_up(const std::vector<LightChannel>& channels, BandArray LightChannel::*quantity,
            BandArray& out) {
  const BandArray& first = channels.front().*quantity;
  out.resize(first.rows(), first.cols());
  if (first.size() == 0) return;
  constexpr Eigen::Index rows_at_once = 16;
  constexpr int grain = 512;
  const Eigen::Index bands = first.cols(), tile = rows_at_once * bands;
  Eigen::ArrayXXf scale(tile, static_cast<Eigen::Index>(channels.size()));
  std::vector<const float*> lit;  // light of the channels that are on
  for (const LightChannel& channel : channels) {
    if ((channel.scale == 0.0f).all()) continue;
    scale.col(static_cast<Eigen::Index>(lit.size())) = channel.scale.replicate(rows_at_once, 1);
    lit.push_back((channel.*quantity).data());
  }
  const auto tiles = static_cast<int>((first.rows() + rows_at_once - 1) / rows_at_once);
  parallel_for(tiles, grain, [&](int low, int high) {
    Eigen::ArrayXf sum(tile);
    for (int t = low; t < high; ++t) {
      const Eigen::Index at = t * tile, n = std::min(tile, first.size() - at);
      sum.head(n).setZero();
      for (std::size_t c = 0; c < lit.size(); ++c) {
        sum.head(n) += scale.col(static_cast<Eigen::Index>(c)).head(n) *
                       Eigen::Map<const Eigen::ArrayXf>(lit[c] + at, n);
      }
      Eigen::Map<Eigen::ArrayXf>(out.data() + at, n) = sum.head(n);
    }
  });
}

void check(const RadiositySolution& solution, std::span<const Spectrum> scales) {
  const auto is_wrong = [&](const Spectrum& scale) {
    return scale.size() != solution.bands.count() || !(scale >= 0.0f).all() ||
           !scale.isFinite().all();
  };
  if (scales.size() == solution.channels.size() && std::ranges::none_of(scales, is_wrong)) return;
  throw std::invalid_argument(
      fmt::format("{} channels need as many scales, each of {} finite numbers >= 0",
                  solution.channels.size(), solution.bands.count()));
}

}  // namespace

ChannelSetting channel_setting(std::string_view text) {
  ChannelSetting setting;
  const std::size_t hash = text.find('#');
  if (hash == std::string_view::npos) {
    setting.factor = parse_factor(text, text);
    return setting;
  }
  setting.colour = parse_colour(text.substr(hash), text);
  if (hash == 0) return setting;
  if (text[hash - 1] != ',') refuse(text);
  setting.factor = parse_factor(text.substr(0, hash - 1), text);
  return setting;
}

Spectrum channel_scale(const LightChannel& channel, const Bands& bands,
                       const ChannelSetting& setting) {
  const auto factor = static_cast<float>(setting.factor);
  if (!setting.colour) return constant_spectrum(bands, factor);
  if (!bands.wavelengths_nm.empty() || bands.count() != 3) {
    throw InputError(fmt::format(
        "channel '{}': the solution has {} spectral bands, whose factors an RGB colour does not "
        "determine; give a factor alone",
        channel.name, bands.count()));
  }
  const Spectrum flux = channel.energy.row(0).transpose().cast<float>();
  const Spectrum colour = *setting.colour;
  const double before = luminous(bands, flux), after = luminous(bands, colour * flux);
  // Share of the light; a lesser rest would be raised over a million times.
  constexpr double nothing = 1e-6;
  if (!(after > nothing * before * colour.maxCoeff())) {
    throw InputError(fmt::format(
        "channel '{}': its light has no part of that colour, so no flux would be left; choose "
        "another colour",
        channel.name));
  }
  return colour * static_cast<float>(setting.factor * before / after);
}

void require_channels(const RadiositySolution& solution) {
  if (!solution.channels.empty()) return;
  throw InputError(
      "its light was not kept apart in channels, so it cannot be relit; solve it with "
      "--channels per-luminaire or --channels NAME=PATTERN");
}

int find_channel(const RadiositySolution& solution, std::string_view name) {
  require_channels(solution);
  std::vector<std::string> names;
  for (const LightChannel& channel : solution.channels) {
    if (channel.name == name) return static_cast<int>(names.size());
    names.push_back(channel.name);
  }
  throw InputError(fmt::format("there is no channel '{}'; the solution has: {}.{}", name,
                               fmt::join(names, ", "), did_you_mean(name, names)));
}

void relight(SolvedScene& solved, std::span<const Spectrum> scales) {
  RadiositySolution& s = solved.solution;
  check(s, scales);
  if (s.channels.empty()) return;
  BandEnergy energy = BandEnergy::Zero(4, s.bands.count());
  FreeEnergy free = FreeEnergy::Zero(2, s.bands.count());
  for (std::size_t c = 0; c < s.channels.size(); ++c) {
    LightChannel& channel = s.channels[c];
    channel.scale = scales[c];
    energy += channel.energy.rowwise() * channel.scale.transpose().cast<double>();
    if (channel.free_energy.size() == 0) continue;
    free += channel.free_energy.rowwise() * channel.scale.transpose().cast<double>();
  }
  s.energy = total(energy, free);
  add_up(s.channels, &LightChannel::patch_radiosity, s.patch_radiosity);
  add_up(s.channels, &LightChannel::direct_irradiance, s.direct_irradiance);
  add_up(s.channels, &LightChannel::indirect_irradiance, s.indirect_irradiance);
  add_up(s.channels, &LightChannel::caustic_irradiance, s.caustic_irradiance);

  BandArray& M = solved.mesh.emission;
  M = s.full_emission;
  for (Eigen::Index i = 0; i < M.rows(); ++i) {
    const int c = s.patch_channel[static_cast<std::size_t>(i)];
    if (c >= 0) M.row(i) *= s.channels[static_cast<std::size_t>(c)].scale.transpose();
  }
  scale_sources(solved);
}

void scale_sources(SolvedScene& solved) {
  const RadiositySolution& s = solved.solution;
  BandArray& scale = solved.mesh.source_scale;
  scale.resize(static_cast<Eigen::Index>(s.source_channel.size()), s.bands.count());
  for (Eigen::Index i = 0; i < scale.rows(); ++i) {
    const int c = s.source_channel[static_cast<std::size_t>(i)];
    scale.row(i) = s.channels[static_cast<std::size_t>(c)].scale.transpose();
  }
}

std::vector<Spectrum> effective_scales(const RadiositySolution& solution) {
  std::vector<Spectrum> scales;
  for (const LightChannel& channel : solution.channels) scales.push_back(channel.scale);
  return scales;
}

Spectrum emitted_flux(const LightChannel& channel) {
  return channel.energy.row(0).transpose().cast<float>() * channel.scale;
}

}  // namespace lightwell
