#include "viewer/report/year_ratings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "scene/io/comma_fields.h"
#include "viewer/export/page_data.h"
#include "viewer/report/year_rooms.h"

namespace lightwell {
namespace {

using Json = nlohmann::ordered_json;

// Words for a figure.
struct FigureWords {
  const char* key;   // in JSON and CSV
  const char* mark;  // on pages
  const char* unit;
  int digits;
};

// Names in the order of DaylightFigure.
constexpr std::array figure_words = {
    FigureWords{"sDA300_50", "sDA<sub>300/50%</sub>", "%", 1},
    FigureWords{"ASE1000_250", "ASE<sub>1000,250h</sub>", "%", 1},
    FigureWords{"mean_daylight_factor", "daylight factor, mean", "%", 2},
    FigureWords{"daylight_factor_uniformity", "uniformity", "", 2},
    FigureWords{"least_daylight_factor", "or darkest point", "%", 2},
    FigureWords{"by_daylight_factors", "by daylight factors", "", 0},
    FigureWords{"hours_of_mean", "mean of {} lx", "h", 0},
    FigureWords{"hours_of_points", "each point {} lx", "h", 0},
    FigureWords{"by_hours", "by hours", "", 0},
    FigureWords{"complying_area", "area that complies", "%", 1}};
static_assert(figure_words.size() == static_cast<std::size_t>(DaylightFigure::complying_area) + 1,
              "each figure has words");

const FigureWords& words_of(DaylightFigure figure) {
  return figure_words[static_cast<std::size_t>(figure)];
}

// True for figures that are met or not, without a number.
bool is_route(DaylightFigure figure) {
  return figure == DaylightFigure::factor_route || figure == DaylightFigure::hours_route;
}

std::string figure_mark(const DaylightRating& rating, DaylightFigure figure) {
  const char* mark = words_of(figure).mark;
  if (figure == DaylightFigure::mean_hours) return fmt::format(fmt::runtime(mark), rating.mean.lux);
  if (figure == DaylightFigure::point_hours) {
    return fmt::format(fmt::runtime(mark), rating.point.lux);
  }
  return mark;
}

std::string number_text(double value, const FigureWords& words) {
  return fmt::format("{:.{}f}{}{}", value, words.digits, *words.unit ? "\u202f" : "", words.unit);
}

std::string bounded_text(const BoundedFigure& figure, int digits) {
  return fmt::format("{:.{}f} to {:.{}f}", figure.least, digits, figure.most, digits);
}

// "1 point", "2 points"
std::string count_text(int points, std::string word) {
  if (points == 1 && word.ends_with('s')) word.pop_back();
  return fmt::format("{} {}", points, word);
}

std::string points_text(const DaylightRating& rating, const RatingPoints& points) {
  const std::string available = "of " + count_text(points.available, rating.points);
  return points.least == points.most ? fmt::format("{} {}", points.least, available)
                                     : fmt::format("{} to {} {}, {}", points.least, points.most,
                                                   available, verdict_name(Verdict::too_close));
}

void add_figure(const DaylightRating& rating, const RatedFigure& figure, bool is_first,
                std::string& page) {
  const FigureWords& words = words_of(figure.figure);
  std::string value = "–", limit = "–";
  if (!is_route(figure.figure)) {
    value = number_text(figure.value.value, words);
    if (figure.figure != DaylightFigure::sun_exposure) {
      value += " <small>" + bounded_text(figure.value, words.digits) + "</small>";
    }
    limit = fmt::format("{} {:g}{}{}", figure.is_upper ? "≤" : "≥", figure.limit,
                        *words.unit ? "\u202f" : "", words.unit);
  }
  if (figure.points > 0) {
    limit += fmt::format(" <small>{}{}</small>", figure.room.empty() ? "" : "each room +",
                         html_text(count_text(figure.points, rating.points)));
  }
  const char* name = verdict_name(verdict_of(figure));
  fmt::format_to(std::back_inserter(page),
                 "<tr{}><td>{}</td><td class=\"text\">{}</td><td>{}</td><td class=\"text\">{}</td>"
                 "<td class=\"text\">{}{}</td></tr>\n",
                 figure.room.empty() || is_route(figure.figure) ? " class=\"total\"" : "",
                 is_first ? (figure.room.empty() ? "all rooms" : html_text(figure.room)) : "",
                 figure_mark(rating, figure.figure), value, limit, name,
                 figure.is_recommended ? " (recommended)" : "");
}

void add_rating(const YearReport& report, const RatedYear& rated, std::string& page) {
  const auto out = std::back_inserter(page);
  const DaylightRating& rating = rated.rating;
  fmt::format_to(
      out,
      "<section><h2>{}: {}</h2>\n<table><tr><th>Room</th><th class=\"text\">Figure</th>"
      "<th>Value</th><th class=\"text\">Limit</th><th class=\"text\">Verdict</th></tr>\n",
      html_text(rating.title), html_text(points_text(rating, rated.daylight.points)));
  const std::string* room = nullptr;
  for (const RatedFigure& figure : rated.daylight.figures) {
    add_figure(rating, figure, !room || *room != figure.room, page);
    room = &figure.room;
  }
  page += "</table>\n<p>";
  for (const std::string& note : rating.notes) page += html_text(note) + " ";
  page +=
      has_areas(report) ? "Rooms count by their floor area. " : "Rooms count by their sensors. ";
  if (!rating.source.empty()) page += "Numbers: " + html_text(rating.source) + ". ";
  page += "A limit is met or missed where both ends of the bound agree.</p></section>\n";
}

bool has_lighting(const YearReport& report) {
  return std::ranges::any_of(report.rooms,
                             [](const YearRoom& room) { return room.lighting.has_value(); });
}

void add_lighting(const YearRoom& room, std::string& page) {
  const RoomLighting& lighting = *room.lighting;
  const LampEnergy energy = lamp_energy(room);
  const auto cell = [](const BoundedFigure& figure, double scale, const char* unit, int digits) {
    const BoundedFigure scaled{
        .value = scale * figure.value, .least = scale * figure.least, .most = scale * figure.most};
    return fmt::format("{:.{}f}{} <small>{}</small>", scaled.value, digits, unit,
                       bounded_text(scaled, digits));
  };
  const std::string none = "–";
  fmt::format_to(std::back_inserter(page),
                 "<tr><td>{}</td><td class=\"text\">{:g}\u202flx, {}</td><td>{}</td><td>{}</td>"
                 "<td>{}</td><td>{}</td></tr>\n",
                 html_text(room.name), lighting.lux, control_text(lighting),
                 cell(room.lamps.daylight_dependency, 1.0, "", 3),
                 cell(energy.saved_share, 100.0, "\u202f%", 1),
                 lighting.watts ? cell(energy.indicator, 1.0, "", 2) : none,
                 lighting.watts ? cell(energy.saved, 1.0, "", 2) : none);
}

void add_all_lighting(const YearReport& report, std::string& page) {
  page +=
      "<section><h2>Energy of lamps</h2>\n<table><tr><th>Room</th><th class=\"text\">Lamps</th>"
      "<th>F<sub>D</sub></th><th>Daylight saves</th><th>LENI, kWh/m²</th><th>Saved, kWh/m²</th>"
      "</tr>\n";
  LampHours hours;  // are those of any room
  for (const YearRoom& room : report.rooms) {
    if (!room.lighting) continue;
    add_lighting(room, page);
    hours = room.lamps;
  }
  fmt::format_to(
      std::back_inserter(page),
      "</table>\n<p>EN 15193-1 with the daylight of each occupied hour: F<sub>D</sub> is the "
      "energy "
      "of the lamps in the t<sub>D</sub> = {}\u202fh with light outside over that at full power, "
      "which they take in the other t<sub>N</sub> = {}\u202fh. LENI and what daylight saves of it "
      "are for a year, with F<sub>O</sub> = F<sub>C</sub> = 1 and no power outside of the occupied "
      "hours.</p></section>\n",
      hours.daylight_hours, hours.night_hours);
}

Json bounded_json(const BoundedFigure& figure) {
  return {{"value", figure.value}, {"least", figure.least}, {"most", figure.most}};
}

}  // namespace

std::string rating_sections(const YearReport& report) {
  std::string page;
  for (const RatedYear& rated : rate_year(report)) add_rating(report, rated, page);
  if (has_lighting(report)) add_all_lighting(report, page);
  return page;
}

nlohmann::ordered_json ratings_json(const YearReport& report) {
  Json ratings = Json::array();
  for (const RatedYear& rated : rate_year(report)) {
    const RatingPoints& points = rated.daylight.points;
    Json json{{"key", rated.rating.key},
              {"title", rated.rating.title},
              {"source", rated.rating.source},
              {"points",
               {{"value", points.value},
                {"least", points.least},
                {"most", points.most},
                {"available", points.available}}},
              {"weights", has_areas(report) ? "area" : "sensors"},
              {"limits", Json::array()}};
    for (const RatedFigure& figure : rated.daylight.figures) {
      Json limit{{"room", figure.room.empty() ? Json() : Json(figure.room)},
                 {"figure", words_of(figure.figure).key}};
      if (!is_route(figure.figure)) {
        limit.update(bounded_json(figure.value));
        limit[figure.is_upper ? "at_most" : "at_least"] = figure.limit;
      }
      if (figure.points > 0) limit["points"] = figure.points;
      limit["recommended"] = figure.is_recommended;
      limit["verdict"] = verdict_name(verdict_of(figure));
      json["limits"].push_back(std::move(limit));
    }
    ratings.push_back(std::move(json));
  }
  return ratings;
}

nlohmann::ordered_json lighting_json(const YearRoom& room) {
  const LampEnergy energy = lamp_energy(room);
  Json json{{"control", control_text(*room.lighting)},
            {"maintained_lux", room.lighting->lux},
            {"daylight_hours", room.lamps.daylight_hours},
            {"night_hours", room.lamps.night_hours},
            {"daylight_dependency", bounded_json(room.lamps.daylight_dependency)},
            {"saved_share", bounded_json(energy.saved_share)}};
  if (room.lighting->watts) {
    json["watts"] = *room.lighting->watts;
    json["area_m2"] = room.area;
    json["LENI_kWh_per_m2"] = bounded_json(energy.indicator);
    json["saved_kWh_per_m2"] = bounded_json(energy.saved);
  }
  return json;
}

std::string ratings_text(const YearReport& report) {
  std::string text;
  const auto out = std::back_inserter(text);
  for (const RatedYear& rated : rate_year(report)) {
    fmt::format_to(out, "{}: {}\n", rated.rating.title,
                   points_text(rated.rating, rated.daylight.points));
    for (const RatedFigure& figure : rated.daylight.figures) {
      const Verdict verdict = verdict_of(figure);
      if (verdict == Verdict::met) continue;
      const FigureWords& words = words_of(figure.figure);
      fmt::format_to(out, "  {}: {}", figure.room.empty() ? "all rooms" : figure.room, words.key);
      if (!is_route(figure.figure)) {
        fmt::format_to(out, " {:.{}f} ({}) {}, at {} {:g}", figure.value.value, words.digits,
                       bounded_text(figure.value, words.digits), words.unit,
                       figure.is_upper ? "most" : "least", figure.limit);
      }
      fmt::format_to(out, ": {}{}\n", verdict_name(verdict),
                     figure.is_recommended ? " (recommended)" : "");
    }
  }
  for (const YearRoom& room : report.rooms) {
    if (!room.lighting) continue;
    const LampEnergy energy = lamp_energy(room);
    const BoundedFigure& F_D = room.lamps.daylight_dependency;
    fmt::format_to(out, "lamps {}: F_D {:.3f} ({}), daylight saves {:.1f} %", room.name, F_D.value,
                   bounded_text(F_D, 3), 100.0 * energy.saved_share.value);
    if (room.lighting->watts) {
      fmt::format_to(out, " and {:.2f} kWh/m2 ({}); LENI {:.2f} kWh/m2", energy.saved.value,
                     bounded_text(energy.saved, 2), energy.indicator.value);
    }
    text += "\n";
  }
  return text;
}

std::string rooms_csv(const YearReport& report) {
  std::string csv = "rating,room,figure,value,least,most,limit,verdict,recommended\n";
  const auto add = [&](const std::string& rating, const std::string& room, const char* figure,
                       const BoundedFigure& value) {
    fmt::format_to(std::back_inserter(csv), "{},{},{},{:.6g},{:.6g},{:.6g}", quoted_field(rating),
                   quoted_field(room), figure, value.value, value.least, value.most);
  };
  for (const RatedYear& rated : rate_year(report)) {
    for (const RatedFigure& figure : rated.daylight.figures) {
      add(rated.rating.title, figure.room.empty() ? "all rooms" : figure.room,
          words_of(figure.figure).key, figure.value);
      fmt::format_to(std::back_inserter(csv), ",{:g},{},{}\n", figure.limit,
                     verdict_name(verdict_of(figure)), figure.is_recommended ? "yes" : "no");
    }
  }
  for (const YearRoom& room : report.rooms) {
    if (!room.lighting) continue;
    const LampEnergy energy = lamp_energy(room);
    const auto add_energy = [&](const char* figure, const BoundedFigure& value) {
      add("EN 15193-1", room.name, figure, value);
      csv += ",,,\n";
    };
    add_energy("daylight_dependency", room.lamps.daylight_dependency);
    add_energy("saved_share", energy.saved_share);
    if (!room.lighting->watts) continue;
    add_energy("LENI_kWh_per_m2", energy.indicator);
    add_energy("saved_kWh_per_m2", energy.saved);
  }
  return csv;
}

}  // namespace lightwell
