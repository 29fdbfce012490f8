#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/console.h"
#include "mesh/cleaning/planar_regions.h"
#include "radiosity/solve.h"

namespace lightwell {

/// JSON whose keys keep the order in which they were added.
using Json = nlohmann::ordered_json;

/// Results, seconds and files of a command: text by default, one JSON object with --json.
class Report {
 public:
  explicit Report(const CommonOptions& options);

  /// Adds sizes, energy balance, residual, error estimates of the whole and of its parts; with
  /// `solved_now` also the solver and the seconds of its phases.
  void add_solution(const SolvedScene& solved, bool solved_now);
  /// Adds the memory budget and the rows of form factors in memory and on disk.
  void add_storage(const StorageReport& storage);
  void add_phase(const std::string& phase, double seconds);
  void add_file(const std::filesystem::path& file);
  void add(const std::string& key, Json value);
  void remove(const std::string& key);

  /// All keys, with total seconds and peak memory at the time of the call.
  Json json() const;
  /// Prints on standard output: the JSON object with --json, nothing with --quiet, text otherwise.
  void print() const;
  /// Writes the JSON object; throws std::runtime_error that names `file`.
  void write(const std::filesystem::path& file) const;

 private:
  std::string for_people() const;

  CommonOptions options_;
  Stopwatch total_{};
  Json facts_ = Json::object();
  std::vector<PhaseSeconds> phases_{};
  std::vector<std::string> files_{};
};

/// Console and report of a command: the targets of messages and of results.
struct Feedback {
  Console& console;
  Report& report;
};

/// Prints a JSON object on standard output.
void print_json(const Json& json);

/// Writes a JSON object; throws std::runtime_error that names `file`.
void write_json(const std::filesystem::path& file, const Json& json);

/// Value of the JSON key "light", the unit of power: "watts" or "relative".
std::string light_name(bool relative_units);

/// Counts of the repairs of a scene's polygons, for JSON.
Json clean_up_json(const CleanUpReport& report);

/// Emitted, absorbed, escaped and unshot power for JSON, in watts or relative units.
Json energy_json(const EnergyBalance& energy);

/// "converged", "max_sweeps_reached", "accuracy_missed" or "cut_short".
std::string outcome_name(Outcome outcome);

}  // namespace lightwell
