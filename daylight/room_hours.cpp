#include "daylight/room_hours.h"

namespace lightwell {

RoomHours::RoomHours(const SensorRange& room, const CountedLux& lux)
    : room_(room), lux_(lux), point_hours_(Eigen::ArrayXi::Zero(room.count)) {}

void RoomHours::add(const HourBlock& block, std::span<const float> factors) {
  for (std::size_t h = 0; h < block.hours.size(); ++h) {
    const float factor = factors.empty() ? 1.0f : factors[h];
    double sum = 0.0;
    for (Eigen::Index i = 0; i < room_.count; ++i) {
      const double E = block.light(room_.first + i, static_cast<Eigen::Index>(h), factor);
      sum += E;
      point_hours_[i] += E >= lux_.point;
    }
    mean_hours_ += sum >= lux_.mean * static_cast<double>(room_.count);
  }
}

}  // namespace lightwell
