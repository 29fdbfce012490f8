#include "standards/work_place.h"

#include <numbers>
#include <utility>

namespace lightwell {
namespace {

constexpr double uniformity_of_surround = 0.40;
constexpr double uniformity_of_background = 0.10;  // also of walls, ceilings and cylinders

class Requirements {
 public:
  explicit Requirements(const std::string& area) : area_(area) {}

  void add(Requirement requirement) {
    requirement.area = area_;
    all_.push_back(std::move(requirement));
  }
  void add_field(const GridField& of, double mean, double uniformity) {
    if (!of.field || !(mean > 0.0)) return;
    add(mean_at_least(mean, of));
    if (uniformity > 0.0) add(uniformity_at_least(uniformity, of));
  }
  std::vector<Requirement> take() { return std::move(all_); }

 private:
  std::string area_;
  std::vector<Requirement> all_{};
};

// Advises a modelling index between both limits, if there is light.
void add_modelling(const WorkPlace& place, Requirements& requirements) {
  constexpr double low = 0.30, high = 0.60;
  if (!place.cylindrical.field || !place.horizontal.field) return;
  const LuxField& side = *place.cylindrical.field;
  const LuxField& top = *place.horizontal.field;
  if (!(top.mean > 0.0)) return;
  Requirement index{.place = place.cylindrical.name,
                    .figure = Figure::modelling,
                    .is_recommended = true,
                    .limit = low,
                    .value = side.mean / top.mean};
  index.within = *index.value * (side.mean_within + top.mean_within);
  requirements.add(index);
  index.is_upper = true;
  index.limit = high;
  requirements.add(index);
}

Requirement glare_at_most(double limit, const NamedGlare& of) {
  constexpr double per_relative = 8.0 / std::numbers::ln10;
  return {.place = of.name,
          .figure = Figure::glare,
          .is_upper = true,
          .limit = limit,
          .value = of.glare->ugr,
          .within = per_relative * of.background_within};
}

}  // namespace

double surround_mean(double task_mean) {
  constexpr double of_750 = 500.0, of_500 = 300.0, of_300 = 200.0, of_200 = 150.0;
  if (task_mean >= 750.0) return of_750;
  if (task_mean >= 500.0) return of_500;
  if (task_mean >= 300.0) return of_300;
  return task_mean >= 200.0 ? of_200 : task_mean;
}

std::vector<Requirement> work_place_requirements(const WorkPlace& place, const Activity& activity,
                                                 bool is_raised) {
  Requirements requirements(place.name);
  const double mean = is_raised ? activity.raised_mean : activity.mean;
  requirements.add_field(place.task, mean, activity.uniformity);
  requirements.add_field(place.surround, surround_mean(mean), uniformity_of_surround);
  requirements.add_field(place.background, surround_mean(mean) / 3.0, uniformity_of_background);
  for (const GridField& wall : place.walls) {
    requirements.add_field(wall, activity.walls, uniformity_of_background);
  }
  for (const GridField& ceiling : place.ceilings) {
    requirements.add_field(ceiling, activity.ceiling, uniformity_of_background);
  }
  if (place.cylindrical.field && activity.cylindrical > 0.0) {
    Requirement round = mean_at_least(activity.cylindrical, place.cylindrical);
    round.figure = Figure::cylindrical;
    requirements.add(round);
    requirements.add(uniformity_at_least(uniformity_of_background, place.cylindrical));
  }
  add_modelling(place, requirements);
  if (activity.glare > 0.0) {
    for (const NamedGlare& observer : place.observers) {
      requirements.add(glare_at_most(activity.glare, observer));
    }
  }
  std::vector<Requirement> all = requirements.take();
  add_colour_rendering(activity.colour_rendering, place.luminaires, place.name, all);
  return all;
}

}  // namespace lightwell
