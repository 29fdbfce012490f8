#include "cli/report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "cli/channels.h"
#include "mesh/patches/translucency.h"
#include "scene/parallel.h"
#include "viewer/export/write_whole.h"

namespace lightwell {
namespace {

// Mean illuminance of each part over the area that reflects, lx; without a known unit the mean
// irradiance of the bands, relative.
std::vector<double> mean_irradiances(const PatchMesh& mesh, const RadiositySolution& solution) {
  const BandArray E = element_mean(mesh, solution.irradiance());
  std::vector<double> sum(solution.parts.parts.size(), 0.0), area(sum);
  for (int e = 0; e < mesh.element_count() && !sum.empty(); ++e) {
    const int patch = mesh.patch[e], part = solution.parts.of_patch[patch];
    if (part < 0 || !scatters(mesh, patch)) continue;
    const Spectrum here = E.row(e).transpose();
    const double value =
        solution.relative_units ? double{here.mean()} : double{luminous(solution.bands, here)};
    sum[part] += mesh.element_area[e] * value;
    area[part] += mesh.element_area[e];
  }
  for (std::size_t p = 0; p < sum.size(); ++p) sum[p] = area[p] > 0.0 ? sum[p] / area[p] : 0.0;
  return sum;
}

double peak_memory_mb() {
  return static_cast<double>(resident_memory().most) / (1 << 20);
}

std::string megabytes_text(double megabytes) {
  constexpr double large = 1000.0;
  return megabytes < large ? fmt::format("{:.0f} MB", megabytes)
                           : fmt::format("{:.1f} GB", megabytes / 1024.0);
}

// Megabytes of form-factor rows in memory and on disk, with the reason.
std::string storage_text(const Json& storage) {
  const auto size = [&](const char* key) { return megabytes_text(storage[key].get<double>()); };
  const bool is_on_disk = storage["disk_mb"].get<double>() > 0.0;
  if (!is_on_disk && !(storage["memory_mb"].get<double>() > 0.0)) {
    return fmt::format("no rows are stored, since patches shoot without them (budget {})",
                       size("budget_mb"));
  }
  if (!is_on_disk) {
    return fmt::format("rows {} in memory (budget {}), which holds them all", size("memory_mb"),
                       size("budget_mb"));
  }
  return fmt::format("rows {} in memory, {} on disk in {}, since no more fit (budget {})",
                     size("memory_mb"), size("disk_mb"), storage["folder"].get<std::string>(),
                     size("budget_mb"));
}

// Emitted power and scale of each channel: "desk 3.2 W (scale 0.3), sun 40 W".
std::string channel_text(const Json& channels) {
  std::vector<std::string> parts;
  for (const Json& channel : channels) {
    const auto scale = channel["scale"].get<std::vector<double>>();
    const bool is_even = std::ranges::all_of(scale, [&](double s) { return s == scale[0]; });
    const bool is_in_watts = channel.contains("watts_radiated");
    std::string part = fmt::format("{} {:.4g}{}", channel["name"].get<std::string>(),
                                   channel[is_in_watts ? "watts_radiated" : "power"].get<double>(),
                                   is_in_watts ? " W" : "");
    if (!is_even) part += fmt::format(" (scale {:.3g})", fmt::join(scale, " "));
    if (is_even && scale[0] != 1.0) part += fmt::format(" (scale {:.3g})", scale[0]);
    parts.push_back(std::move(part));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string line(const char* head, const std::string& body) {
  return fmt::format("{:<9} {}\n", head, body);
}

// Energy balance, and the share of lamps without surface. Empty where a report's figures of the
// same name, the energy of a year, stand in place of the balance.
std::string energy_text(const Json& facts) {
  const Json& energy = facts["energy"];
  if (!energy.contains("emitted")) return {};
  const double emitted = energy["emitted"];
  const auto percent = [&](const char* key) {
    const double share = emitted > 0.0 ? 100.0 * energy[key].get<double>() / emitted : 0.0;
    constexpr double printed_as_zero = 5e-5;
    return std::abs(share) < printed_as_zero ? 0.0 : share;  // prevents "-0.0000"
  };
  std::string text = line(
      "energy", fmt::format("{:.6g} {} emitted = {:.4f} % absorbed + {:.4f} % escaped + {:.4f} % "
                            "unshot",
                            emitted, facts["light"] == light_name(true) ? "(relative units)" : "W",
                            percent("absorbed"), percent("escaped"), percent("unshot")));
  if (energy.contains("from_lamps")) {
    text += line("lamps", fmt::format("{:.4g} % of the emitted power; {:.4f} % met no surface",
                                      percent("from_lamps"), percent("missed")));
  }
  return text;
}

// The error estimate of the largest part that has one, and that of the worst.
std::string error_text(const Json& facts) {
  const double worst = facts["error_estimate"];
  const Json& parts = facts["parts"];
  const auto largest = std::ranges::find_if(
      parts, [](const Json& part) { return !part["error_estimate"].is_null(); });
  double error = worst;
  std::string of, and_worst;
  if (parts.size() > 1 && largest != parts.end()) {
    error = (*largest)["error_estimate"];
    of = fmt::format(" of the largest part, '{}'", (*largest)["name"].get<std::string>());
    if (worst > error) and_worst = fmt::format("; {:.2f} % in the worst part", 100.0 * worst);
  }
  std::string where;
  if (facts.contains("looked_from")) {
    std::vector<std::string> names = facts["looked_from"];
    for (std::string& name : names) name = "'" + name + "'";
    where = fmt::format(" in what is seen from {}", fmt::join(names, ", "));
  }
  return fmt::format("{:.2f} % of the mean irradiance{}, estimated (relative RMS){}{}",
                     100.0 * error, of, where, and_worst);
}

// The number of parts, and those with the largest errors.
std::string parts_text(const Json& facts) {
  const Json& parts = facts["parts"];
  std::vector<std::pair<double, std::string>> by_error;
  std::size_t dark = 0, by_cracks = 0;
  for (const Json& part : parts) {
    if (part["error_estimate"].is_null()) {
      ++(part.contains("lit_by_cracks") ? by_cracks : dark);
      continue;
    }
    const double error = part["error_estimate"];
    const bool has_lux = part.contains("lux");
    by_error.emplace_back(
        -error,
        fmt::format("'{}' {:.2f} % of {:.3g}{}", part["name"].get<std::string>(), 100.0 * error,
                    part[has_lux ? "lux" : "irradiance"].get<double>(), has_lux ? " lx" : ""));
  }
  std::ranges::sort(by_error);
  constexpr std::size_t most = 3;
  std::vector<std::string> worst;
  for (std::size_t i = 0; i < std::min(most, by_error.size()); ++i) {
    worst.push_back(by_error[i].second);
  }
  std::string text = fmt::format("{} that exchange little light: ", parts.size());
  text += fmt::format("{}", fmt::join(worst, ", "));
  if (by_error.size() > most) text += fmt::format(", {} better", by_error.size() - most);
  const char* const unjudged =
      facts.contains("looked_from") ? "not seen or without light" : "without light";
  std::vector<std::string> others;
  if (dark > 0) others.push_back(fmt::format("{} {}", dark, unjudged));
  if (by_cracks > 0) others.push_back(fmt::format("{} lit through cracks, not judged", by_cracks));
  if (!worst.empty() && !others.empty()) text += ", ";
  text += fmt::format("{}", fmt::join(others, ", "));
  return text;
}

// Sizes, energy balance, unlit surfaces, channels, residual and error estimate.
std::string solution_text(const Json& facts) {
  std::string text = line("patches", fmt::format("{} ({} elements)", facts["patches"].get<int>(),
                                                 facts["elements"].get<int>()));
  if (facts.contains("refined")) text += line("refined", facts["refined"].get<std::string>());
  text += energy_text(facts);
  if (facts.contains("lights")) {
    const Json& lights = facts["lights"];
    text += line("lights", fmt::format("a point asks {:.0f} of {} ({} at most)",
                                       lights["asked"].get<double>(), lights["count"].get<int>(),
                                       lights["asked_most"].get<int>()));
  }
  constexpr double worth_a_line = 0.005;
  if (facts.contains("unlit") && facts["unlit"]["share"].get<double>() >= worth_a_line) {
    const Json& unlit = facts["unlit"];
    text += line("dark",
                 fmt::format("{:.3g} m2 of surfaces ({:.0f} %) face a room and get no light, most "
                             "of this area on '{}'; check that light can reach the room",
                             unlit["area"].get<double>(), 100.0 * unlit["share"].get<double>(),
                             unlit["surface"].get<std::string>()));
  }
  if (facts.contains("channels")) text += line("channels", channel_text(facts["channels"]));
  const std::string by =
      facts.contains("solver") ? " of " + facts["solver"].get<std::string>() : "";
  text += line("residual",
               fmt::format("{:.2g} after {} sweeps{} ({})", facts["residual"].get<double>(),
                           facts["sweeps"].get<int>(), by, facts["outcome"].get<std::string>()));
  if (facts.contains("error_estimate")) {
    text += line("error", error_text(facts));
    if (facts["parts"].size() > 1) text += line("parts", parts_text(facts));
  }
  return text;
}

// The parts of the scene in JSON, see add_solution().
Json parts_json(const SolvedScene& solved) {
  const RadiositySolution& solution = solved.solution;
  const std::vector<double> means = mean_irradiances(solved.mesh, solution);
  Json parts = Json::array();
  for (std::size_t p = 0; p < solution.parts.parts.size(); ++p) {
    const ScenePart& part = solution.parts.parts[p];
    Json figures = {{"name", part.name},
                    {"area", part.area},
                    {solution.relative_units ? "irradiance" : "lux", means[p]},
                    {"error_estimate", nullptr}};
    if (part.error_estimate >= 0.0) figures["error_estimate"] = part.error_estimate;
    if (part.is_lit_by_cracks) figures["lit_by_cracks"] = true;
    parts.push_back(std::move(figures));
  }
  return parts;
}

}  // namespace

Report::Report(const CommonOptions& options) : options_(options) {}

void Report::add_solution(const SolvedScene& solved, bool solved_now) {
  const RadiositySolution& solution = solved.solution;
  facts_["scene"] = solution.provenance.scene_file;
  facts_["options"] = solution.provenance.options;
  facts_["patches"] = solved.mesh.patch_count();
  facts_["elements"] = solved.mesh.element_count();
  if (!solution.provenance.refinement.empty()) {
    facts_["refined"] = solution.provenance.refinement;
  }
  if (!solution.provenance.looked_from.empty()) {
    facts_["looked_from"] = solution.provenance.looked_from;
  }
  facts_["bands"] = solution.bands.count();
  facts_["light"] = light_name(solution.relative_units);
  facts_["energy"] = energy_json(solution.energy);
  if (!solution.channels.empty()) facts_["channels"] = channels_json(solution);
  if (solved_now) facts_["solver"] = solution.solver;
  facts_["residual"] = solution.residual;
  facts_["sweeps"] = solution.history.size();
  facts_["error_estimate"] = solution.error_estimate;
  facts_["parts"] = parts_json(solved);
  facts_["outcome"] = outcome_name(solution.outcome);
  if (!solved_now) return;
  for (const auto& [phase, seconds] : solution.seconds) add_phase(phase, seconds);
}

void Report::add_storage(const StorageReport& storage) {
  constexpr double megabyte = 1 << 20;
  facts_["storage"] = {{"budget_mb", static_cast<double>(storage.limit) / megabyte},
                       {"memory_mb", static_cast<double>(storage.most_in_memory) / megabyte},
                       {"disk_mb", static_cast<double>(storage.most_on_disk) / megabyte},
                       {"folder", storage.folder.string()}};
}

void Report::add_phase(const std::string& phase, double seconds) {
  const auto known = std::ranges::find(phases_, phase, &PhaseSeconds::phase);
  if (known == phases_.end()) {
    phases_.push_back({phase, seconds});
  } else {
    known->seconds += seconds;
  }
}

void Report::add_file(const std::filesystem::path& file) {
  files_.push_back(file.string());
}

void Report::add(const std::string& key, Json value) {
  facts_[key] = std::move(value);
}

void Report::remove(const std::string& key) {
  facts_.erase(key);
}

Json Report::json() const {
  Json json = facts_;
  Json seconds = Json::object();
  for (const PhaseSeconds& phase : phases_) seconds[phase.phase] = phase.seconds;
  seconds["total"] = total_.seconds();
  json["seconds"] = std::move(seconds);
  json["peak_memory_mb"] = peak_memory_mb();
  json["threads"] = thread_count();
  json["version"] = LIGHTWELL_VERSION;
  json["files"] = files_;
  return json;
}

std::string Report::for_people() const {
  std::string text = facts_.contains("energy") ? solution_text(facts_) : std::string();
  std::vector<std::string> phases;
  for (const PhaseSeconds& phase : phases_) {
    phases.push_back(fmt::format("{} {:.1f}", phase.phase, phase.seconds));
  }
  text +=
      line("seconds", fmt::format("{:.1f} ({}), {} {}", total_.seconds(), fmt::join(phases, ", "),
                                  thread_count(), thread_count() == 1 ? "thread" : "threads"));
  if (facts_.contains("storage")) text += line("storage", storage_text(facts_["storage"]));
  text += line("memory", fmt::format("{:.0f} MB at most", peak_memory_mb()));
  for (const std::string& file : files_) text += line("wrote", file);
  return text;
}

void Report::print() const {
  if (options_.json) {
    print_json(json());
  } else if (!options_.quiet) {
    fmt::print("{}", for_people());
  }
}

void Report::write(const std::filesystem::path& file) const {
  write_json(file, json());
}

void print_json(const Json& json) {
  fmt::print("{}", json_text(json));
}

void write_json(const std::filesystem::path& file, const Json& json) {
  write_whole(file, {json_text(json)});
}

std::string outcome_name(Outcome outcome) {
  switch (outcome) {
    case Outcome::max_sweeps_reached:
      return "max_sweeps_reached";
    case Outcome::accuracy_missed:
      return "accuracy_missed";
    case Outcome::cut_short:
      return "cut_short";
    case Outcome::converged:
      break;
  }
  return "converged";
}

std::string light_name(bool relative_units) {
  return relative_units ? "relative" : "watts";
}

Json clean_up_json(const CleanUpReport& report) {
  return {{"facets", report.facets_after},
          {"welded_vertices", report.welded_vertices},
          {"degenerate", report.degenerate},
          {"duplicates", report.duplicates},
          {"flipped", report.flipped},
          {"merged", report.merged},
          {"joined", report.joined},
          {"hanging_vertices", report.hanging},
          {"area_change", report.area_change()}};
}

Json energy_json(const EnergyBalance& energy) {
  Json json = {{"emitted", energy.emitted},
               {"absorbed", energy.absorbed},
               {"escaped", energy.escaped},
               {"unshot", energy.unshot}};
  if (energy.from_lamps > 0.0) {
    json["from_lamps"] = energy.from_lamps;
    json["missed"] = energy.missed;
  }
  return json;
}

}  // namespace lightwell
