#include "raytrace/fade_pictures.h"

#include <algorithm>
#include <utility>

#include "radiosity/solution/relight.h"
#include "raytrace/scene_renderer.h"

namespace lightwell {
namespace {

bool is_same(const std::vector<Spectrum>& a, const std::vector<Spectrum>& b) {
  return std::ranges::equal(a, b,
                            [](const Spectrum& x, const Spectrum& y) { return (x == y).all(); });
}

}  // namespace

FadePictures::FadePictures(const Scene& scene, SolvedScene solved, const Camera& camera,
                           const RenderOptions& options)
    : scene_(scene), solved_(std::move(solved)), camera_(camera), options_(options) {
  options_.layers.clear();
  options_.has_records = false;
}

const Image& FadePictures::picture(const std::vector<Spectrum>& scales) {
  for (const State& state : kept_) {
    if (is_same(state.scales, scales)) return state.image;
  }
  relight(solved_, scales);
  SceneRenderer renderer(scene_, solved_.mesh, solved_.solution);
  ++rendered_;
  return kept_.emplace_back(State{scales, renderer.render(camera_, options_)}).image;
}

Image FadePictures::at(std::span<const FadeShare> shares) {
  std::erase_if(kept_, [&](const State& state) {
    return std::ranges::none_of(
        shares, [&](const FadeShare& each) { return is_same(each.scales, state.scales); });
  });
  Image result;
  for (const FadeShare& each : shares) {
    const Image& state = picture(each.scales);
    if (result.radiance.size() == 0) {
      result = {state.width, state.height,
                BandArray::Zero(state.radiance.rows(), state.radiance.cols())};
    }
    result.radiance += static_cast<float>(each.share) * state.radiance;
  }
  return result;
}

}  // namespace lightwell
