#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/bands.h"

namespace lightwell {

/// Layers of a picture beside its radiance, about the surface that a pixel shows: the first that
/// its eye rays meet.
enum class Layer {
  albedo,  ///< diffuse reflectance, as RGB under equal-energy light, white = 1
  normal,  ///< towards the eye, in the scene's axes; smoothed like the shading
  /// Depth at the pixel's centre, m along the camera's direction, or from its position if the
  /// picture is not flat; infinity: nothing is there.
  depth,
  direct,     ///< rho E_direct / pi, W/(m^2 sr), as linear RGB
  indirect,   ///< rho E_indirect / pi, the same
  specular,   ///< light from mirrors and through glass
  emission,   ///< M / pi; direct + indirect + specular + emission = the picture
  luminance,  ///< luminance of the picture, cd/m^2
  /// Illuminance of the surface, lx; for clear glass, of the surface seen straight through the
  /// glass.
  illuminance,
  patch,  ///< patch number in the solution, at the pixel's centre; -1: none
  /// Share of the pixel that shows something, which is less at and beyond the circle of a fisheye.
  /// Radiance is already multiplied by it.
  coverage,
};

struct NamedLayer {
  Layer layer;
  std::string_view name;
  std::string_view components;  ///< one letter per channel; for `patch` one word
  std::string_view unit;
};

/// All layers, in the order of their channels in a picture.
inline constexpr std::array<NamedLayer, 11> named_layers = {{
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
    {Layer::coverage, "coverage", "A", "share, 0 to 1"},
}};

const NamedLayer& named(Layer layer);
/// Returns the layer of a name; empty if the name is unknown.
std::optional<Layer> layer_named(std::string_view name);
/// Names of a layer's channels as in OpenEXR: "albedo.R", "albedo.G", "albedo.B"; "depth.Z";
/// "patch.id". That of coverage is "A", OpenEXR's name of alpha.
std::vector<std::string> channel_names(Layer layer);

/// One column for each channel of a picture's layers; rows as in Image::radiance.
struct LayerColumns {
  std::vector<std::string> names{};  ///< see channel_names
  BandArray values{};

  bool is_empty() const { return names.empty(); }
};

/// Columns of all layers that are averaged over a pixel's samples, one layer after another, whether
/// or not a picture holds the layer.
using SampledLayers = Eigen::Array<float, 19, 1>;

/// First column of a layer in SampledLayers; -1 for layers that are not sampled.
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
    case Layer::coverage:
      break;
  }
  return -1;
}

}  // namespace lightwell
