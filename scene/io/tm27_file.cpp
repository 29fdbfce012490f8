#include <fmt/format.h>

#include <algorithm>
#include <pugixml.hpp>

#include "scene/io/spectrum_file.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

// The line of a place in the file.
int line_at(const std::string& text, std::ptrdiff_t offset) {
  const auto end = text.begin() + std::clamp<std::ptrdiff_t>(offset, 0, std::ssize(text));
  return 1 + static_cast<int>(std::count(text.begin(), end, '\n'));
}

double number_of_tm27(const TextFile& file, const pugi::xml_node& data, const char* what,
                      std::string_view text) {
  if (const auto value = parse_finite(trimmed(text))) return *value;
  file.fail(line_at(file.text(), data.offset_debug()),
            fmt::format("the {} '{}' is not a finite number", what, excerpt(text)));
}

}  // namespace

SpectrumSamples read_tm27(const std::filesystem::path& path) {
  const TextFile file(path);
  const std::string& text = file.text();
  pugi::xml_document document{};
  const pugi::xml_parse_result parsed = document.load_buffer(text.data(), text.size());
  if (!parsed) {
    file.fail(line_at(text, parsed.offset),
              fmt::format("this is not XML ({}); TM-27 files are", parsed.description()));
  }
  const pugi::xml_node spectrum = document.child("IESTM2714").child("SpectralDistribution");
  if (!spectrum) {
    file.fail(1, "there is no <SpectralDistribution> in <IESTM2714>; give a TM-27-14 file");
  }
  SpectrumSamples samples;
  for (const pugi::xml_node data : spectrum.children("SpectralData")) {
    const double nm =
        number_of_tm27(file, data, "wavelength", data.attribute("wavelength").value());
    if (!samples.wavelengths_nm.empty() && !(nm > samples.wavelengths_nm.back())) {
      file.fail(line_at(text, data.offset_debug()),
                fmt::format("wavelength {} nm follows {} nm; wavelengths must rise", nm,
                            samples.wavelengths_nm.back()));
    }
    samples.wavelengths_nm.push_back(nm);
    samples.values.push_back(number_of_tm27(file, data, "value", data.child_value()));
  }
  if (samples.values.size() < 2) file.fail(1, "a spectrum needs at least two <SpectralData>");
  return samples;
}

}  // namespace lightwell
