#include "scene/io/remarks.h"

#include <fmt/format.h>

#include <algorithm>

namespace lightwell {
namespace {

constexpr std::size_t listed = 5;

}  // namespace

void Remarks::add(std::string_view what, std::string_view name) {
  auto found = std::find_if(remarks_.begin(), remarks_.end(),
                            [&](const Remark& remark) { return remark.what == what; });
  if (found == remarks_.end()) {
    found = remarks_.insert(remarks_.end(), Remark{.what = std::string(what)});
  }
  const bool is_new = found->names.emplace(name).second;
  if (is_new && found->first.size() < listed) found->first.emplace_back(name);
}

std::vector<std::string> Remarks::sentences() const {
  std::vector<std::string> result;
  for (const Remark& remark : remarks_) {
    std::string sentence = remark.what + ": ";
    for (std::size_t i = 0; i < remark.first.size(); ++i) {
      sentence += fmt::format("{}'{}'", i ? ", " : "", remark.first[i]);
    }
    const std::size_t more = remark.names.size() - remark.first.size();
    if (more > 0) sentence += fmt::format(" and {} more", more);
    result.push_back(sentence + ".");
  }
  return result;
}

void note_if_dark(Scene& scene) {
  const bool shines =
      std::ranges::any_of(scene.materials, [](const Material& m) { return m.is_emitter(); });
  if (!shines) scene.notes.emplace_back("No surface shines, so the scene is dark.");
}

}  // namespace lightwell
