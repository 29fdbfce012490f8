#include "scene/io/radiance/files/radiance_project.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/io/nearest_name.h"
#include "scene/io/radiance/text/radiance_command.h"

namespace lightwell {
namespace {

// A variable of rad and the least number of letters of an abbreviation.
struct Variable {
  std::string_view name;
  std::size_t least;
};

constexpr Variable rif_variables[] = {
    {"AMBFILE", 3},  {"DETAIL", 3},    {"EXPOSURE", 3},   {"EYESEP", 3},  {"illum", 3},
    {"INDIRECT", 3}, {"materials", 3}, {"mkillum", 3},    {"mkpmap", 3},  {"objects", 3},
    {"oconv", 3},    {"OCTREE", 3},    {"OPTFILE", 3},    {"PCMAP", 2},   {"PENUMBRAS", 3},
    {"pfilt", 2},    {"PGMAP", 2},     {"PICTURE", 3},    {"QUALITY", 3}, {"RAWFILE", 3},
    {"render", 3},   {"REPORT", 3},    {"RESOLUTION", 3}, {"rpict", 3},   {"rvu", 3},
    {"rview", 3},    {"scene", 3},     {"UP", 2},         {"view", 2},    {"VARIABILITY", 3},
    {"ZFILE", 2},    {"ZONE", 2}};

}  // namespace

RadianceProject::RadianceProject(const TextFile& file) {
  std::string joined;
  RadianceLocation location{&file.path(), 0};
  file.for_each_line([&](int line, std::string_view text) {
    if (joined.empty()) location.line = line;
    bool continues = false;
    for (std::size_t i = 0; i < text.size() && text[i] != '#'; ++i) {
      if (text[i] == '\\') {
        continues = i + 1 == text.size();
        if (!continues) joined += text.substr(i++, 2);
      } else {
        joined += text[i];
      }
    }
    joined += ' ';
    if (continues) return;
    assign(joined, location);
    joined.clear();
  });
  assign(joined, location);
}

void RadianceProject::assign(std::string_view text, const RadianceLocation& location) {
  text = trimmed(text);
  const std::size_t end = text.find_first_of(" \t=");
  const std::string_view name = text.substr(0, end);
  if (name.empty()) return;
  const std::size_t value = std::min(text.find_first_not_of(" \t=", name.size()), text.size());
  const auto* found = std::ranges::find_if(rif_variables, [&](const Variable& v) {
    return name.size() >= v.least && v.name.starts_with(name);
  });
  if (found == std::end(rif_variables)) {
    std::vector<std::string> names;
    for (const Variable& v : rif_variables) names.emplace_back(v.name);
    location.fail(fmt::format("there is no variable '{}'.{}", excerpt(name),
                              did_you_mean(std::string(name), names)));
  }
  if (value == text.size()) return;
  values_.emplace_back(found->name, Value{std::string(text.substr(value)), location});
}

std::vector<RadianceProject::Value> RadianceProject::values(std::string_view variable) const {
  std::vector<Value> result;
  for (const auto& [name, value] : values_) {
    if (name == variable) result.push_back(value);
  }
  return result;
}

std::vector<RadianceProject::Value> RadianceProject::words(std::string_view variable) const {
  std::vector<Value> result;
  for (const Value& value : values(variable)) {
    const auto pipe = split_radiance_pipe(value.text, value.location);
    if (pipe.size() > 1) value.location.fail("put commands with '|' between quotes");
    for (const std::string& word : pipe.front()) result.push_back({word, value.location});
  }
  return result;
}

std::vector<std::string> RadianceProject::given() const {
  std::vector<std::string> result;
  for (const auto& [name, value] : values_) {
    if (std::ranges::find(result, name) == result.end()) result.push_back(name);
  }
  return result;
}

}  // namespace lightwell
