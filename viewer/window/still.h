#pragma once

#include <vtkSmartPointer.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "radiosity/solve.h"
#include "raytrace/image.h"

class vtkActor2D;
class vtkImageData;
class vtkRenderer;

namespace lightwell {

enum class StillPhase { none, rendering, shown, failed };

/// The second pass's picture of a view, rendered beside the window in a thread of its own. It
/// covers the window from the top down, strip by strip as they are done.
class Still {
 public:
  Still();
  /// Ends the rendering within a second.
  ~Still();
  Still(const Still&) = delete;
  Still& operator=(const Still&) = delete;

  /// Before the text, which is drawn over it.
  void add_to(vtkRenderer* renderer) const;
  /// Begins to render what the camera sees, as large as it says, exposed by `scale`. Copies of the
  /// solution what it needs, once for as long as its light is the same; keeps a reference to the
  /// scene.
  void begin(const Scene& scene, const SolvedScene& solved, const Camera& camera, double scale);
  /// Stops, and shows nothing.
  void discard();
  /// Takes over what has been rendered since. True if there is something new to draw.
  bool advance();

  StillPhase phase() const { return phase_; }
  double progress() const;
  const std::string& failure() const { return failure_; }
  /// Rows from the top that are shown.
  int rows() const { return rows_; }
  /// What is shown; once all of it is there.
  const Image& image() const { return image_; }
  /// The same as it is drawn, 8-bit sRGB, row 0 on top; black where nothing is shown yet.
  const std::vector<std::uint8_t>& picture() const { return picture_; }
  const Camera& camera() const { return camera_; }

 private:
  struct Job;
  struct Kept;
  void draw();

  std::shared_ptr<Kept> kept_;  ///< what pictures of the same light share
  std::unique_ptr<Job> job_;
  std::vector<std::unique_ptr<Job>> ending_{};  ///< told to stop; nobody waits for them
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
