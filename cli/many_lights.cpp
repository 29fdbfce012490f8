#include "cli/many_lights.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "cli/arguments.h"

namespace lightwell {
namespace {

struct NamedManyLights {
  std::string_view name;
  ManyLights method;
};

constexpr std::array<NamedManyLights, 4> methods{{
    {"lightcuts", ManyLights::lightcuts},
    {"sorted", ManyLights::sorted},
    {"importance", ManyLights::importance},
    {"all", ManyLights::all},
}};

std::vector<std::string> names() {
  std::vector<std::string> result;
  for (const NamedManyLights& known : methods) result.emplace_back(known.name);
  return result;
}

}  // namespace

void add_many_lights(CLI::App& command, SolveOptions& options, const std::string& group) {
  command
      .add_option_function<std::string>(
          "--many-lights",
          [&options](const std::string& name) {
            const ManyLights method =
                std::ranges::find(methods, name, &NamedManyLights::name)->method;
            options.gather.shadows.many_lights = method;
            // Form factors of emitters know cuts, or no clusters.
            if (method == ManyLights::all) options.form_factors.shadows.cluster_share = 0.0;
          },
          "which of 32 and more lights a point asks: lightcuts (default), sorted, importance, all")
      ->type_name("METHOD")
      ->check(one_of("method", names()))
      ->group(group);
}

std::string many_lights_text(const SolveOptions& options) {
  const ManyLights method = options.gather.shadows.many_lights;
  if (method == ManyLights::lightcuts) return "";
  const auto known = std::ranges::find(methods, method, &NamedManyLights::method);
  return " --many-lights " + std::string(known->name);
}

}  // namespace lightwell
