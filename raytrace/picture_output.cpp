#include "raytrace/picture_output.h"

#include <fmt/format.h>

#include <stdexcept>

namespace lightwell {

void fail_write(const std::filesystem::path& path, const std::string& why) {
  throw std::runtime_error(fmt::format("{}: cannot be written: {}", path.string(), why));
}

PictureOutput::PictureOutput(const std::filesystem::path& path)
    : path_(path), file_(path), stream_(file_.temporary(), std::ios::binary | std::ios::trunc) {
  if (!stream_) fail_write(path, "is its folder there, and may you write to it?");
}

void PictureOutput::finish() {
  stream_.close();
  if (!stream_) fail_write(path_, "the disk may be full");
  file_.commit();
}

std::string to_text(const ImageAttribute& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{:.9g}", *number);
  const auto& v = std::get<Eigen::Vector3d>(value);
  return fmt::format("{:.9g} {:.9g} {:.9g}", v.x(), v.y(), v.z());
}

}  // namespace lightwell
