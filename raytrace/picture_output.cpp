#include "raytrace/picture_output.h"

#include <fmt/format.h>

#include <stdexcept>

namespace lightwell {

void fail_write(const std::filesystem::path& path, const std::string& why) {
  throw std::runtime_error(fmt::format("{}: cannot be written: {}", path.string(), why));
}

std::string to_text(const ImageAttribute& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{:.9g}", *number);
  const auto& v = std::get<Eigen::Vector3d>(value);
  return fmt::format("{:.9g} {:.9g} {:.9g}", v.x(), v.y(), v.z());
}

}  // namespace lightwell
