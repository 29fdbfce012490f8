#include "scene/relief.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "scene/errors.h"

namespace lightwell {
namespace {

// Slopes of a picture are limited to 76 degrees: normals at the horizon have no finite slope.
constexpr auto most_slope = static_cast<float>(steepest_relief);

// Returns the component of a normal for a share in [0,1]. Files of eight bits have no middle, and
// programs write 127 or 128 for 0.
float signed_share(float share) {
  constexpr float half_range = 127.0f, middle = 127.5f;
  const float code = 255.0f * share - middle;
  return std::copysign(std::clamp((std::abs(code) - 0.5f) / half_range, 0.0f, 1.0f), code);
}

template <class Slope>
Relief relief_of(const SurfaceTexture& image, Slope&& slope) {
  const int w = image.picture->width(), h = image.picture->height();
  std::vector<Eigen::Array2f> slopes;
  slopes.reserve(std::size_t(w) * std::size_t(h));
  float steepest = 1e-6f;  // of a flat picture
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < w; ++x) {
      slopes.push_back(slope(x, y));
      steepest = std::max(steepest, slopes.back().abs().maxCoeff());
    }
  }
  std::vector<Texture::Code> texels;
  texels.reserve(3 * slopes.size());
  for (const Eigen::Array2f& s : slopes) {
    for (const float part : s) texels.push_back(Texture::encode(0.5f + 0.5f * part / steepest));
    texels.push_back(0);
  }
  Relief relief{.slopes = image, .steepest = static_cast<double>(steepest)};
  relief.slopes.picture = std::make_shared<const Texture>(w, h, 3, std::move(texels));
  return relief;
}

bool is_grey(const Texture& picture) {
  if (picture.channels() == 1) return true;
  constexpr float rounding = 2.5f / 255.0f;  // of JPEG
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      const Eigen::Array3f texel = picture.texel(0, x, y);
      if (texel.maxCoeff() - texel.minCoeff() > rounding) return false;
    }
  }
  return true;
}

bool is_blue_enough(const Texture& picture) {
  constexpr float least = 0.6f;  // normals that lean by 78 degrees in the mean
  return picture.mean()[2] >= least;
}

}  // namespace

bool shows_normals(const Texture& picture) {
  return is_blue_enough(picture) && !is_grey(picture);
}

Relief relief_of_normals(const SurfaceTexture& image, double scale) {
  if (is_grey(*image.picture)) {
    throw InputError(
        "is a grey picture, which has no normals; read it as heights, or give a picture of normals "
        "in red, green and blue");
  }
  if (!is_blue_enough(*image.picture)) {
    throw InputError(
        "is no picture of normals, which is mostly blue; give one, or read the picture as heights");
  }
  Relief relief = relief_of(image, [&](int x, int y) -> Eigen::Array2f {
    const Eigen::Array3f n = image.picture->texel(0, x, y).unaryExpr(&signed_share);
    constexpr float least = 1e-3f;
    const float out = std::max(n[2], least);
    const Eigen::Array2f slope = Eigen::Array2f(-n[0], n[1]) / out;
    return slope.max(-most_slope).min(most_slope);
  });
  relief.scale = scale;
  return relief;
}

Relief relief_of_heights(const SurfaceTexture& image, double depth, DepthUnit unit) {
  const Texture& picture = *image.picture;
  const auto neighbour = [&](int i, int size, TextureWrap wrap) {
    return wrap == TextureWrap::repeat ? (i + size) % size : std::clamp(i, 0, size - 1);
  };
  const auto height = [&](int x, int y) {
    return picture
        .texel(0, neighbour(x, picture.width(), image.wrap[0]),
               neighbour(y, picture.height(), image.wrap[1]))
        .mean();
  };
  Relief relief = relief_of(image, [&](int x, int y) -> Eigen::Array2f {
    return 0.5f *
           Eigen::Array2f(height(x + 1, y) - height(x - 1, y), height(x, y + 1) - height(x, y - 1));
  });
  relief.scale = depth;
  relief.is_in_metres = unit == DepthUnit::metre;
  return relief;
}

double ReliefSlope::gain(const Eigen::Vector3d& direction) const {
  const double height = direction.dot(normal);
  if (!(height > 0.0)) return 1.0;  // such light gives the surface nothing
  return std::clamp(1.0 - direction.dot(rise) / height, 0.0, 2.0);
}

}  // namespace lightwell
