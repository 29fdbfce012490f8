#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/console.h"
#include "mesh/cleaning/planar_regions.h"
#include "radiosity/solve.h"

namespace lightwell {

/// Keys in the order they are added.
using Json = nlohmann::ordered_json;

/// What a command did and what it cost, collected on the way: for people by default, one JSON
/// object with --json.
class Report {
 public:
  explicit Report(const CommonOptions& options);

  /// Sizes, energy balance, residual, error estimate, and the solver's own phases if it ran now.
  void add_solution(const SolvedScene& solved, bool solved_now);
  /// What memory was allowed for and where rows of form factors were.
  void add_storage(const StorageReport& storage);
  void add_phase(const std::string& phase, double seconds);
  void add_file(const std::filesystem::path& file);
  void add(const std::string& key, Json value);
  void remove(const std::string& key);

  /// All of it, with the totals up to now.
  Json json() const;
  /// On standard output: the JSON object with --json, else a report for people unless --quiet.
  void print() const;
  /// The JSON object as a file; throws std::runtime_error naming it.
  void write(const std::filesystem::path& file) const;

 private:
  std::string for_people() const;

  CommonOptions options_;
  Stopwatch total_{};
  Json facts_ = Json::object();
  std::vector<PhaseSeconds> phases_{};
  std::vector<std::string> files_{};
};

/// One JSON object on standard output.
void print_json(const Json& json);

/// A JSON object as a file; throws std::runtime_error naming it.
void write_json(const std::filesystem::path& file, const Json& json);

/// What light is in, for the key "light" of JSON: "watts" or "relative".
std::string light_name(bool relative_units);

/// What cleaning did to a scene's polygons, for JSON.
Json clean_up_json(const CleanUpReport& report);

/// Watts by fate, or their relative amounts, for JSON.
Json energy_json(const EnergyBalance& energy);

/// "converged" or "max_sweeps_reached".
std::string outcome_name(Outcome outcome);

}  // namespace lightwell
