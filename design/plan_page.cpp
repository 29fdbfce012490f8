#include <fmt/format.h>

#include <iterator>

#include "design/plan_files.h"
#include "design/plan_words.h"
#include "viewer/document/page_frame.h"
#include "viewer/export/page_data.h"
#include "viewer/report/plan_svg.h"

namespace lightwell {
namespace {

// "E_m" with its index below the line.
std::string quantity_html(LimitKind kind) {
  const std::string name = quantity_name(kind);
  const std::size_t at = name.find('_');
  if (at == std::string::npos) return name;
  return name.substr(0, at) + "<sub>" + name.substr(at + 1) + "</sub>";
}

void add_limits(const LightingPlan& plan, std::string& page) {
  const auto out = std::back_inserter(page);
  page +=
      "<h2>Limits</h2>\n<table><tr><th>Grid or observer</th><th></th><th>Limit</th>"
      "<th>Reached</th><th>Verdict</th><th>A stricter limit costs</th></tr>\n";
  for (const LimitOutcome& outcome : plan.limits) {
    const WordedLimit& limit = outcome.limit;
    fmt::format_to(out,
                   "<tr><td>{}</td><td class=\"text\">{}</td><td>{} {}</td><td>{} "
                   "<small>± {:.2g}</small></td><td class=\"text\">{}</td><td>{}</td></tr>\n",
                   html_text(limit.place), quantity_html(limit.kind),
                   is_lower_limit(limit.kind) ? "≥" : "≤", value_text(limit.kind, limit.value),
                   value_text(limit.kind, outcome.reached), outcome.within,
                   verdict_name(outcome.verdict), cost_of_step(plan, outcome));
  }
  page += "</table>\n";
}

void add_levels(const LightingPlan& plan, std::string& page) {
  const auto out = std::back_inserter(page);
  page +=
      "<h2>Levels</h2>\n<table><tr><th>Luminaire</th><th>Level</th><th>Power</th>"
      "<th>at full level</th></tr>\n";
  for (const Luminaire& luminaire : plan.luminaires) {
    const double level = level_of(plan, luminaire);
    fmt::format_to(out, "<tr><td>{}</td><td>{:.1f} %</td>", html_text(luminaire.name),
                   100.0 * level);
    if (luminaire.watts > 0.0) {
      fmt::format_to(out, "<td>{:.1f} W</td><td>{:.4g} W</td></tr>\n", level * luminaire.watts,
                     luminaire.watts);
    } else {
      page += "<td></td><td></td></tr>\n";
    }
  }
  page += "</table>\n";
}

void add_places(const LightingPlan& plan, const Scene& scene, std::string& page) {
  if (!plan.earlier) return;
  const auto out = std::back_inserter(page);
  fmt::format_to(out,
                 "<h2>Places</h2>\n<table><tr><th>Luminaire</th><th>before, {0}</th><th>now, {0}"
                 "</th></tr>\n",
                 html_text(scene.unit_name));
  for (std::size_t i = 0; i < plan.luminaires.size(); ++i) {
    const Luminaire& luminaire = plan.luminaires[i];
    fmt::format_to(out, "<tr><td>{}</td><td>{}</td><td>{}</td></tr>\n", html_text(luminaire.name),
                   place_text(plan.earlier->positions[i], scene.metres_per_unit),
                   place_text(luminaire.position, scene.metres_per_unit));
  }
  page += "</table>\n";
}

// The surface with the level of each luminaire as the label of the nearest in its plan.
CalculationSurface labelled(const LightingPlan& plan, CalculationSurface surface) {
  constexpr double same_place = 0.01;  // m; a plan shows the middle of a luminaire's outline
  const LuxGrid& grid = surface.grid;
  for (const Luminaire& luminaire : plan.luminaires) {
    const Eigen::Vector3d from_corner = luminaire.position - grid.corner;
    const Eigen::Vector2d flat(grid.u.dot(from_corner), grid.v.dot(from_corner));
    PlanLuminaire* nearest = nullptr;
    double least = same_place;
    for (PlanLuminaire& drawn : surface.lines.luminaires) {
      const double distance = (drawn.middle - flat).norm();
      if (!(distance <= least) || !drawn.label.empty()) continue;
      least = distance;
      nearest = &drawn;
    }
    if (nearest) nearest->label = fmt::format("{:.0f} %", 100.0 * level_of(plan, luminaire));
  }
  return surface;
}

void add_plans(const LightingPlan& plan, const Scene& scene, std::string& page) {
  const auto out = std::back_inserter(page);
  int number = 0;
  for (const CalculationSurface& given : plan.surfaces) {
    const CalculationSurface surface = labelled(plan, given);
    std::optional<Eigen::Vector3d> north;
    if (scene.sky) north = scene.sky->north;
    fmt::format_to(out,
                   "<section class=\"surface\"><h2>{}</h2>\n<figure><figcaption><b>Maintained "
                   "illuminance</b>, lx, and levels of the luminaires</figcaption>\n{}</figure>"
                   "</section>\n",
                   html_text(surface.grid.name),
                   plan_svg({.surface = surface,
                             .field = surface.field,
                             .range = plan_range(surface.field),
                             .number = ++number,
                             .north = north_in(north, surface.grid),
                             .metres_per_unit = scene.metres_per_unit,
                             .unit_name = scene.unit_name}));
  }
}

}  // namespace

std::string plan_page(const LightingPlan& plan, const Scene& scene) {
  const std::string title = scene.title.empty() ? scene.file.filename().string() : scene.title;
  std::string page = page_begin(title);
  page += fmt::format(
      "<h1>{}</h1>\n<p>{} of least {} within limits. Maintenance factor {:g}; "
      "bounds with odds of 19 to 1.</p>\n",
      html_text(title), plan.earlier ? "Levels and places" : "Levels",
      plan.is_in_watts ? "electric power" : "luminous flux", plan.maintenance_factor);
  page += list_section("Power", power_sentences(plan));
  page += list_section("Limits that are not met", unmet_sentences(plan));
  add_limits(plan, page);
  add_levels(plan, page);
  add_places(plan, scene, page);
  add_plans(plan, scene, page);
  page += list_section("Notes", plan.notes);
  return page + page_end;
}

}  // namespace lightwell
