// ANSI/IES TM-33-18 and TM-33-23: an XML file of emitters, each with intensities and a spectrum.
#include "scene/io/luminaires/tm33_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "scene/utf8.h"

namespace lightwell {
namespace {

constexpr int most_tm33_emitters = 100;

struct Tm33Metric {
  const char* data;
  const char* intensity;
  bool is_radiometric;
};
constexpr Tm33Metric luminous_metric = {"LuminousData", "LuminousIntensity", false};
constexpr Tm33Metric radiant_metric = {"RadiantData", "RadiantIntensity", true};

pugi::xml_node intensity_of(const pugi::xml_node& emitter, const Tm33Metric& metric) {
  return emitter.child(metric.data).child(metric.intensity);
}

std::string name_of(const pugi::xml_node& emitter) {
  return as_utf8(without_xml_space(emitter.child_value("Description")));
}

// Luminous data if all emitters have them, else radiant data.
Tm33Metric common_metric(const XmlFile& file, const pugi::xml_node& root) {
  const auto emitters = root.children("Emitter");
  const auto all_have = [&](const Tm33Metric& metric) {
    return std::all_of(emitters.begin(), emitters.end(), [&](const pugi::xml_node& emitter) {
      return !intensity_of(emitter, metric).empty();
    });
  };
  const auto count = std::distance(emitters.begin(), emitters.end());
  if (count == 0) file.fail(root, "there is no <Emitter>; a TM-33 file has at least one");
  if (count > most_tm33_emitters) {
    file.fail(root,
              fmt::format("there are {} emitters; at most {} are read", count, most_tm33_emitters));
  }
  if (all_have(luminous_metric)) return luminous_metric;
  if (all_have(radiant_metric)) return radiant_metric;
  for (const pugi::xml_node emitter : emitters) {
    if (intensity_of(emitter, luminous_metric) || intensity_of(emitter, radiant_metric)) continue;
    file.fail(
        emitter,
        fmt::format("the emitter '{}' has neither <LuminousIntensity> in <LuminousData> nor "
                    "<RadiantIntensity> in <RadiantData>{}; give one of them",
                    name_of(emitter),
                    emitter.child("PhotonData") ? ", and photon intensities are not read" : ""));
  }
  file.fail(root,
            "some emitters have luminous intensities alone and others radiant ones alone, which do "
            "not add up; give one kind for all");
}

void check_type(const XmlFile& file, const pugi::xml_node& root) {
  const pugi::xml_node type = root.child("Equipment").child("Gonioradiometer").child("Type");
  if (!type) return;
  const std::string word = tm33_word(type.child_value());
  if (word == "cie_c" || word == "ies_c") return;
  file.fail(type, fmt::format("the photometry is of type '{}'; only type C (CIE_C, IES_C) is read, "
                              "as indoor and road luminaires have it",
                              as_utf8(excerpt(without_xml_space(type.child_value())))));
}

double factor_of(const XmlFile& file, const pugi::xml_node& emitter,
                 std::vector<std::string>& notes) {
  double factor = tm33_number(file, emitter, "BallastFactor").value_or(1.0);
  const pugi::xml_node tilts = emitter.child("TiltAngles");
  for (const pugi::xml_node tilt : tilts.children("Tilt")) {
    if (file.number(tilt, "tilt", tilt.attribute("angle").value()) != 0.0) continue;
    factor *=
        file.number(tilt, "tilt factor", tilt.child_value());  // a level luminaire's tilt is 0
  }
  if (tilts) {
    notes.emplace_back(
        "Its TILT factors are taken for a luminaire that hangs level, whatever way it is turned.");
  }
  if (emitter.child("Channels")) {
    notes.push_back(fmt::format(
        "Its emitter '{}' has channels to dim; the intensities are taken as the file has them.",
        name_of(emitter)));
  }
  const double quantity = tm33_number(file, emitter, "Quantity").value_or(1.0);
  if (quantity != 1.0) {
    notes.push_back(
        fmt::format("Its emitter '{}' stands for {:g} alike; intensities and watts are taken to be "
                    "those of all together.",
                    name_of(emitter), quantity));
  }
  return factor;
}

// Spectrum of an emitter; empty, with a note, if the file leaves open which.
SpectrumSamples spectrum_of(const XmlFile& file, const pugi::xml_node& emitter,
                            std::vector<std::string>& notes) {
  SpectrumSamples samples;
  const auto spectra = emitter.child("SpectralData").children("EmitterSpectral");
  const auto count = std::distance(spectra.begin(), spectra.end());
  if (count == 0) return samples;
  const pugi::xml_node spectrum = *spectra.begin();
  const bool is_of_quanta = tm33_number(file, spectrum, "Quantum").value_or(0.0) != 0.0;
  if (count > 1 || is_of_quanta) {
    notes.push_back(fmt::format("Its emitter '{}' has {}, which is not read.", name_of(emitter),
                                count > 1 ? fmt::format("{} spectra without their shares", count)
                                          : "a spectrum of photons"));
    return samples;
  }
  // The flux of the emitter scales the spectrum, so that its multiplier cancels.
  for (const pugi::xml_node data : spectrum.children("PwrData")) {
    append_sample(file, data, file.number(data, "wavelength w", data.attribute("w").value()),
                  file.number(data, "power", data.child_value()), samples);
  }
  if (samples.values.size() < 2) file.fail(spectrum, "a spectrum needs at least two <PwrData>");
  const auto stated = tm33_number(file, spectrum, "NumberWavelength");
  if (stated && *stated != static_cast<double>(samples.values.size())) {
    file.fail(spectrum, fmt::format("NumberWavelength is {:g}, and there are {} <PwrData>", *stated,
                                    samples.values.size()));
  }
  return samples;
}

void read_electrics(const XmlFile& file, const pugi::xml_node& emitter, LuminaireFile& result) {
  const double watts = tm33_number(file, emitter, "InputWattage").value_or(0.0);
  if (!(watts >= 0.0)) {
    file.fail(emitter.child("InputWattage"),
              fmt::format("the input wattage is {:g}; it must not be below 0", watts));
  }
  result.watts += watts;
  const std::string absolute = tm33_word(
      emitter.child("LuminousData").child("LuminousIntensity").child_value("AbsolutePhotometry"));
  const double lumens = tm33_number(file, emitter, "RatedLumens").value_or(0.0);
  if ((absolute == "false" || absolute == "0") && lumens > 0.0) result.lamp_lumens += lumens;
}

void read_header(const pugi::xml_node& root, LuminaireFile& result) {
  const pugi::xml_node header = root.child("Header");
  const auto text = [&](const char* name) {
    return as_utf8(without_xml_space(header.child_value(name)));
  };
  result.format = std::string_view(root.name()) == "IESTM33-22" ? "IES TM-33-23" : "IES TM-33-18";
  result.name = text("Description");
  if (result.name.empty()) result.name = text("CatalogNumber");
  result.maker = text("Manufacturer");
}

}  // namespace

bool is_tm33_root(std::string_view name) {
  return name == "IESTM33" || name == "IESTM33-18" || name == "IESTM33-22";
}

std::string tm33_word(std::string_view text) {
  std::string word = lower_case(text);
  std::erase_if(word, [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; });
  return word;
}

std::optional<double> tm33_number(const XmlFile& file, const pugi::xml_node& parent,
                                  const char* child) {
  const pugi::xml_node element = parent.child(child);
  if (!element) return std::nullopt;
  return file.number(element, child, element.child_value());
}

LuminaireFile read_tm33(const std::filesystem::path& path) {
  const XmlFile file(path, "TM-33 files");
  const pugi::xml_node root = file.document().document_element();
  if (!is_tm33_root(root.name())) {
    file.fail(root, fmt::format("the root element is <{}>; photometric XML begins with <IESTM33> "
                                "(TM-33-18) or <IESTM33-22> (TM-33-23)",
                                as_utf8(excerpt(root.name()))));
  }
  LuminaireFile result{.file = path};
  read_header(root, result);
  check_type(file, root);
  const Tm33Metric metric = common_metric(file, root);
  result.is_radiometric = metric.is_radiometric;
  std::vector<Tm33Table> tables;
  for (const pugi::xml_node emitter : root.children("Emitter")) {
    const double factor = factor_of(file, emitter, result.notes);
    tables.push_back(read_tm33_table(file, intensity_of(emitter, metric), factor));
    read_electrics(file, emitter, result);
    const Tm33Table& table = tables.back();
    result.spectra.push_back(
        {.name = name_of(emitter),
         .flux = PhotometricWeb(table.planes, table.gammas, table.values).integral(),
         .samples = spectrum_of(file, emitter, result.notes)});
  }
  const auto has_none = [](const EmitterSpectrum& s) { return s.samples.values.empty(); };
  if (metric.is_radiometric || std::ranges::any_of(result.spectra, has_none)) {
    if (!std::ranges::all_of(result.spectra, has_none)) {
      result.notes.emplace_back(
          "Its spectra are not used: that takes candela, and a spectrum for every emitter.");
    }
    result.spectra.clear();
  }
  if (tables.size() > 1) {
    result.notes.push_back(
        fmt::format("Its {} emitters shine as one, from one opening.", tables.size()));
  }
  Tm33Table sum = sum_of_tm33_tables(path, tables);
  result.symmetry = symmetry_words(sum.symmetry);
  result.web = std::make_shared<const PhotometricWeb>(std::move(sum.planes), std::move(sum.gammas),
                                                      sum.values);
  read_tm33_sizes(file, root, result);
  return result;
}

}  // namespace lightwell
