#pragma once

#include <vtkSmartPointer.h>

#include <cstdint>
#include <vector>

#include "viewer/export/sky_grid.h"

class vtkActor;
class vtkImageData;
class vtkRenderer;

namespace lightwell {

/// Sky, ground and sun behind the scene: a dome that goes along with the eye, far behind all else.
class SkyActor {
 public:
  explicit SkyActor(const Sky& sky);
  ~SkyActor();

  void add_to(vtkRenderer* renderer) const;
  /// The same sky, otherwise bright.
  void set_sky(const Sky& sky);
  /// `scale`: from radiance to display values, as display_colors takes it.
  void expose(const Bands& bands, double scale);
  /// `radius` (m): of the dome, which is to be seen from its middle.
  void place(const Eigen::Vector3d& eye, double radius);
  void show(bool shown);

 private:
  Sky sky_;
  SkyGrid grid_;
  vtkSmartPointer<vtkImageData> texels_;
  vtkSmartPointer<vtkActor> dome_, sun_;  // without a sun: null
};

}  // namespace lightwell
