#include "scene/io/default_material.h"

namespace lightwell {

Material default_material(const Bands& bands) {
  const Spectrum zero = constant_spectrum(bands, 0.0f);
  return {.name = "default",
          .reflectance = constant_spectrum(bands, 0.5f),
          .specular = zero,
          .emission = zero};
}

}  // namespace lightwell
