#pragma once

#include <vtkSmartPointer.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "radiosity/solve.h"
#include "raytrace/pictures/image.h"

class vtkActor2D;
class vtkImageData;
class vtkRenderer;

namespace lightwell {

enum class StillPhase { none, rendering, shown, failed };

/// The second pass's picture of a view, rendered in a thread of its own that does not block the
/// window. Finished strips cover the window from the top down.
class Still {
 public:
  Still();
  /// Ends the rendering within a second.
  ~Still();
  Still(const Still&) = delete;
  Still& operator=(const Still&) = delete;

  /// Adds the picture to a renderer. Text that is added later is drawn over the picture.
  void add_to(vtkRenderer* renderer) const;
  /// Begins to render the camera's picture, of the camera's size, with `scale` as the factors from
  /// linear RGB to display values. Copies the parts of the solution that rendering needs, again
  /// only when the light has changed. Keeps a reference to the scene.
  void begin(const Scene& scene, const SolvedScene& solved, const Camera& camera,
             const Eigen::Array3f& scale);
  /// Stops the rendering and hides the picture.
  void discard();
  /// Takes over the strips rendered since the last call. True if the picture or the phase changed.
  bool advance();

  StillPhase phase() const { return phase_; }
  /// Share of the rendering that is done, [0,1].
  double progress() const;
  const std::string& failure() const { return failure_; }
  /// Number of rows shown, from the top.
  int rows() const { return rows_; }
  /// The radiance of the complete picture; valid in phase `shown`.
  const Image& image() const { return image_; }
  /// The picture as drawn, 8-bit sRGB, row 0 on top; rows that are not rendered yet are black.
  const std::vector<std::uint8_t>& picture() const { return picture_; }
  const Camera& camera() const { return camera_; }

 private:
  struct Job;
  struct Kept;
  void draw();

  std::shared_ptr<Kept> kept_;  ///< data that pictures of the same light share
  std::unique_ptr<Job> job_;
  std::vector<std::unique_ptr<Job>> ending_{};  ///< cancelled jobs whose threads may still run
  StillPhase phase_ = StillPhase::none;
  std::string failure_;
  Image image_{};
  Camera camera_{};
  std::vector<std::uint8_t> picture_{};
  int rows_ = 0;
  vtkSmartPointer<vtkImageData> data_;
  vtkSmartPointer<vtkActor2D> actor_;
};

}  // namespace lightwell
