#include "viewer/export/pack_rectangles.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <tuple>

namespace lightwell {
namespace {

/// Occupied part of a square: everything above a line of level steps, with y downwards.
class Skyline {
 public:
  explicit Skyline(int size) : size_(size), steps_{{0, 0, size}} {}

  struct Fit {
    std::size_t step = 0;
    int x = 0, y = 0;
  };

  std::optional<Fit> find(int width, int height) const {
    std::optional<Fit> best;
    for (std::size_t i = 0; i < steps_.size() && steps_[i].x + width <= size_; ++i) {
      int y = 0;
      int left = width;
      for (std::size_t j = i; left > 0; left -= steps_[j].width, ++j) y = std::max(y, steps_[j].y);
      if (y + height > size_ || (best && best->y <= y)) continue;
      best = Fit{i, steps_[i].x, y};
    }
    return best;
  }

  void place(const Fit& at, int width, int height) {
    const int end = at.x + width;
    std::vector<Step> added = {{at.x, at.y + height, width}};
    std::size_t last = at.step;
    for (; last < steps_.size() && steps_[last].x < end; ++last) {
      const int over = steps_[last].x + steps_[last].width - end;
      if (over > 0) added.push_back({end, steps_[last].y, over});
    }
    const auto begin = steps_.begin() + static_cast<std::ptrdiff_t>(at.step);
    const auto next = steps_.erase(begin, steps_.begin() + static_cast<std::ptrdiff_t>(last));
    steps_.insert(next, added.begin(), added.end());
    join();
  }

 private:
  struct Step {
    int x = 0, y = 0, width = 0;
  };
  void join() {
    std::size_t kept = 0;
    for (std::size_t i = 1; i < steps_.size(); ++i) {
      if (steps_[i].y == steps_[kept].y) {
        steps_[kept].width += steps_[i].width;
      } else {
        steps_[++kept] = steps_[i];
      }
    }
    steps_.resize(kept + 1);
  }

  int size_;
  std::vector<Step> steps_;
};

}  // namespace

std::optional<std::vector<PackedPosition>> pack_rectangles(std::span<const Eigen::Vector2i> sizes,
                                                           int square_size, int most_squares) {
  const std::int64_t square = std::int64_t{square_size} * square_size;
  std::int64_t area = 0;
  for (const Eigen::Vector2i& s : sizes) {
    if (s.maxCoeff() > square_size) return std::nullopt;
    area += std::int64_t{s.x()} * s.y();
  }
  if (area > square * most_squares) return std::nullopt;

  std::vector<int> order(sizes.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return std::tuple(-sizes[a].y(), -sizes[a].x(), a) <
           std::tuple(-sizes[b].y(), -sizes[b].x(), b);
  });
  std::vector<Skyline> squares;
  std::vector<PackedPosition> places(sizes.size());
  for (const int i : order) {
    std::optional<Skyline::Fit> fit;
    std::size_t s = 0;
    for (; s < squares.size() && !fit; ++s) fit = squares[s].find(sizes[i].x(), sizes[i].y());
    if (!fit) {
      if (static_cast<int>(squares.size()) == most_squares) return std::nullopt;
      squares.emplace_back(square_size);
      fit = squares.back().find(sizes[i].x(), sizes[i].y());
      s = squares.size();
    }
    squares[s - 1].place(*fit, sizes[i].x(), sizes[i].y());
    places[i] = {static_cast<int>(s) - 1, fit->x, fit->y};
  }
  return places;
}

}  // namespace lightwell
