#include "standards/activities.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/errors.h"
#include "scene/io/nearest_name.h"

namespace lightwell {

std::vector<Activity> usual_activities() {
  return parse_activities(standards_data::activities, "activities.toml");
}

const Activity& find_activity(const std::vector<Activity>& activities, const std::string& key,
                              const std::string& asked_by) {
  const auto at = std::ranges::find(activities, key, &Activity::key);
  if (at != activities.end()) return *at;
  std::string known;
  std::vector<std::string> keys;
  for (const Activity& activity : activities) {
    known += (known.empty() ? "" : ", ") + activity.key;
    keys.push_back(activity.key);
  }
  throw InputError(fmt::format(
      "{}: there is no activity '{}'.{} The table has {}; '--activities FILE' reads another "
      "table.",
      asked_by, key, did_you_mean(key, keys), known));
}

}  // namespace lightwell
