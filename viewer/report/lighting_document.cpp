#include "viewer/report/lighting_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "viewer/report/lighting_tables.h"
#include "viewer/report/plan_svg.h"
#include "viewer/report/standard_tables.h"

namespace lightwell {
namespace {

void add_fact(DocumentFacts& facts, const char* name, MarkedText text) {
  if (!text.empty()) facts.facts.push_back({name, std::move(text)});
}

void add_table(DocumentSection& section, DocumentTable table) {
  if (!table.rows.empty()) section.blocks.emplace_back(std::move(table));
}

DocumentFacts heading_facts(const LightingReport& report, Language language) {
  const ReportHeading& heading = report.heading;
  DocumentFacts facts;
  for (const auto& [word, text] :
       {std::pair(Word::project, &heading.project), std::pair(Word::client, &heading.client),
        std::pair(Word::author, &heading.author), std::pair(Word::date, &heading.date),
        std::pair(Word::remarks, &heading.remarks)}) {
    add_fact(facts, word_in(language, word), marked(*text));
  }
  add_fact(facts, word_in(language, Word::computed_with),
           "Lightwell " + marked(report.provenance.version));
  return facts;
}

std::optional<DocumentPicture> heading_picture(const LightingReport& report, Language language) {
  if (!report.picture) return {};
  const ReportPicture& picture = *report.picture;
  return DocumentPicture{
      .caption = worded(language, Word::view,
                        {marked(picture.camera), light_words(report.content, language)}),
      .width = picture.width,
      .height = picture.height,
      .png = picture.png};
}

// The name of the sky; names that the readers of scenes give are in the language of the report.
MarkedText sky_name(const LightingReport& report, Language language) {
  for (const Word word : {Word::sky, Word::sky_overcast, Word::sky_clear, Word::sky_uniform}) {
    if (report.sky == word_in(Language::english, word)) return word_in(language, word);
  }
  return marked(report.sky);
}

MarkedText content_text(const LightingReport& report, Language language) {
  const MarkedText sky = sky_name(report, language);
  switch (report.content) {
    case LightContent::electric:
      return word_in(language, Word::content_electric);
    case LightContent::daylight:
      return worded(language, Word::content_daylight, {sky});
    case LightContent::apart:
      return worded(language, Word::content_apart, {sky});
    case LightContent::together:
      break;
  }
  return worded(language, Word::content_together, {sky});
}

MarkedText factor_text(const LightingReport& report, Language language) {
  if (report.content == LightContent::daylight) return {};
  const std::string factor = number_in(language, fmt::format("{:g}", report.maintenance_factor));
  MarkedText text = worded(language, Word::maintained, {factor});
  if (report.maintenance_factor == 1.0) {
    text += fmt::format(" {}", word_in(language, Word::new_lamps));
  }
  return text;
}

DocumentSection results_section(const LightingReport& report, Language language) {
  DocumentSection section{word_in(language, Word::results)};
  if (!report.surfaces.empty()) {
    MarkedText text = content_text(report, language);
    for (const MarkedText& more :
         {factor_text(report, language), MarkedText(word_in(language, Word::illuminance_means))}) {
      if (!more.empty()) text += " " + more;
    }
    section.blocks.emplace_back(DocumentParagraph{std::move(text)});
  }
  add_table(section, illuminance_table(report, language));
  add_table(section, rating_table(report, language));
  add_table(section, power_table(report, language));
  if (MarkedText energy = energy_text(report, language); !energy.empty()) {
    section.blocks.emplace_back(DocumentParagraph{std::move(energy)});
  }
  return section;
}

DocumentSection limits_section(const LightingReport& report, Language language) {
  DocumentSection section{word_in(language, Word::limits_of_standards)};
  section.blocks.emplace_back(DocumentParagraph{word_in(language, Word::limits_mean)});
  for (DocumentTable& table : requirement_tables(report.requirements, language)) {
    add_table(section, std::move(table));
  }
  return section;
}

// Data of a photometric file, with its curve.
DocumentCard luminaire_card(const LuminaireRow& row, Language language) {
  const LuminaireFile& file = *row.file;
  const auto rounded = [](double value) { return fmt::format("{:.0f}", value); };
  DocumentCard card{.svg = file.is_radiometric ? std::string() : polar_svg(file, language),
                    .title = marked(file.name.empty() ? row.name : file.name)};
  if (!file.maker.empty()) card.lines.push_back(marked(file.maker));
  card.lines.push_back(worded(
      language, Word::count_of,
      {fmt::format("{}", row.count), marked(row.name), marked(file.file.filename().string())}));
  if (!file.is_radiometric) {
    MarkedText flux = worded(language, Word::flux_of_table, {rounded(file.flux())});
    if (file.lamp_lumens > 0.0) {
      flux += worded(language, Word::flux_of_lamps, {rounded(file.lamp_lumens)});
    }
    card.lines.push_back(flux +
                         worded(language, Word::flux_in_scene, {rounded(row.flux / row.count)}));
  }
  if (row.watts > 0.0) {
    card.lines.push_back(
        worded(language, Word::watts_each,
               {number_in(language, fmt::format("{:.1f}", row.watts / row.count))}));
  }
  const LampOpening& opening = file.opening;
  if (!opening.is_point()) {
    card.lines.push_back(
        worded(language, Word::opening,
               {rounded(1000.0 * opening.along_c0), rounded(1000.0 * opening.along_c90)}) +
        (opening.is_round ? word_in(language, Word::round_opening) : ""));
  }
  if (!card.svg.empty()) {
    card.lines.push_back(fmt::format("<small>{}</small>", word_in(language, Word::curve)));
  }
  return card;
}

DocumentSection luminaire_section(const LightingReport& report, Language language) {
  DocumentSection section{word_in(language, Word::luminaires)};
  if (report.luminaires.empty()) {
    section.blocks.emplace_back(DocumentParagraph{word_in(language, Word::no_luminaires)});
    return section;
  }
  add_table(section, luminaire_table(report, language));
  for (const LuminaireRow& row : report.luminaires) {
    if (row.file) section.blocks.emplace_back(luminaire_card(row, language));
  }
  return section;
}

MarkedText grid_text(const CalculationSurface& surface, Language language) {
  const LuxGrid& grid = surface.grid;
  const auto in_form = [&](double value) {
    return number_in(language, fmt::format("{:g}", value));
  };
  const auto two_digits = [&](double value) {
    return number_in(language, fmt::format("{:.2f}", value));
  };
  MarkedText text;
  if (grid.options.height > 0.0) {
    text += worded(language, Word::height_above, {in_form(grid.options.height)}) + " ";
  }
  if (grid.options.margin > 0.0) {
    text += worded(language, Word::without_margin, {in_form(grid.options.margin)}) + " ";
  }
  text += worded(language, Word::grid_size,
                 {two_digits(grid.columns * grid.step_u), two_digits(grid.rows * grid.step_v),
                  two_digits(grid.step_u), two_digits(grid.step_v)}) +
          " ";
  return text +
         worded(language,
                grid.options.height > 0.0 ? Word::cut_above_surface_below : Word::cut_above_surface,
                {two_digits(surface.lines.cut_height + grid.options.height)});
}

void add_plans(const LightingReport& report, const std::optional<LuxRange>& range,
               Language language, Document& document) {
  int number = 0;
  for (const CalculationSurface& surface : report.surfaces) {
    // Grids of limits are in tables; nobody asked for their plans.
    if (surface.grid.is_of_area) continue;
    DocumentSection section{.title = marked(surface.grid.name)};
    section.blocks.emplace_back(DocumentParagraph{grid_text(surface, language)});
    for (const auto& [name, field] : fields_of(report, surface, language)) {
      const bool is_sum = report.content == LightContent::apart && &field == &surface.field;
      if (is_sum) continue;
      section.blocks.emplace_back(DocumentDrawing{
          .caption = worded(language, Word::plan_caption,
                            {name, lux_text(field.mean, language), lux_text(field.least, language),
                             lux_text(field.greatest, language),
                             number_in(language, fmt::format("{:.2f}", field.uniformity))}),
          .svg = plan_svg({.surface = surface,
                           .field = field,
                           .range = range.value_or(plan_range(field)),
                           .number = ++number,
                           .north = north_in(report.north, surface.grid),
                           .metres_per_unit = report.metres_per_unit,
                           .unit_name = report.unit_name,
                           .language = language})});
    }
    document.sections.push_back(std::move(section));
  }
}

std::set<std::string> left_out_lamps(const LightingReport& report) {
  if (report.observers.empty()) return {};
  const std::vector<std::string>& lamps = report.observers.front().glare.left_out;
  return {lamps.begin(), lamps.end()};
}

DocumentSection glare_section(const LightingReport& report, Language language) {
  DocumentSection section{word_in(language, Word::glare)};
  const std::string light =
      report.content == LightContent::together ? word_in(language, Word::glare_daylight_behind)
      : report.content == LightContent::apart  ? word_in(language, Word::glare_without_daylight)
                                               : "";
  section.blocks.emplace_back(DocumentParagraph{worded(language, Word::glare_means, {light})});
  add_table(section, observer_table(report, language));
  for (const Observer& observer : report.observers) {
    add_table(section, source_table(observer, language));
  }
  DocumentTable eyes = eye_table(report, language);
  eyes.title = word_in(language, Word::light_at_the_eye);
  add_table(section, std::move(eyes));
  return section;
}

DocumentSection assumptions_section(const LightingReport& report, Language language) {
  DocumentList list;
  list.items.push_back(content_text(report, language));
  if (report.content != LightContent::daylight) {
    list.items.push_back(
        worded(language, Word::maintenance_is,
               {number_in(language, fmt::format("{:g}", report.maintenance_factor))}));
  }
  if (!report.surfaces.empty()) {
    list.items.push_back(worded(language, Word::sampling, {fmt::format("{}", report.rays)}));
    list.items.emplace_back(word_in(language, Word::spacing));
    list.items.emplace_back(word_in(language, Word::buried_points));
  }
  if (report.error_estimate > 0.0) {
    list.items.push_back(
        worded(language, Word::solution_error, {percent_text(report.error_estimate, language)}));
  }
  if (!report.observers.empty())
    list.items.emplace_back(word_in(language, Word::glare_of_new_lamps));
  for (const std::string& lamp : left_out_lamps(report)) {
    list.items.push_back(worded(language, Word::left_out, {marked(lamp)}));
  }
  return {.title = word_in(language, Word::assumptions), .blocks = {std::move(list)}};
}

DocumentSection basis_section(const LightingReport& report, Language language) {
  const Provenance& made = report.provenance;
  DocumentFacts facts;
  const auto add = [&](Word word, MarkedText text) {
    add_fact(facts, word_in(language, word), std::move(text));
  };
  add(Word::program, "Lightwell " + marked(made.version));
  add(Word::scene_file, marked(std::filesystem::path(made.scene_file).filename().string()));
  add(Word::scene_hash, fmt::format("{:016x}", made.scene_hash));
  add(Word::options, marked(made.options));
  add(Word::refinement, marked(made.refinement));
  std::string places;
  for (const std::string& place : made.looked_from) {
    places += (places.empty() ? "" : ", ") + place;
  }
  add(Word::seen_from, marked(places));
  add(Word::error_estimate, report.error_estimate > 0.0
                                ? percent_text(report.error_estimate, language)
                                : word_in(language, Word::error_unknown));
  add(Word::rays, fmt::format("{}", report.rays));
  return {
      .title = word_in(language, Word::basis), .blocks = {std::move(facts)}, .begins_page = false};
}

}  // namespace

const LuxField* electric_field(const LightingReport& report, const CalculationSurface& surface) {
  if (report.content == LightContent::apart) return &*surface.electric;
  return report.content == LightContent::electric ? &surface.field : nullptr;
}

std::optional<PowerDensity> power_density(const LightingReport& report,
                                          const CalculationSurface& surface) {
  double watts = 0.0;
  for (const LuminaireRow& row : report.luminaires) {
    if (!(row.watts > 0.0)) return {};
    watts += row.watts;
  }
  const bool is_working_plane =
      surface.grid.options.height > 0.0 && !surface.grid.is_of_area && !surface.grid.options.part &&
      surface.grid.options.outline.empty() && surface.grid.quantity == GridQuantity::planar;
  if (!(is_working_plane && watts > 0.0)) return {};
  PowerDensity density{.watts_per_area = watts / surface.grid.area};
  const LuxField* const electric = electric_field(report, surface);
  if (electric && electric->mean > 0.0) {
    density.per_hundred_lux = density.watts_per_area / (electric->mean / 100.0);
  }
  return density;
}

Document lighting_document(const LightingReport& report, const std::optional<LuxRange>& range,
                           Language language) {
  Document document{
      .language = code_of(language),
      .decimal_sign = decimal_sign(language),
      .title = report.title,
      .author = report.heading.author,
      .footer = report.heading.project.empty() ? report.title : report.heading.project,
      .head = heading_facts(report, language),
      .picture = heading_picture(report, language)};
  document.sections.push_back(results_section(report, language));
  if (!report.requirements.empty()) {
    document.sections.push_back(limits_section(report, language));
  }
  document.sections.push_back(luminaire_section(report, language));
  add_plans(report, range, language, document);
  if (!report.observers.empty()) document.sections.push_back(glare_section(report, language));
  document.sections.push_back(assumptions_section(report, language));
  document.sections.push_back(basis_section(report, language));
  return document;
}

}  // namespace lightwell
