#pragma once

#include <vtkSmartPointer.h>

#include <cstdint>
#include <vector>

#include "viewer/export/sky_grid.h"

class vtkActor;
class vtkImageData;
class vtkRenderer;

namespace lightwell {

/// Sky, ground and sun, on a dome around the eye, behind all surfaces of the scene.
class SkyActor {
 public:
  explicit SkyActor(const Sky& sky);
  ~SkyActor();

  void add_to(vtkRenderer* renderer) const;
  /// Sets the brightness: `sky` differs from the constructor's in nothing else. Takes effect with
  /// expose().
  void set_sky(const Sky& sky);
  /// Colours dome and sun. `scale` is the factor from radiance to display values, as in
  /// display_colors().
  void expose(const Bands& bands, const Eigen::Array3f& scale);
  /// Puts the centre of the dome at the eye, with a radius in m.
  void place(const Eigen::Vector3d& eye, double radius);
  void show(bool shown);

 private:
  Sky sky_;
  SkyGrid grid_;
  vtkSmartPointer<vtkImageData> texels_;
  vtkSmartPointer<vtkActor> dome_, sun_;  ///< sun_ is null without a sun
};

}  // namespace lightwell
