#include <fmt/format.h>

#include "scene/io/spectrum_file.h"
#include "scene/io/xml_file.h"

namespace lightwell {

SpectrumSamples read_tm27(const std::filesystem::path& path) {
  const XmlFile file(path, "TM-27 files");
  const pugi::xml_node spectrum = file.document().child("IESTM2714").child("SpectralDistribution");
  if (!spectrum) {
    file.fail(file.document(),
              "there is no <SpectralDistribution> in <IESTM2714>; give a TM-27-14 file");
  }
  SpectrumSamples samples;
  for (const pugi::xml_node data : spectrum.children("SpectralData")) {
    append_sample(file, data, file.number(data, "wavelength", data.attribute("wavelength").value()),
                  file.number(data, "value", data.child_value()), samples);
  }
  if (samples.values.size() < 2) {
    file.fail(file.document(), "a spectrum needs at least two <SpectralData>");
  }
  return samples;
}

}  // namespace lightwell
