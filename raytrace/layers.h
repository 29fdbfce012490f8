#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/bands.h"

namespace lightwell {

/// What a picture can hold beside its radiance, about the surface that a pixel shows: the first
/// that its eye rays meet.
enum class Layer {
  albedo,       ///< diffuse reflectance, as RGB under equal-energy light, white = 1
  normal,       ///< towards the eye, in the scene's axes; smooth where light is
  depth,        ///< metres along the camera's direction, of the pixel's centre; infinity: nothing
  direct,       ///< rho E_direct / pi: light straight from lamps, W/(m^2 sr), as linear RGB
  indirect,     ///< rho E_indirect / pi
  specular,     ///< what is seen in mirrors and through glass
  emission,     ///< M / pi; direct + indirect + specular + emission = the picture
  luminance,    ///< of the picture, cd/m^2
  illuminance,  ///< on the surface, lx; of clear glass on what is seen straight through it
  patch,        ///< of the solution, at the pixel's centre; -1: none
};

struct NamedLayer {
  Layer layer;
  std::string_view name;
  std::string_view components;  ///< a letter each; of the patch, one word
  std::string_view unit;
};

/// All there are, in their order.
inline constexpr std::array<NamedLayer, 10> named_layers = {{
    {Layer::albedo, "albedo", "RGB", "share, 0 to 1"},
    {Layer::normal, "normal", "XYZ", "unit vector"},
    {Layer::depth, "depth", "Z", "m"},
    {Layer::direct, "direct", "RGB", "W/(m^2 sr)"},
    {Layer::indirect, "indirect", "RGB", "W/(m^2 sr)"},
    {Layer::specular, "specular", "RGB", "W/(m^2 sr)"},
    {Layer::emission, "emission", "RGB", "W/(m^2 sr)"},
    {Layer::luminance, "luminance", "Y", "cd/m^2"},
    {Layer::illuminance, "illuminance", "Y", "lx"},
    {Layer::patch, "patch", "id", "number of the solution's patch"},
}};

const NamedLayer& named(Layer layer);
/// Nothing if there is none of that name.
std::optional<Layer> layer_named(std::string_view name);
/// As OpenEXR has them: "albedo.R", "albedo.G", "albedo.B"; "depth.Z"; "patch.id".
std::vector<std::string> channel_names(Layer layer);

/// One column for each channel of a picture's layers; rows as in Image::radiance.
struct LayerColumns {
  std::vector<std::string> names{};  ///< see channel_names
  BandArray values{};

  bool is_empty() const { return names.empty(); }
};

/// The layers of one sample that are averaged over a pixel, whether asked for or not: their columns
/// one after another.
using SampledLayers = Eigen::Array<float, 19, 1>;

/// Where a layer starts in SampledLayers; -1 for those that are not sampled.
constexpr int first_sampled_column(Layer layer) {
  switch (layer) {
    case Layer::albedo:
      return 0;
    case Layer::normal:
      return 3;
    case Layer::direct:
      return 6;
    case Layer::indirect:
      return 9;
    case Layer::specular:
      return 12;
    case Layer::emission:
      return 15;
    case Layer::illuminance:
      return 18;
    case Layer::depth:
    case Layer::luminance:
    case Layer::patch:
      break;
  }
  return -1;
}

}  // namespace lightwell
