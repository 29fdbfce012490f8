#include "daylight/honeybee_metrics.h"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <array>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "scene/atomic_file.h"

namespace lightwell {
namespace {

struct Metric {
  const char* folder;
  const char* extension;
};

constexpr std::array<Metric, 5> metrics_of_recipe = {
    Metric{"da", "da"}, Metric{"cda", "cda"}, Metric{"udi_lower", "udi"}, Metric{"udi", "udi"},
    Metric{"udi_upper", "udi"}};
constexpr const char* grids_info = "grids_info.json";

// Percent of the occupied hours, per sensor; in the order of metrics_of_recipe.
std::array<Eigen::ArrayXd, 5> values_of(const SensorMetrics& metrics) {
  return {metrics.autonomy, metrics.continuous_autonomy, metrics.below_100,
          metrics.from_100_to_300 + metrics.from_300_to_3000, metrics.above_3000};
}

// Honeybee's identifiers are letters, digits, dots, dashes and underscores; other characters, and
// names of dots alone, could lead out of the folder.
std::string plain(std::string name) {
  for (char& c : name) {
    const bool is_plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') ||
                          (c >= 'a' && c <= 'z') || c == '-' || c == '_' || c == '.';
    if (!is_plain) c = '_';
  }
  if (name.find_first_not_of('.') == std::string::npos) name = "_" + name;
  return name;
}

// Names of the grids' files without extension, with the folder of the group: "group/name".
std::vector<std::string> file_names(std::span<const MetricGrid> grids) {
  std::vector<std::string> names;
  std::set<std::string> given;
  for (const MetricGrid& grid : grids) {
    const std::string folder = grid.group.empty() ? "" : plain(grid.group) + "/";
    const std::string name = folder + plain(grid.name);
    std::string unique = name;
    for (int number = 2; !given.insert(unique).second; ++number) {
      unique = fmt::format("{}_{}", name, number);
    }
    names.push_back(std::move(unique));
  }
  return names;
}

std::string with_extension(const std::string& name, const Metric& metric) {
  return fmt::format("{}.{}", name, metric.extension);
}

}  // namespace

std::vector<std::filesystem::path> honeybee_metric_files(std::span<const MetricGrid> grids) {
  std::vector<std::filesystem::path> files;
  const std::vector<std::string> names = file_names(grids);
  for (const Metric& metric : metrics_of_recipe) {
    const std::filesystem::path folder = metric.folder;
    for (const std::string& name : names) files.push_back(folder / with_extension(name, metric));
    files.push_back(folder / grids_info);
  }
  return files;
}

void write_honeybee_metrics(const std::filesystem::path& folder, std::span<const MetricGrid> grids,
                            const SensorMetrics& metrics) {
  const std::vector<std::string> names = file_names(grids);
  nlohmann::ordered_json info = nlohmann::ordered_json::array();
  for (std::size_t g = 0; g < grids.size(); ++g) {
    info.push_back({{"name", grids[g].name},
                    {"identifier", grids[g].name},
                    {"count", grids[g].count},
                    {"group", grids[g].group},
                    {"full_id", names[g]}});
  }
  const auto values = values_of(metrics);
  for (std::size_t m = 0; m < values.size(); ++m) {
    const Metric& metric = metrics_of_recipe[m];
    const std::filesystem::path of_metric = folder / metric.folder;
    for (std::size_t g = 0; g < grids.size(); ++g) {
      const std::filesystem::path of_grid = of_metric / with_extension(names[g], metric);
      std::filesystem::create_directories(of_grid.parent_path());
      AtomicStream file(of_grid);
      for (const double value : values[m].segment(grids[g].first, grids[g].count)) {
        fmt::print(file.stream(), "{:.2f}\n", value);
      }
      file.commit();
    }
    std::filesystem::create_directories(of_metric);
    AtomicStream file(of_metric / grids_info);
    file.stream() << info.dump() << '\n';
    file.commit();
  }
}

}  // namespace lightwell
