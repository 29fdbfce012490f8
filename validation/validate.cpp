#include "validation/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <exception>
#include <utility>

#include "scene/errors.h"
#include "scene/io/nearest_name.h"
#include "validation/cases/case_lists.h"
#include "validation/cases/reference_data.h"

namespace lightwell {
namespace {

std::string in_lower_case(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

// True if the pieces between the asterisks of `pattern` stand in `text` one behind the other.
bool contains_pieces(std::string_view text, std::string_view pattern) {
  std::size_t from = 0;
  while (!pattern.empty()) {
    const std::size_t end = std::min(pattern.find('*'), pattern.size());
    const std::string_view piece = pattern.substr(0, end);
    const std::size_t found = text.find(piece, from);
    if (found == std::string_view::npos) return false;
    from = found + piece.size();
    pattern.remove_prefix(std::min(end + 1, pattern.size()));
  }
  return true;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

CaseResult run_case(ValidationCase about, const Progress& progress) {
  CaseResult result{.about = std::move(about)};
  const auto start = std::chrono::steady_clock::now();
  try {
    result.values = result.about.compute(progress);
    const bool passes = !result.values.empty() &&
                        std::all_of(result.values.begin(), result.values.end(),
                                    [](const ComparedValue& value) { return value.passes(); });
    result.verdict = passes ? Verdict::passed : Verdict::failed;
    if (result.values.empty()) result.failure = "the case computed nothing";
  } catch (const Interrupted&) {
    result.verdict = Verdict::stopped;
  } catch (const NoFolder&) {
    throw;
  } catch (const std::exception& error) {
    result.verdict = Verdict::failed;
    result.failure = error.what();
  }
  result.seconds = seconds_since(start);
  return result;
}

}  // namespace

std::vector<ValidationCase> validation_cases() {
  std::vector<ValidationCase> cases;
  for (const auto& list : {form_factor_cases, enclosure_cases, optics_cases, shadow_cases,
                           photometry_cases, glare_cases, ugr_table_cases, sky_cases,
                           cie171_electric_cases, cie171_daylight_cases, cornell_cases}) {
    std::vector<ValidationCase> more = list();
    std::move(more.begin(), more.end(), std::back_inserter(cases));
  }
  return cases;
}

std::vector<ValidationCase> select_cases(std::vector<ValidationCase> cases,
                                         std::string_view pattern) {
  const std::string wanted = in_lower_case(pattern);
  std::vector<std::string> known;
  for (const ValidationCase& one : cases) {
    known.push_back(one.id);
    if (std::find(known.begin(), known.end(), one.group) == known.end()) known.push_back(one.group);
  }
  std::erase_if(cases, [&wanted](const ValidationCase& one) {
    return !contains_pieces(in_lower_case(one.id), wanted) &&
           !contains_pieces(in_lower_case(one.group), wanted);
  });
  if (cases.empty()) {
    throw InputError(fmt::format("no case or group of cases contains '{}'.{} --list names all",
                                 pattern, did_you_mean(std::string(pattern), known)));
  }
  return cases;
}

const ComparedValue* CaseResult::worst() const {
  const auto at = std::max_element(
      values.begin(), values.end(),
      [](const ComparedValue& a, const ComparedValue& b) { return a.share() < b.share(); });
  return at == values.end() ? nullptr : &*at;
}

int ValidationRun::count(Verdict verdict) const {
  return static_cast<int>(
      std::count_if(results.begin(), results.end(),
                    [verdict](const CaseResult& one) { return one.verdict == verdict; }));
}

const CaseResult* ValidationRun::closest() const {
  const CaseResult* closest = nullptr;
  for (const CaseResult& one : results) {
    if (one.worst() == nullptr) continue;
    if (closest == nullptr || one.worst()->share() > closest->worst()->share()) closest = &one;
  }
  return closest;
}

ValidationRun run_validation(std::vector<ValidationCase> cases, const Progress& progress,
                             const std::function<void(const CaseResult&)>& done) {
  ValidationRun run;
  const auto start = std::chrono::steady_clock::now();
  bool is_stopped = false;
  const auto count = static_cast<double>(cases.size());
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const double share = static_cast<double>(i) / count;
    // Phases within a case are of no interest, but each asks whether to stop.
    const Progress within = [&progress, share](std::string_view, double) {
      return !progress || progress("cases", share);
    };
    if (!is_stopped) is_stopped = !within("cases", share);
    CaseResult result{.about = cases[i]};
    if (!cases[i].can_run()) {
      result.verdict = Verdict::not_run;
    } else if (!is_stopped) {
      result = run_case(std::move(cases[i]), within);
      is_stopped = result.verdict == Verdict::stopped;
    }
    if (done && result.verdict != Verdict::stopped) done(result);
    run.results.push_back(std::move(result));
  }
  if (progress && !is_stopped) progress("cases", 1.0);
  run.seconds = seconds_since(start);
  return run;
}

std::string verdict_line(const ValidationRun& run) {
  const int passed = run.count(Verdict::passed), failed = run.count(Verdict::failed);
  std::string line =
      fmt::format("{} of {} cases pass in {:.0f} s", passed, passed + failed, run.seconds);
  if (const int stopped = run.count(Verdict::stopped); stopped > 0) {
    line += fmt::format("; {} were not reached", stopped);
  }
  if (const int not_run = run.count(Verdict::not_run); not_run > 0) {
    line += fmt::format("; {} cannot be run, for the reason given", not_run);
  }
  if (const CaseResult* const closest = run.closest()) {
    const ComparedValue& worst = *closest->worst();
    line += fmt::format("; the largest error is {:.2f} of its tolerance ({}{}{})", worst.share(),
                        closest->about.id, worst.place.empty() ? "" : ", ", worst.place);
  }
  return line + ".";
}

}  // namespace lightwell
