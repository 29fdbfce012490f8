#pragma once

#include <vtkSmartPointer.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "viewer/export/appearance.h"
#include "viewer/export/start_view.h"
#include "viewer/window/isolux.h"
#include "viewer/window/lamp_actor.h"
#include "viewer/window/legend_actor.h"
#include "viewer/window/sky_actor.h"
#include "viewer/window/solution_actor.h"
#include "viewer/window/view.h"

class vtkRenderer;

namespace lightwell {

/// How numbers become false colours.
enum class Scaling : std::uint8_t {
  given,  ///< linear if the range begins at 0, else logarithmic
  linear,
  logarithmic,
  classes,  ///< of illuminance: bands between the illuminances of lux_classes
};

/// Parameters of a picture of a solution.
struct Look {
  Camera camera{};
  double metered_scale = 1.0;               ///< automatic exposure, from radiance to display values
  std::optional<IncidentLight> incident{};  ///< light on what the camera sees, by the same meter
  WhitePoint white{};                       ///< light that shows as grey
  double exposure_ev = 0.0;                 ///< stops on top of metered_scale
  bool mesh = false;                        ///< outlines of the elements
  bool unlit = true;         ///< draw surfaces without light in black; else leave them out
  bool illuminance = false;  ///< false colours of `measure`, with a legend
  Measure measure = Measure::illuminance;  ///< quantity of the false colours
  Scaling scaling = Scaling::given;
  bool interpolation_error = false;  ///< error_colors() instead of light or false colours
  bool isolux = false;               ///< lines of equal illuminance
};

/// Factors from linear RGB to display values: exposure times white balance.
Eigen::Array3f display_scale(const Look& look);

/// A solution as a VTK renderer with its actors. Keeps a reference to the solution and its mesh.
class SolutionView {
 public:
  SolutionView(const SolvedScene& solved, const ViewOptions& options);
  ~SolutionView();

  const Look& look() const { return look_; }
  void set_look(const Look& look);
  /// Fits the scale of the false colours shown to what the camera sees, also in place of a range of
  /// the options.
  void fit_range();
  /// The scale of the false colours shown, in the unit of look().measure.
  LuxRange measured_range() const;
  /// True if false colours show the classes of illuminance.
  bool shows_classes() const;
  /// Updates the picture after a change of the solution's light. The scale of false colours stays.
  void light_changed();
  /// Shows the light of `other` instead, a solution of the same mesh that must outlive the view.
  void follow(const SolvedScene& other);
  /// Updates the picture during progressive refinement. The scale of false colours follows the
  /// light, unless the options have a range of illuminance. Elements without direct irradiance
  /// count as unlit, since the ambient term is an estimate.
  void light_arrived();
  /// Sets the unshot light of each patch, lm/m^2, for Measure::unshot.
  void set_unshot(const Eigen::ArrayXf& unshot);
  /// Returns `look` with the automatic exposure, and the incident light, of a camera's picture (see
  /// meter_view()).
  Look metered(Look look, const Camera& camera) const;

  const ElementCaster& caster() const { return caster_; }
  const std::vector<ElementKind>& kinds() const { return kinds_; }
  /// Irradiance, W/m^2, vertices x bands.
  const BandArray& irradiance() const { return irradiance_; }
  const SolvedScene& solved() const { return *solved_; }
  /// Levels of the isolux lines, lx.
  std::vector<double> isolux_levels() const;
  const Camera& start_camera() const { return start_camera_; }
  const Bounds& bounds() const { return bounds_; }
  const Eigen::Vector3d& up_axis() const { return up_axis_; }
  vtkRenderer* renderer() const;

 private:
  void apply_camera();
  void apply_colors();
  void apply_lamps();
  void apply_legend();
  void apply_isolux();
  /// Values of a quantity at vertices, in its unit, and the range of those in view.
  std::vector<float> measured(Measure measure) const;
  LuxRange fitted(Measure measure) const;
  /// Fits the range of look().measure, which is not illuminance.
  void fit_other();

  /// The sky outside, scaled as in the solution; null: black.
  const Sky* sky() const { return sky_ ? &*sky_ : nullptr; }

  const SolvedScene* solved_;
  const Scene* scene_;
  std::vector<Material> materials_;
  std::optional<LuxRange> given_range_;  ///< range of given_measure_
  Measure given_measure_;
  bool has_relative_units_;
  std::vector<float> unshot_{};  ///< at vertices
  ElementCaster caster_;
  std::vector<ElementKind> kinds_;
  BandArray irradiance_;
  BandArray radiance_;
  DrawnPictures drawn_;
  BandArray picture_gain_;  ///< see picture_gains(); empty without textures
  std::vector<float> lux_;
  LuxRange lux_range_{};                   ///< range of illuminance
  std::optional<LuxRange> other_range_{};  ///< range of other_measure_
  Measure other_measure_ = Measure::luminance;
  Bounds bounds_;
  Eigen::Vector3d up_axis_;
  Camera start_camera_;
  Look look_;
  FineRoundShapes spheres_;
  SolutionActor actor_;
  std::optional<Sky> sky_;
  std::optional<SkyActor> outside_;
  DrawnLamps drawn_lamps_;
  std::optional<LampActor> lamps_;  ///< empty: none is drawn
  vtkSmartPointer<vtkRenderer> renderer_;
  LegendActor legend_;
  std::vector<double> isolux_levels_;  ///< levels of the options; empty: see isolux_levels()
  bool isolux_is_stale_ = true;
  IsoluxLines isolux_;
};

/// Draws a view off screen with 16 samples a pixel (a Hammersley set), averaged in linear light.
/// Returns 8-bit sRGB, 3 bytes a pixel, row 0 on top. Needs a DisplayConnection. Throws
/// std::runtime_error if the graphics driver cannot draw.
std::vector<std::uint8_t> draw_offscreen(const SolutionView& view, int width, int height);

}  // namespace lightwell
