#include "validation/page/validation_text.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace lightwell {
namespace {

using Json = nlohmann::ordered_json;

// JSON has no infinity.
Json finite_number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json published_json(const ValidationCase& about) {
  Json published = Json::array();
  for (const PublishedValue& one : about.published) {
    Json entry = {{"place", one.place},
                  {"program", one.program},
                  {"value", one.value},
                  {"source", one.source}};
    if (!one.mistake.empty()) entry["mistake"] = one.mistake;
    published.push_back(std::move(entry));
  }
  return published;
}

Json case_json(const CaseResult& result) {
  const ValidationCase& about = result.about;
  const ComparedValue* const worst = result.worst();
  Json json = {{"id", about.id}, {"group", about.group}, {"title", about.title}};
  json["unit"] = about.unit;
  json["place"] = worst ? worst->place : "";
  json["expected"] = worst ? finite_number(worst->expected) : Json(nullptr);
  json["computed"] = worst ? finite_number(worst->computed) : Json(nullptr);
  json["error"] = worst ? finite_number(worst->error()) : Json(nullptr);
  json["tolerance"] = worst ? finite_number(worst->tolerance) : Json(nullptr);
  const bool is_decided = result.verdict == Verdict::passed || result.verdict == Verdict::failed;
  json["pass"] = is_decided ? Json(result.verdict == Verdict::passed) : Json(nullptr);
  json["verdict"] = verdict_word(result.verdict);
  json["values"] = result.values.size();
  json["seconds"] = result.seconds;
  json["source"] = about.source;
  json["reason"] = about.reason;
  if (!about.note.empty()) json["note"] = about.note;
  if (!result.failure.empty()) json["failure"] = result.failure;
  if (!about.published.empty()) json["published"] = published_json(about);
  return json;
}

// Text for a cell of a table.
std::string cell_text(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) {
    text.insert(at, 1, '\\');
  }
  return text;
}

std::string with_unit(const std::string& number, const std::string& unit) {
  return unit.empty() ? number : number + " " + unit;
}

std::string markdown_row(const CaseResult& result) {
  const ValidationCase& about = result.about;
  const ComparedValue* const worst = result.worst();
  if (worst == nullptr) {
    return fmt::format("| `{}` | {} | | | | {} |\n", about.id, cell_text(about.title),
                       verdict_word(result.verdict));
  }
  const std::string at =
      worst->place.empty()
          ? ""
          : fmt::format(
                " ({}{})", worst->place,
                result.values.size() > 1 ? fmt::format("; {} values", result.values.size()) : "");
  return fmt::format("| `{}` | {}{} | {} | {} | {:.1e} of {:.1e} | {} |\n", about.id,
                     cell_text(about.title), cell_text(at),
                     with_unit(shown_number(worst->expected), about.unit),
                     with_unit(shown_number(worst->computed), about.unit), worst->error(),
                     worst->tolerance, verdict_word(result.verdict));
}

// Sentences that several cases share stand once, with the names of the cases.
std::string shared_sentences(const ValidationRun& run, const std::string& group,
                             std::string ValidationCase::*member) {
  std::vector<std::pair<std::string, std::string>> sentences;
  for (const CaseResult& one : run.results) {
    const std::string& sentence = one.about.*member;
    if (one.about.group != group || sentence.empty()) continue;
    const std::string name = "`" + one.about.id + "`";
    auto found = sentences.begin();
    while (found != sentences.end() && found->first != sentence) ++found;
    if (found == sentences.end()) {
      sentences.emplace_back(sentence, name);
    } else {
      found->second += ", " + name;
    }
  }
  std::string text;
  for (const auto& [sentence, names] : sentences) {
    text += fmt::format("| {} | {} |\n", cell_text(sentence), names);
  }
  return text;
}

std::string group_section(const ValidationRun& run, const std::string& group) {
  std::string text = fmt::format(
      "\n## {}\n\n| case | what (place with the largest error) | expected | computed | error, and "
      "its tolerance | |\n|---|---|---|---|---|---|\n",
      group);
  for (const CaseResult& one : run.results) {
    if (one.about.group == group) text += markdown_row(one);
  }
  text += "\n| tolerance | cases |\n|---|---|\n" +
          shared_sentences(run, group, &ValidationCase::reason);
  text += "\n| source of the expected values | cases |\n|---|---|\n" +
          shared_sentences(run, group, &ValidationCase::source);
  const std::string notes = shared_sentences(run, group, &ValidationCase::note);
  if (!notes.empty()) text += "\n| note | cases |\n|---|---|\n" + notes;
  return text;
}

const ComparedValue* value_at(const CaseResult& result, const std::string& place) {
  for (const ComparedValue& value : result.values) {
    if (value.place == place) return &value;
  }
  return nullptr;
}

std::string published_section(const ValidationRun& run) {
  std::string figures, mistakes;
  for (const CaseResult& one : run.results) {
    for (const PublishedValue& published : one.about.published) {
      const ComparedValue* const value = value_at(one, published.place);
      if (value) {
        figures += fmt::format("| `{}` | {} | {} | {} | {}: {} | {} |\n", one.about.id,
                               published.place.empty() ? "value" : cell_text(published.place),
                               shown_number(value->expected), shown_number(value->computed),
                               published.program, shown_number(published.value), published.source);
      }
      if (published.mistake.empty()) continue;
      mistakes += fmt::format("| `{}` | {}: {} | {} |\n", one.about.id, published.program,
                              shown_number(published.value), published.mistake);
    }
  }
  std::string text;
  if (!figures.empty()) {
    text +=
        "\n## Figures of other programs\n\n| case | place | expected | Lightwell | published | "
        "source |\n|---|---|---|---|---|---|\n" +
        figures;
  }
  if (!mistakes.empty()) {
    text +=
        "\n## Mistakes in published tables\n\n| case | published | why it is wrong |\n"
        "|---|---|---|\n" +
        mistakes;
  }
  return text;
}

}  // namespace

std::string_view verdict_word(Verdict verdict) {
  switch (verdict) {
    case Verdict::passed:
      return "pass";
    case Verdict::failed:
      return "FAIL";
    case Verdict::not_run:
      return "not run";
    case Verdict::stopped:
      return "stopped";
  }
  return "";
}

std::string shown_number(double value) {
  return fmt::format("{:.6g}", value);
}

std::string table_head() {
  return fmt::format("{:<30} {:>12} {:>12} {:>9} {:>9}  {:<7} {:>6}\n", "case", "expected",
                     "computed", "error", "tolerance", "", "s");
}

std::string table_line(const CaseResult& result) {
  const ComparedValue* const worst = result.worst();
  if (worst == nullptr) {
    return fmt::format("{:<30} {:>12} {:>12} {:>9} {:>9}  {:<7} {:>6}  {}\n", result.about.id, "-",
                       "-", "-", "-", verdict_word(result.verdict), "-",
                       result.failure.empty() ? result.about.note : result.failure);
  }
  return fmt::format("{:<30} {:>12} {:>12} {:>9.1e} {:>9.1e}  {:<7} {:>6.2f}\n", result.about.id,
                     shown_number(worst->expected), shown_number(worst->computed), worst->error(),
                     worst->tolerance, verdict_word(result.verdict), result.seconds);
}

std::string validation_json(const ValidationRun& run) {
  Json cases = Json::array();
  for (const CaseResult& one : run.results) cases.push_back(case_json(one));
  const Json json = {{"cases", std::move(cases)},
                     {"passed", run.count(Verdict::passed)},
                     {"failed", run.count(Verdict::failed)},
                     {"not_run", run.count(Verdict::not_run)},
                     {"stopped", run.count(Verdict::stopped)},
                     {"seconds", run.seconds}};
  return json.dump(2) + "\n";
}

std::string validation_markdown(const ValidationRun& run) {
  std::string text =
      "# Validation\n\n"
      "After this page you know how far Lightwell is from known answers: closed forms, stored "
      "numbers "
      "of other methods, and figures of other programs. `lightwell validate` repeats all of it on "
      "your own machine in about a minute, from an installation alone; `--html FILE` writes a page "
      "with plots, and `--only PATTERN` runs some of the cases. The exit code is 4 if a case "
      "fails.\n\n"
      "A case may have many values. The tables show the value with the largest error over its "
      "tolerance; the reason of each tolerance stands below the table of its group.\n\n"
      "`lightwell validate --markdown docs/validation.md` makes this page.\n\n";
  const int decided = run.count(Verdict::passed) + run.count(Verdict::failed);
  text += fmt::format("**{} of {} cases pass.**\n", run.count(Verdict::passed), decided);
  std::vector<std::string> groups;
  for (const CaseResult& one : run.results) {
    if (groups.empty() || groups.back() != one.about.group) groups.push_back(one.about.group);
  }
  for (const std::string& group : groups) text += group_section(run, group);
  return text + published_section(run);
}

}  // namespace lightwell
