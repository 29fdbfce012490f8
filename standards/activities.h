#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/io/activity_file.h"

namespace lightwell {

/// The activities that the program knows by itself: the contents of standards/activities.toml.
std::vector<Activity> usual_activities();

/// The activity of a key. Throws InputError that begins with `asked_by`, such as "area 'desk'", and
/// names the nearest key.
const Activity& find_activity(const std::vector<Activity>& activities, const std::string& key,
                              const std::string& asked_by);

namespace standards_data {
extern const std::string_view activities;  ///< the bytes of activities.toml
}  // namespace standards_data

}  // namespace lightwell
