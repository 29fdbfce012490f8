#include "validation/page/validation_page.h"

#include <fmt/format.h>

#include <array>
#include <string>

#include "scene/parallel.h"
#include "validation/page/validation_plots.h"
#include "validation/page/validation_text.h"
#include "viewer/document/page_frame.h"
#include "viewer/export/page_data.h"
#include "viewer/export/write_whole.h"

namespace lightwell {
namespace {

constexpr const char* page_style =
    "<style>.verdict{font-size:1.15rem;font-weight:600}.failed{color:#d2380b;font-weight:600}"
    ".cases td,.cases th{padding-right:.7rem;font-size:.82rem}.cases .text{max-width:20rem}"
    "@media screen and (min-width:60rem){body{max-width:62rem}.cases "
    "td:nth-child(2){min-width:17rem}}"
    ".sources td{font-size:.8rem;color:#444;text-align:left}code{font-size:.95em}</style>\n";

std::string verdict_cell(const CaseResult& one) {
  const std::string_view word = verdict_word(one.verdict);
  return one.verdict == Verdict::failed ? fmt::format("<td class='text failed'>{}</td>", word)
                                        : fmt::format("<td class='text'>{}</td>", word);
}

std::string page_row(const CaseResult& one) {
  const ComparedValue* const worst = one.worst();
  std::string what = html_text(one.about.title);
  if (worst && !worst->place.empty()) {
    what += fmt::format(" <small>{}</small>", html_text(worst->place));
  }
  if (!one.failure.empty()) what += fmt::format("<br><b>{}</b>", html_text(one.failure));
  std::string row = fmt::format("<tr><td><code>{}</code></td><td class='text'>{}</td>",
                                html_text(one.about.id), what);
  if (worst) {
    const std::string unit =
        one.about.unit.empty() ? "" : " <small>" + html_text(one.about.unit) + "</small>";
    row += fmt::format("<td>{}</td><td>{}{}</td><td>{}</td><td>{:.1e}</td><td>{:.1e}</td>",
                       one.values.size(), shown_number(worst->expected), unit,
                       shown_number(worst->computed), worst->error(), worst->tolerance);
  } else {
    row += "<td></td><td></td><td></td><td></td><td></td>";
  }
  return row + verdict_cell(one) + fmt::format("<td>{:.2f}</td></tr>\n", one.seconds);
}

std::string sources_of(const CaseResult& one) {
  const auto part = [](const char* name, const std::string& text) {
    return text.empty() ? "" : fmt::format("<b>{}</b> {}. ", name, html_text(text));
  };
  std::string published;
  for (const PublishedValue& value : one.about.published) {
    published +=
        fmt::format("{}{}{} {} ({}{})", published.empty() ? "" : "; ", html_text(value.place),
                    value.place.empty() ? "" : ":", shown_number(value.value),
                    html_text(value.program + ", " + value.source),
                    value.mistake.empty() ? "" : "; wrong: " + html_text(value.mistake));
  }
  if (!published.empty()) published = "<b>Published</b> " + published + ".";
  return fmt::format("<tr><td><code>{}</code></td><td>{}{}{}{}</td></tr>\n",
                     html_text(one.about.id), part("Expected", one.about.source),
                     part("Tolerance", one.about.reason), part("Note", one.about.note), published);
}

std::string group_part(const ValidationRun& run, const std::string& group) {
  std::string rows, plots, sources;
  for (const CaseResult& one : run.results) {
    if (one.about.group != group) continue;
    rows += page_row(one);
    sources += sources_of(one);
    const std::string plot = one.about.has_plot ? values_plot(one) : "";
    if (plot.empty()) continue;
    plots += fmt::format(
        "<figure>{}<figcaption><code>{}</code>: {}{}. Lines: expected; dots: computed. Below: "
        "errors in units of the tolerance.</figcaption></figure>\n",
        plot, html_text(one.about.id), html_text(one.about.title),
        one.about.unit.empty() ? "" : ", " + html_text(one.about.unit));
  }
  return fmt::format(
      "<h2>{}</h2>\n<table class='cases'><thead><tr><th>case</th><th class='text'>what, and the "
      "place with the largest error</th><th>values</th><th>expected</th><th>computed</th>"
      "<th>error</th><th>tolerance</th><th class='text'></th><th>s</th></tr></thead><tbody>\n"
      "{}</tbody></table>\n{}<h3>Sources and tolerances</h3>\n<table class='sources'><tbody>\n"
      "{}</tbody></table>\n",
      html_text(group), rows, plots, sources);
}

}  // namespace

std::string validation_html(const ValidationRun& run, std::string_view version) {
  std::string page = page_begin("Validation of Lightwell");
  page += page_style;
  page += fmt::format("<h1>Validation of Lightwell {}</h1>\n<p class='verdict{}'>{}</p>\n",
                      html_text(version), run.has_failed() ? " failed" : "",
                      html_text(verdict_line(run)));
  page += fmt::format(
      "<p>Each case has an answer that is known: a closed form, a stored number of another method, "
      "or the figures of other programs. A case may have many values; the tables show the value "
      "with the largest error over its tolerance. Computed on {} threads.</p>\n",
      thread_count());
  page += fmt::format(
      "<figure>{}<figcaption>Largest error over tolerance of every case; red line: the tolerance. "
      "Errors below a millionth of it stand at the left.</figcaption></figure>\n",
      share_plot(run));
  std::string last;
  for (const CaseResult& one : run.results) {
    if (one.about.group == last) continue;
    last = one.about.group;
    page += group_part(run, last);
  }
  return page + page_end;
}

void write_validation(const std::filesystem::path& file, std::string_view text) {
  write_whole(file, {text});
}

}  // namespace lightwell
