#include "radiosity/solution/light_channel.h"

namespace lightwell {

BandArray side_by_side(const std::vector<LightChannel>& channels,
                       BandArray LightChannel::*quantity) {
  if (channels.empty()) return {};
  const BandArray& first = channels.front().*quantity;
  const Eigen::Index bands = first.cols(), count = static_cast<Eigen::Index>(channels.size());
  BandArray columns(first.rows(), count * bands);
  for (Eigen::Index c = 0; c < count; ++c) {
    columns.middleCols(c * bands, bands) = channels[static_cast<std::size_t>(c)].*quantity;
  }
  return columns;
}

void split_columns(const BandArray& columns, BandArray LightChannel::*quantity,
                   std::vector<LightChannel>& channels) {
  if (columns.size() == 0) return;
  const auto count = static_cast<Eigen::Index>(channels.size());
  const Eigen::Index bands = columns.cols() / count;
  for (Eigen::Index c = 0; c < count; ++c) {
    channels[static_cast<std::size_t>(c)].*quantity = columns.middleCols(c * bands, bands);
  }
}

BandArray channel_sum(BandArray columns, int bands) {
  if (columns.size() == 0 || columns.cols() == bands) return columns;
  BandArray sum = columns.leftCols(bands);
  for (Eigen::Index c = bands; c < columns.cols(); c += bands) sum += columns.middleCols(c, bands);
  return sum;
}

}  // namespace lightwell
