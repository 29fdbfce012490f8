#include "daylight/grey_scene.h"

#include <algorithm>
#include <functional>
#include <vector>

namespace lightwell {
namespace {

// All spectra of a material that decide what becomes of light.
std::vector<Spectrum*> spectra_of(Material& material) {
  std::vector<Spectrum*> spectra = {&material.reflectance, &material.transmittance,
                                    &material.regular_transmittance, &material.specular,
                                    &material.emission};
  if (material.coat) spectra.push_back(&material.coat->bare);
  if (material.metal) {
    spectra.push_back(&material.metal->eta);
    spectra.push_back(&material.metal->k);
  }
  if (material.dielectric) {
    spectra.push_back(&material.dielectric->tint);
    spectra.push_back(&material.dielectric->absorption);
    spectra.push_back(&material.dielectric->transmissivity);
  }
  return spectra;
}

bool is_grey(const Spectrum& spectrum) {
  return spectrum.size() == 0 || (spectrum == spectrum[0]).all();
}

Bands one_band() {
  Bands bands{.names = {"grey"}};
  bands.xyz.setOnes(3, 1);
  return bands;
}

}  // namespace

Scene with_one_band_if_grey(Scene scene) {
  for (Material& material : scene.materials) {
    if (material.shows_picture() ||
        !std::ranges::all_of(spectra_of(material),
                             [](const Spectrum* spectrum) { return is_grey(*spectrum); })) {
      return scene;
    }
  }
  for (Material& material : scene.materials) {
    for (Spectrum* spectrum : spectra_of(material)) {
      if (spectrum->size() > 0) *spectrum = Spectrum::Constant(1, (*spectrum)[0]);
    }
  }
  scene.bands = one_band();
  return scene;
}

}  // namespace lightwell
