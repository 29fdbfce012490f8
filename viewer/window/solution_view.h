#pragma once

#include <vtkSmartPointer.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "viewer/export/appearance.h"
#include "viewer/export/start_view.h"
#include "viewer/window/isolux.h"
#include "viewer/window/sky_actor.h"
#include "viewer/window/solution_actor.h"
#include "viewer/window/view.h"

class vtkRenderer;
class vtkScalarBarActor;

namespace lightwell {

/// All that decides a picture of a solution.
struct Look {
  Camera camera{};
  double metered_scale = 1.0;  ///< automatic exposure, from radiance to display values
  double exposure_ev = 0.0;    ///< stops on top
  bool mesh = false;           ///< outlines of the elements
  bool unlit = true;           ///< surfaces without light are drawn, black; else looked through
  bool illuminance = false;    ///< false colours with a legend instead of light
  Measure measure = Measure::illuminance;  ///< what those show
  bool interpolation_error = false;        ///< see error_colors; goes before illuminance
  bool isolux = false;                     ///< lines of equal illuminance
};

/// A solution set up for drawing with VTK. Keeps a reference to the solution and its mesh.
class SolutionView {
 public:
  SolutionView(const SolvedScene& solved, const ViewOptions& options);
  ~SolutionView();

  const Look& look() const { return look_; }
  void set_look(const Look& look);
  /// Shows the light that the solution has now, in colours of the same scale.
  void light_changed();
  /// From now on shows the light of another solution, of the same mesh, which must outlive it.
  void follow(const SolvedScene& other);
  /// The same while light is arriving: its scale of false colours follows it, unless the options
  /// name one. What has no direct irradiance counts as unlit, for the rest is foretold.
  void light_arrived();
  /// What each patch is still to shoot, lm/m^2: for Measure::unshot.
  void set_unshot(const Eigen::ArrayXf& unshot);
  /// The exposure_scale of the picture the camera sees.
  double meter(const Camera& camera) const;

  const ElementCaster& caster() const { return caster_; }
  const std::vector<ElementKind>& kinds() const { return kinds_; }
  /// At vertices, W/m^2, vertices x bands.
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
  void apply_legend();
  void apply_isolux();
  /// What false colours show, at vertices; and their scale.
  std::vector<float> measured() const;
  LuxRange measured_range() const;

  /// What is seen outside, as bright as the solution has it; null: black.
  const Sky* sky() const { return sky_ ? &*sky_ : nullptr; }

  const SolvedScene* solved_;
  const Scene* scene_;
  std::vector<Material> materials_;
  std::optional<LuxRange> given_range_;  ///< of given_measure_
  Measure given_measure_;
  bool has_relative_units_;
  std::vector<float> unshot_{};  ///< at vertices
  ElementCaster caster_;
  std::vector<ElementKind> kinds_;
  BandArray irradiance_;
  BandArray radiance_;
  DrawnPictures drawn_;
  BandArray picture_gain_;  ///< see picture_gains; empty without pictures
  std::vector<float> lux_;
  LuxRange lux_range_;  ///< of illuminance
  Bounds bounds_;
  Eigen::Vector3d up_axis_;
  Camera start_camera_;
  Look look_;
  FineSpheres spheres_;
  SolutionActor actor_;
  std::optional<Sky> sky_;
  std::optional<SkyActor> outside_;
  vtkSmartPointer<vtkRenderer> renderer_;
  vtkSmartPointer<vtkScalarBarActor> legend_;
  std::vector<double> isolux_levels_;  ///< asked for; empty: they suit the scale
  bool isolux_is_stale_ = true;
  IsoluxLines isolux_;
};

/// Draws off screen, 16 samples a pixel (a Hammersley set), averaged in linear light. 8-bit sRGB,
/// 3 bytes a pixel, row 0 on top. Needs a DisplayConnection. Throws std::runtime_error if the
/// graphics driver cannot draw.
std::vector<std::uint8_t> draw_offscreen(const SolutionView& view, int width, int height);

}  // namespace lightwell
