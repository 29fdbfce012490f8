#include "radiosity/solution/channel_arrays.h"

#include <fmt/format.h>

#include <algorithm>

#include "radiosity/solution/emitter_channels.h"
#include "radiosity/solution/poly_data.h"
#include "radiosity/solution/solution_arrays.h"

namespace lightwell {
namespace {

std::string array_name(std::size_t channel, const char* quantity) {
  return fmt::format("channel_{}_{}", channel, quantity);
}

void add_columns(std::vector<DataArray>& arrays, const std::string& name, const BandArray& values) {
  add_values(arrays, name, values.data(), values.rows(), static_cast<int>(values.cols()));
}

// Finite irradiances and radiosities; their sums with finite scales are then finite, too.
BandArray finite_bands(const SolutionArrays& in, SolutionArrays::Place place,
                       const std::string& name, int rows, int bands) {
  BandArray values = in.bands(place, name, rows, bands);
  in.require(values.allFinite(),
             fmt::format("its array '{}' holds a value that is not finite", name));
  return values;
}

void read_names(const SolutionArrays& in, RadiositySolution& s) {
  const std::vector<std::string> names = in.strings("channel_names");
  in.require(names.size() <= most_channels,
             fmt::format("it has {} channels; {} are possible", names.size(), most_channels));
  const std::vector<std::string> surfaces = in.strings("channel_surfaces");
  const auto count = static_cast<int>(names.size());
  const std::vector<int> owner =
      in.integers(in.field(), "channel_of_surface", static_cast<int>(surfaces.size()), 0, count);
  for (const std::string& name : names) {
    in.require(!name.empty() && std::count(names.begin(), names.end(), name) == 1,
               fmt::format("its channel name '{}' is empty or used twice", name));
    s.channels.push_back({.name = name});
  }
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    s.channels[static_cast<std::size_t>(owner[i])].surfaces.push_back(surfaces[i]);
  }
}

void read_patch_channels(const SolutionArrays& in, const PatchMesh& mesh, RadiositySolution& s) {
  const int n = mesh.patch_count(), count = static_cast<int>(s.channels.size());
  s.patch_channel = in.integers(in.field(), "patch_channel", n, -1, count);
  s.full_emission = finite_bands(in, in.field(), "patch_full_emission", n, s.bands.count());
  for (int i = 0; i < n; ++i) {
    in.require((s.full_emission.row(i) >= 0.0f).all() &&
                   (s.patch_channel[i] >= 0 || (s.full_emission.row(i) == 0.0f).all()),
               fmt::format("patch {} has negative emission, or emits in no channel", i));
  }
}

}  // namespace

void add_channels(PolyData& data, const RadiositySolution& s) {
  if (s.channels.empty()) return;
  const auto count = static_cast<std::ptrdiff_t>(s.channels.size());
  const int K = s.bands.count();
  std::vector<std::string> names, surfaces;
  std::vector<int> owner;
  std::vector<float> scale;
  std::vector<double> energy, free_energy;
  std::vector<DataArray>&field = data.field, &points = data.of_points;
  for (std::size_t c = 0; c < s.channels.size(); ++c) {
    const LightChannel& channel = s.channels[c];
    names.push_back(channel.name);
    surfaces.insert(surfaces.end(), channel.surfaces.begin(), channel.surfaces.end());
    owner.resize(surfaces.size(), static_cast<int>(c));
    scale.insert(scale.end(), channel.scale.begin(), channel.scale.end());
    energy.insert(energy.end(), channel.energy.data(), channel.energy.data() + 4 * K);
    free_energy.insert(free_energy.end(), channel.free_energy.data(),
                       channel.free_energy.data() + channel.free_energy.size());
    add_columns(field, array_name(c, "patch_radiosity"), channel.patch_radiosity);
    add_columns(points, array_name(c, "direct_irradiance"), channel.direct_irradiance);
    add_columns(points, array_name(c, "indirect_irradiance"), channel.indirect_irradiance);
    add_columns(points, array_name(c, "caustic_irradiance"), channel.caustic_irradiance);
  }
  add_strings(field, "channel_names", names);
  add_values(field, "channel_scale", scale.data(), count, K);
  add_values(field, "channel_energy_emitted_absorbed_escaped_unshot", energy.data(), count * K, 4);
  add_strings(field, "channel_surfaces", surfaces);
  add_values(field, "channel_of_surface", owner.data(), static_cast<std::ptrdiff_t>(owner.size()));
  add_values(field, "patch_channel", s.patch_channel.data(),
             static_cast<std::ptrdiff_t>(s.patch_channel.size()));
  add_columns(field, "patch_full_emission", s.full_emission);
  add_values(field, "lamp_channel", s.source_channel.data(),
             static_cast<std::ptrdiff_t>(s.source_channel.size()));
  add_values(field, "channel_energy_from_lamps_missed", free_energy.data(),
             static_cast<std::ptrdiff_t>(free_energy.size() / 2), 2);
}

void read_channels(const SolutionArrays& in, const PatchMesh& mesh, RadiositySolution& s) {
  if (!in.has(in.field(), "channel_names")) return;
  read_names(in, s);
  read_patch_channels(in, mesh, s);
  const int K = s.bands.count(), count = static_cast<int>(s.channels.size());
  const BandArray scale = finite_bands(in, in.field(), "channel_scale", count, K);
  in.require((scale >= 0.0f).all(), "its array 'channel_scale' holds a negative number");
  s.source_channel = in.optional<int>(in.field(), "lamp_channel", 1).values;
  for (const int channel : s.source_channel) {
    in.require(0 <= channel && channel < count, "a lamp is in no channel");
  }
  const auto free_energy = in.optional<double>(in.field(), "channel_energy_from_lamps_missed", 2);
  in.require(free_energy.rows == 0 || free_energy.rows == count * K,
             "its array 'channel_energy_from_lamps_missed' does not have one row for each channel "
             "and band");
  const auto energy = in.required<double>(
      in.field(), "channel_energy_emitted_absorbed_escaped_unshot", count * K, 4);
  for (int c = 0; c < count; ++c) {
    LightChannel& channel = s.channels[static_cast<std::size_t>(c)];
    const auto read = [&](SolutionArrays::Place place, const char* quantity, int rows) {
      return finite_bands(in, place, array_name(static_cast<std::size_t>(c), quantity), rows, K);
    };
    channel.scale = scale.row(c).transpose();
    channel.energy = Eigen::Map<const BandEnergy>(energy.row(K * c), 4, K);
    in.require(channel.energy.allFinite(), "the energy of a channel is not finite");
    if (free_energy.rows > 0) {
      channel.free_energy = Eigen::Map<const FreeEnergy>(free_energy.row(K * c), 2, K);
      in.require(channel.free_energy.allFinite(), "the energy of a lamp is not finite");
    }
    channel.patch_radiosity = read(in.field(), "patch_radiosity", mesh.patch_count());
    channel.direct_irradiance = read(in.points(), "direct_irradiance", mesh.vertex_count());
    channel.indirect_irradiance = read(in.points(), "indirect_irradiance", mesh.vertex_count());
    if (s.caustic_irradiance.size() > 0) {
      channel.caustic_irradiance = read(in.points(), "caustic_irradiance", mesh.vertex_count());
    }
  }
}

}  // namespace lightwell
