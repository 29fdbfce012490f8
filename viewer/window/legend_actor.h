#pragma once

#include <vtkSmartPointer.h>

#include <optional>
#include <string>

#include "viewer/export/appearance.h"

class vtkActor2D;
class vtkImageData;
class vtkRenderer;

namespace lightwell {

/// The values that a legend shows.
struct LegendContent {
  LuxRange range{};
  std::string unit{};
  bool classes = false;  ///< the classes of illuminance, instead of `range`
};

/// The scale of false colours at the right edge of a picture, half as high as the picture. Letters
/// shrink where a picture has no room for them.
class LegendActor {
 public:
  /// `text_scale`: size of the letters, as a multiple of 14 pixels.
  explicit LegendActor(double text_scale);
  ~LegendActor();
  LegendActor(const LegendActor&) = delete;
  LegendActor& operator=(const LegendActor&) = delete;

  /// Adds the legend to a renderer, once; the renderer must not outlive the legend's last drawing.
  void add_to(vtkRenderer* renderer);
  /// Shows a scale, or nothing.
  void set(const std::optional<LegendContent>& content);

 private:
  void fit(int width, int height);

  double text_scale_;
  std::optional<LegendContent> content_{};
  int width_ = 0, height_ = 0;  ///< of the picture that the legend is drawn for
  vtkSmartPointer<vtkImageData> image_;
  vtkSmartPointer<vtkActor2D> actor_;
  vtkSmartPointer<vtkRenderer> renderer_;
  unsigned long observer_ = 0;
};

}  // namespace lightwell
