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

/// The second pass's picture of a view, rendered beside the window in a thread of its own and faded
/// in over it when it is there.
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
  /// solution what it needs; keeps a reference to the scene.
  void begin(const Scene& scene, const SolvedScene& solved, const Camera& camera, double scale);
  /// Stops, and shows nothing.
  void discard();
  /// `seconds` went by. `under` is what the window shows, 8-bit RGB from the bottom up, for the
  /// fade to begin with; asked for once. True if there is something new to draw.
  template <class Under>
  bool advance(double seconds, Under&& under) {
    if (!arrived()) return fade(seconds);
    show_over(under());
    return true;
  }

  StillPhase phase() const { return phase_; }
  double progress() const;
  const std::string& failure() const { return failure_; }
  /// What is shown.
  const Image& image() const { return image_; }
  const Camera& camera() const { return camera_; }
  const std::vector<std::uint8_t>& picture() const { return picture_; }

 private:
  struct Job;
  bool arrived();
  bool fade(double seconds);
  void show_over(std::vector<std::uint8_t> under);
  void draw(double share);

  std::unique_ptr<Job> job_;
  std::vector<std::unique_ptr<Job>> ending_{};  ///< told to stop; nobody waits for them
  StillPhase phase_ = StillPhase::none;
  std::string failure_;
  Image image_{};
  Camera camera_{};
  std::vector<std::uint8_t> picture_{}, under_{};  ///< row 0 on top; at the bottom
  double shown_seconds_ = 0.0;
  vtkSmartPointer<vtkImageData> data_;
  vtkSmartPointer<vtkActor2D> actor_;
};

}  // namespace lightwell
