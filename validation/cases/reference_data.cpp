#include "validation/cases/reference_data.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <fstream>
#include <stdexcept>
#include <string>
#include <system_error>

namespace lightwell {

ReferenceValue reference_cases(std::string_view json) {
  return ReferenceValue::parse(json);
}

Eigen::Vector3d reference_point(const ReferenceValue& value) {
  return {value.at(0).get<double>(), value.at(1).get<double>(), value.at(2).get<double>()};
}

std::vector<Eigen::Vector3d> reference_polygon(const ReferenceValue& value) {
  std::vector<Eigen::Vector3d> points;
  for (const ReferenceValue& point : value) points.push_back(reference_point(point));
  return points;
}

EmbeddedFile::EmbeddedFile(std::string_view name, std::string_view text) {
  std::error_code failure;
  const std::filesystem::path parent = std::filesystem::temp_directory_path(failure);
  if (failure) {
    throw NoFolder(
        "there is no folder for the files of the cases; set TMPDIR to a folder that can be "
        "written");
  }
  std::string made = (parent / "lightwell-validate-XXXXXX").string();
  if (mkdtemp(made.data()) == nullptr) {
    throw NoFolder(fmt::format(
        "{}: no folder can be made here for the files of the cases; set TMPDIR to a folder that "
        "can be written",
        parent.string()));
  }
  folder_ = made;
  file_ = folder_ / std::filesystem::path(name);
  std::ofstream out(file_, std::ios::binary);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();
  if (!out) {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
    throw NoFolder(fmt::format("{}: could not be written; is the disk full?", file_.string()));
  }
}

EmbeddedFile::~EmbeddedFile() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

}  // namespace lightwell
