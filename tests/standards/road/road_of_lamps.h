#pragma once

#include <memory>

#include "standards/road/road.h"

namespace lightwell {

/// A road of 7 m and two lanes on R3, lit from 8 m by luminaires of the same intensity, 1000 cd, in
/// all directions, over the right edge and 40 m apart.
inline Road road_of_even_lamps() {
  auto file = std::make_shared<LuminaireFile>();
  file->web = std::make_shared<const PhotometricWeb>(std::vector<double>{0.0},
                                                     std::vector<double>{0.0, 180.0},
                                                     Eigen::ArrayXXd::Constant(1, 2, 1000.0));
  Road road{.width = 7.0, .lanes = 2, .surface = standard_r_table("R3")};
  road.luminaires = {.file = std::move(file), .spacing = 40.0, .height = 8.0};
  return road;
}

}  // namespace lightwell
