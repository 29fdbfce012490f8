#include "cornell/picture_mask.h"

#include <algorithm>

#include "raytrace/cameras/camera_ray.h"
#include "scene/parallel.h"

namespace lightwell {

double PictureMask::share() const {
  return static_cast<double>(std::count(out.begin(), out.end(), 1)) /
         static_cast<double>(out.size());
}

PictureMask& PictureMask::operator|=(const PictureMask& other) {
  for (std::size_t i = 0; i < out.size(); ++i) out[i] |= other.out[i];
  return *this;
}

PictureMask brighter_than(const Image& image, double radiance) {
  PictureMask mask(image.width, image.height);
  for (std::size_t i = 0; i < mask.out.size(); ++i) {
    mask.out[i] = image.radiance.row(static_cast<Eigen::Index>(i)).maxCoeff() >= radiance ? 1 : 0;
  }
  return mask;
}

PictureMask silhouettes(const Sightlines& sightlines, const Camera& camera) {
  const CameraRays rays(camera);
  const int corners = camera.width + 1;
  std::vector<int> seen(static_cast<std::size_t>(corners) * (camera.height + 1));
  parallel_for(camera.height + 1, 8, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      for (int x = 0; x < corners; ++x) {
        seen[static_cast<std::size_t>(y) * corners + x] = sightlines.surface_ahead(rays.ray(x, y));
      }
    }
  });
  PictureMask mask(camera.width, camera.height);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const int* const top = &seen[static_cast<std::size_t>(y) * corners + x];
      const int* const bottom = top + corners;
      mask.at(x, y) = top[0] != top[1] || top[0] != bottom[0] || top[0] != bottom[1] ? 1 : 0;
    }
  }
  return mask;
}

PictureMask places(const Sightlines& sightlines, const Camera& camera, double least_weight,
                   const std::function<bool(const TracedPoint&)>& is_out) {
  const CameraRays rays(camera);
  PictureMask mask(camera.width, camera.height);
  parallel_for(camera.height, 8, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      for (int x = 0; x < camera.width; ++x) {
        bool out = false;
        for (const auto& [dx, dy] :
             {std::pair{0.25, 0.25}, {0.75, 0.25}, {0.25, 0.75}, {0.75, 0.75}}) {
          sightlines.trace(rays.ray(x + dx, y + dy), least_weight,
                           [&](const TracedPoint& place) { out = out || is_out(place); });
        }
        mask.at(x, y) = out ? 1 : 0;
      }
    }
  });
  return mask;
}

PictureMask grown(const PictureMask& mask, int pixels) {
  PictureMask result(mask.width, mask.height);
  for (int y = 0; y < mask.height; ++y) {
    for (int x = 0; x < mask.width; ++x) {
      if (!mask.at(x, y)) continue;
      for (int v = std::max(0, y - pixels); v <= std::min(mask.height - 1, y + pixels); ++v) {
        for (int u = std::max(0, x - pixels); u <= std::min(mask.width - 1, x + pixels); ++u) {
          result.at(u, v) = 1;
        }
      }
    }
  }
  return result;
}

PictureMask cells(const PictureMask& mask, int size) {
  PictureMask result(mask.width / size, mask.height / size);
  for (int y = 0; y < result.height * size; ++y) {
    for (int x = 0; x < result.width * size; ++x) {
      result.at(x / size, y / size) |= mask.at(x, y);
    }
  }
  return result;
}

Image cell_means(const Image& image, int size) {
  Image means{.width = image.width / size, .height = image.height / size};
  const Eigen::Index bands = image.radiance.cols();
  Eigen::ArrayXXd sum =
      Eigen::ArrayXXd::Zero(static_cast<Eigen::Index>(means.width) * means.height, bands);
  for (int y = 0; y < means.height * size; ++y) {
    for (int x = 0; x < means.width * size; ++x) {
      sum.row(static_cast<Eigen::Index>(y / size) * means.width + x / size) +=
          image.radiance.row(static_cast<Eigen::Index>(y) * image.width + x).cast<double>();
    }
  }
  means.radiance = (sum / (size * size)).cast<float>();
  return means;
}

}  // namespace lightwell
