#include "radiosity/refine/cell_errors.h"

#include <cmath>

namespace lightwell {
namespace {

// The share of their parents' squared error that is expected of children in the report.
constexpr double of_a_split_in_the_end = 0.25;

}  // namespace

CellErrors::CellErrors(const RefinedElements& elements, const SceneParts& parts, bool may_go_on)
    : elements_(elements),
      parts_(parts),
      of_children_(may_go_on ? of_a_split : 1.0),
      in_the_end_(may_go_on ? 1.0 : of_a_split_in_the_end) {
  make_room();
}

void CellErrors::make_room() {
  squares_.resize(elements_.side_total());
  state_.resize(elements_.cell_count(), State::unknown);
}

void CellErrors::expect(int cell, const std::array<double, 2>& of_sides) {
  for (int side = 0; side < elements_.side_count(cell); ++side) {
    squares_[elements_.side_number(cell, side)] = {static_cast<float>(of_sides[side]), 0.0f};
  }
  state_[cell] = State::expected;
}

void CellErrors::set_measured(int cell, const InterpolationError::Measured& squares) {
  for (int side = 0; side < elements_.side_count(cell); ++side) {
    squares_[elements_.side_number(cell, side)] = {static_cast<float>(squares.error[side]),
                                                   static_cast<float>(squares.hidden[side])};
  }
  state_[cell] = State::measured;
}

// A child may be known already: a cell that was merged is split into the same children again.
void CellErrors::expect_of_parents() {
  make_room();
  for (const int cell : elements_.leaves()) {
    if (state_[cell] != State::unknown) continue;
    for (int side = 0; side < elements_.side_count(cell); ++side) {
      const Square& whole = squares_[elements_.side_number(elements_.parent(cell), side)];
      squares_[elements_.side_number(cell, side)] = {
          static_cast<float>(whole.known * of_children_),
          static_cast<float>(whole.hidden * of_children_)};
    }
    state_[cell] = State::expected;
  }
}

double CellErrors::counted(int cell, int part, double allowed) const {
  constexpr double notable = 0.01;
  double known = 0.0, hidden = 0.0;
  for (int side = 0; side < elements_.side_count(cell); ++side) {
    if (part_of(cell, side) != part) continue;
    const Square& square = squares_[elements_.side_number(cell, side)];
    const double importance =
        parts_.importance_of(elements_.base().patch[elements_.element(cell, side)]);
    known += importance * double{square.known};
    hidden += importance * double{square.hidden};
  }
  known *= elements_.area(cell);
  hidden *= elements_.area(cell);
  return hidden > notable * allowed ? known + hidden : known;
}

double CellErrors::share_left(int cell) const {
  return is_measured(cell) || elements_.level(cell) == 0 ? 1.0 : in_the_end_;
}

float CellErrors::relative_error(int cell, int side) const {
  const Square& square = squares_[elements_.side_number(cell, side)];
  const double expected = double{square.known} + 0.5 * double{square.hidden};
  return static_cast<float>(std::sqrt(share_left(cell) * expected));
}

}  // namespace lightwell
