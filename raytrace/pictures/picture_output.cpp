#include "raytrace/pictures/picture_output.h"

#include <fmt/format.h>

#include <stdexcept>

namespace lightwell {

void fail_write(const std::filesystem::path& path, const std::string& why) {
  throw std::runtime_error(fmt::format("{}: cannot be written: {}", path.string(), why));
}

void check_writable(const Image& image, const Bands& bands, const std::filesystem::path& path) {
  const std::int64_t pixels = std::int64_t{image.width} * image.height;
  if (image.width <= 0 || image.height <= 0 || pixels > max_image_pixels ||
      image.radiance.rows() != pixels) {
    fail_write(path,
               fmt::format("{} x {} pixels with {} values is not a picture of 1 to {} pixels",
                           image.width, image.height, image.radiance.rows(), max_image_pixels));
  }
  if (image.radiance.cols() != bands.count()) {
    fail_write(path, fmt::format("the image has {} bands, its description {}",
                                 image.radiance.cols(), bands.count()));
  }
}

std::string to_text(const ImageAttribute& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{:.9g}", *number);
  const auto& v = std::get<Eigen::Vector3d>(value);
  return fmt::format("{:.9g} {:.9g} {:.9g}", v.x(), v.y(), v.z());
}

}  // namespace lightwell
