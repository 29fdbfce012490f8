#pragma once

#include <span>
#include <vector>

#include "radiosity/solution/cues.h"
#include "radiosity/solution/solution.h"
#include "raytrace/pictures/image.h"
#include "raytrace/render.h"

namespace lightwell {

/// Pictures of moments of fades between states of a solution's channels, from one camera. A picture
/// is linear in the scales of channels, so a moment's is the mean of the pictures of a few states
/// by their shares (Dorsey, Arvo & Greenberg 1995, "Interactive design of complex time-dependent
/// lighting"): a fade of any number of frames takes two or three renderings, and its noise does not
/// flicker.
///
/// Random choices that depend on the brightness of lamps (shadow rays, subdivided pixels) differ
/// between a mean and a picture rendered at the moment, within their noise.
class FadePictures {
 public:
  /// Keeps a reference to the scene. `solved` has channels.
  FadePictures(const Scene& scene, SolvedScene solved, const Camera& camera,
               const RenderOptions& options);

  /// The picture of a moment, without layers. Keeps the pictures of these states for the next call.
  /// Throws as render() does.
  Image at(std::span<const FadeShare> shares);
  /// Number of pictures rendered so far.
  int rendered() const { return rendered_; }

 private:
  struct State {
    std::vector<Spectrum> scales{};
    Image image{};
  };
  const Image& picture(const std::vector<Spectrum>& scales);

  const Scene& scene_;
  SolvedScene solved_;
  Camera camera_;
  RenderOptions options_;
  std::vector<State> kept_{};
  int rendered_ = 0;
};

}  // namespace lightwell
