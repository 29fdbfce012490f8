#include "scene/io/toml/toml_spectra.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "scene/cie_daylight.h"
#include "scene/errors.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

enum class Quantity { share, emission };

Spectrum constant(const TomlValue& value, const TomlBands& bands, Quantity quantity) {
  const double x =
      quantity == Quantity::share ? value.number_within(0.0, 1.0) : value.number_at_least(0.0);
  return constant_spectrum(bands.bands, static_cast<float>(x));
}

Spectrum per_band(const TomlValue& value, const TomlBands& bands, Quantity quantity) {
  const auto elements = value.elements("band");
  if (static_cast<int>(elements.size()) != bands.bands.count()) {
    value.fail(fmt::format("has {} numbers, but the scene has {} bands; give one number per band",
                           elements.size(), bands.bands.count()));
  }
  Spectrum result(bands.bands.count());
  for (int k = 0; k < result.size(); ++k) {
    const TomlValue& x = elements[static_cast<std::size_t>(k)];
    result[k] = static_cast<float>(quantity == Quantity::share ? x.number_within(0.0, 1.0)
                                                               : x.number_at_least(0.0));
  }
  return result;
}

void require_covered(const TomlValue& value, const SpectrumSamples& samples, double low,
                     double high, const std::string& band) {
  if (covers(samples, low, high)) return;
  value.fail(fmt::format(
      "covers {}-{} nm, but band {} is {}-{} nm; extend the spectrum or narrow the bands",
      samples.wavelengths_nm.front(), samples.wavelengths_nm.back(), band, low, high));
}

SpectrumSamples inline_samples(const TomlTable& table) {
  SpectrumSamples samples;
  for (const auto& nm : table.require("wavelengths").elements("wavelength")) {
    samples.wavelengths_nm.push_back(nm.positive());
    const std::size_t n = samples.wavelengths_nm.size();
    if (n > 1 && !(samples.wavelengths_nm[n - 1] > samples.wavelengths_nm[n - 2])) {
      nm.fail(fmt::format("is {}, after {}; wavelengths must rise", samples.wavelengths_nm[n - 1],
                          samples.wavelengths_nm[n - 2]));
    }
  }
  const TomlValue values = table.require("values");
  for (const auto& value : values.elements("value")) samples.values.push_back(value.number());
  if (samples.values.size() != samples.wavelengths_nm.size() || samples.values.size() < 2) {
    values.fail(fmt::format("has {} numbers for {} wavelengths; give one each, at least two",
                            samples.values.size(), samples.wavelengths_nm.size()));
  }
  return samples;
}

SpectrumSamples read_spectrum_file(const TomlValue& file, const std::string& column) {
  const auto path = (file.file().parent_path() / file.name()).lexically_normal();
  try {
    if (lower_extension(path) != ".spdx") return read_spectrum_csv(path, column);
    return read_tm27(path);
  } catch (const InputError& error) {
    file.fail(fmt::format("cannot be used: {}", error.what()));
  }
}

SpectrumSamples read_samples(const TomlTable& table) {
  if (!table.has("file")) return inline_samples(table);
  if (table.has("wavelengths") || table.has("values")) {
    table.fail("has a 'file' and also samples in place; keep one of them");
  }
  const std::string column = table.has("column") ? table.require("column").name() : "";
  const TomlValue file = table.require("file");
  if (!column.empty() && lower_extension(file.name()) == ".spdx") {
    table.fail("has a 'column', and TM-27 files have one spectrum; remove it");
  }
  return read_spectrum_file(file, column);
}

// A spectrum that is called by its name, or a file.
SpectrumSamples named_spectrum(const TomlValue& value) {
  const std::string name = value.name();
  // The temperatures of the names were revised with the second radiation constant.
  constexpr double revision = 1.4388 / 1.4380;
  constexpr std::array<std::pair<const char*, double>, 4> illuminants = {
      {{"D50", 5000.0}, {"D55", 5500.0}, {"D65", 6500.0}, {"D75", 7500.0}}};
  for (const auto& [known, kelvin] : illuminants) {
    if (name == known) return daylight_spectrum(revision * kelvin);
  }
  const std::string kind = lower_extension(name);
  if (kind == ".csv" || kind == ".spdx") return read_spectrum_file(value, "");
  value.fail(fmt::format(
      "is '{}'; write \"D50\", \"D55\", \"D65\", \"D75\", or a file ending in .csv or .spdx",
      name));
}

// The bands' powers of a spectrum; for RGB linear sRGB of its chromaticity.
Spectrum band_powers(const TomlValue& value, const SpectrumSamples& samples,
                     const TomlBands& bands) {
  constexpr double seen_from = 400.0, seen_to = 700.0, first = 360.0, last = 830.0;
  Spectrum powers(bands.bands.count());
  if (!bands.bands.wavelengths_nm.empty()) {
    for (int k = 0; k < powers.size(); ++k) {
      const auto [low, high] = bands.edges[static_cast<std::size_t>(k)];
      require_covered(value, samples, low, high, bands.bands.names[static_cast<std::size_t>(k)]);
      powers[k] = static_cast<float>(mean(samples, low, high) * (high - low));
    }
    return powers;
  }
  require_covered(value, samples, seen_from, seen_to, "of visible light");
  const double low = std::max(first, samples.wavelengths_nm.front());
  const double high = std::min(last, samples.wavelengths_nm.back());
  const int count = max_bands;
  const Bands fine = spectral_bands(low, high, count);
  Spectrum of_fine(count);
  const double width = (high - low) / count;
  for (int k = 0; k < count; ++k) {
    of_fine[k] = static_cast<float>(mean(samples, low + k * width, low + (k + 1) * width) * width);
  }
  const Spectrum rgb = linear_rgb(fine, of_fine);
  constexpr float rounding = 1e-6f;
  if (rgb.minCoeff() < -rounding * rgb.maxCoeff()) {
    value.fail(
        "has a chromaticity that no mixture of red, green and blue has; give the scene bands of "
        "wavelengths, or a 'color'");
  }
  return rgb.max(0.0f);
}

Spectrum sampled(const TomlValue& value, const TomlBands& bands, Quantity quantity) {
  const bool emits = quantity == Quantity::emission;
  const TomlTable table =
      emits ? value.table({"file", "column", "wavelengths", "values", "scale", "per"})
            : value.table({"file", "column", "wavelengths", "values", "scale"});
  const SpectrumSamples samples = read_samples(table);
  const double scale = table.has("scale") ? table.require("scale").number_at_least(0.0) : 1.0;
  const bool per_nm = table.has("per") && table.require("per").one_of({"band", "nm"}) == "nm";
  Spectrum result(bands.bands.count());
  for (int k = 0; k < result.size(); ++k) {
    const auto [low, high] = bands.edges[static_cast<std::size_t>(k)];
    require_covered(value, samples, low, high, bands.bands.names[static_cast<std::size_t>(k)]);
    const double x = mean(samples, low, high) * scale * (per_nm ? high - low : 1.0);
    if (!(x >= 0.0) || (!emits && !(x <= 1.0))) {
      value.fail(fmt::format("is {} in band {}; it must {}", x,
                             bands.bands.names[static_cast<std::size_t>(k)],
                             emits ? "be at least 0" : "lie between 0 and 1"));
    }
    result[k] = static_cast<float>(x);
  }
  return result;
}

Spectrum spectral(const TomlValue& value, const TomlBands& bands, Quantity quantity) {
  if (!value.is_number() && !value.is_array() && !value.is_table()) {
    value.fail("must be a number, an array of one number per band, or a spectrum { file = ... }");
  }
  const Spectrum result = value.is_array()   ? per_band(value, bands, quantity)
                          : value.is_table() ? sampled(value, bands, quantity)
                                             : constant(value, bands, quantity);
  if (!result.isFinite().all()) value.fail("is too large a number");
  return result;
}

}  // namespace

Spectrum read_toml_share(const TomlValue& value, const TomlBands& bands) {
  return spectral(value, bands, Quantity::share);
}

Spectrum read_toml_share_or(const TomlTable& table, const char* key, const TomlBands& bands,
                            float otherwise) {
  const auto value = table.find(key);
  return value ? spectral(*value, bands, Quantity::share)
               : constant_spectrum(bands.bands, otherwise);
}

TomlBands read_toml_bands(const TomlValue& value) {
  const TomlTable table = value.table({"kind", "lumens_per_watt", "from", "to", "count", "step"});
  const bool spectral_kind =
      table.has("kind") && table.require("kind").one_of({"rgb", "spectral"}) == "spectral";
  if (!spectral_kind) {
    for (const auto& key : table.present({"from", "to", "count", "step"})) {
      table.require(key).fail("belongs to kind = \"spectral\"; RGB bands have no edges to choose");
    }
    TomlBands result;
    if (const auto efficacy = table.find("lumens_per_watt")) {
      result.bands = rgb_bands(efficacy->positive());
    }
    return result;
  }
  if (const auto efficacy = table.find("lumens_per_watt")) {
    efficacy->fail("belongs to kind = \"rgb\"; wavelengths have theirs from the CIE observer");
  }
  const double low = table.has("from") ? table.require("from").number_within(360, 830) : 400.0;
  const double high = table.has("to") ? table.require("to").number_within(360, 830) : 700.0;
  if (!(low < high))
    table.fail(fmt::format("go from {} nm to {} nm; 'to' must be greater", low, high));
  if (table.has("count") == table.has("step")) table.fail("need exactly one of 'count' and 'step'");
  int count = 0;
  if (table.has("count")) {
    count = static_cast<int>(table.require("count").integer_within(1, max_bands));
  } else {
    const TomlValue step = table.require("step");
    const double exact = (high - low) / step.positive();
    if (!(exact > 0.5 && exact < max_bands + 0.5)) {
      step.fail(fmt::format("makes {:.6g} bands; it must make between 1 and {}", exact, max_bands));
    }
    if (!(std::abs(exact - std::round(exact)) <= 1e-6)) {
      step.fail(fmt::format("cuts {}-{} nm into {:.6g} bands; it must make a whole number of them",
                            low, high, exact));
    }
    count = static_cast<int>(std::round(exact));
  }
  TomlBands result{.bands = spectral_bands(low, high, count), .edges = {}};
  const double width = (high - low) / count;
  for (int k = 0; k < count; ++k) result.edges.push_back({low + k * width, low + (k + 1) * width});
  return result;
}

Spectrum read_toml_emission(const TomlValue& value, const TomlBands& bands) {
  return spectral(value, bands, Quantity::emission);
}

Spectrum read_toml_daylight_colour(const TomlTable& table, const TomlBands& bands) {
  const auto given = table.present({"color", "cct", "spectrum"});
  if (given.size() > 1) {
    table.require(given[1]).fail(fmt::format("is a second statement of what '{}' says", given[0]));
  }
  if (given.empty()) return constant_spectrum(bands.bands, 1.0f);
  const TomlValue value = table.require(given[0]);
  if (given[0] == "color") return read_toml_emission(value, bands);
  const SpectrumSamples samples =
      given[0] == "spectrum"
          ? named_spectrum(value)
          : daylight_spectrum(value.number_within(coolest_daylight, hottest_daylight));
  const Spectrum powers = band_powers(value, samples, bands);
  if (!(powers >= 0.0f).all() || !(powers.maxCoeff() > 0.0f)) {
    value.fail("has no light in the scene's bands, or less than none in one of them");
  }
  return powers / powers.maxCoeff();
}

Spectrum toml_colour_of_spectra(const TomlValue& file, const std::vector<EmitterSpectrum>& spectra,
                                const TomlBands& bands) {
  Spectrum colour = constant_spectrum(bands.bands, 0.0f);
  for (const EmitterSpectrum& spectrum : spectra) {
    const Spectrum powers = band_powers(file, spectrum.samples, bands);
    const double lumens = luminous(bands.bands, powers);
    if (!(powers >= 0.0f).all() || !powers.isFinite().all() || !(lumens > 0.0)) {
      file.fail(
          fmt::format("has a spectrum, of the emitter '{}', without visible light in the scene's "
                      "bands, or with "
                      "less than none in one of them; give the lamp a 'colour'",
                      spectrum.name));
    }
    colour += powers * static_cast<float>(spectrum.flux / lumens);
  }
  return colour;
}

Spectrum read_toml_colour(const TomlTable& table, const TomlBands& bands) {
  const auto colour = table.find("colour");
  if (!colour) return constant_spectrum(bands.bands, 1.0f);
  const Spectrum values = read_toml_emission(*colour, bands);
  if (!(luminous(bands.bands, values) > 0.0)) {
    colour->fail("is black; give a colour that people see, or remove it");
  }
  return values;
}

}  // namespace lightwell
