#include "standards/activities.h"

#include "standards/table_key.h"

namespace lightwell {

std::vector<Activity> usual_activities() {
  return parse_activities(standards_data::activities, "activities.toml");
}

const Activity& find_activity(const std::vector<Activity>& activities, const std::string& key,
                              const std::string& asked_by) {
  return find_entry(
      activities, {.key = key, .asked_by = asked_by, .noun = "activity", .option = "--activities"});
}

}  // namespace lightwell
