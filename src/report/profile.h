// Requirements on the light for a task: a small table after EN 12464-1, or the user's own.
// assess() checks each surface against its profile.
// Reference: [1] EN 12464-1, table of requirements for interior areas, tasks and activities.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace troffer {

// Requirements of one kind of task.
struct Profile {
  std::string id, name;
  double illuminance_lx = 0;  // least maintained mean illuminance
  double ugr_limit = 0;       // highest UGR; 0: no limit
  double uniformity = 0;      // least ratio of minimum to mean
  int colour_rendering = 0;   // least Ra of lamps: printed, not tested
  double cylindrical_lx = 0;  // least mean cylindrical illuminance at eye height; 0: none
  double eye_height = 1.2;    // m above the floor: 1.2 seated, 1.6 standing
  // True for surroundings of a task in the same room. Observers there have the task's UGR limit.
  bool is_around_task = false;
};

// Returns the built-in table.
const std::vector<Profile>& standard_profiles();

// Returns the profile with that id, or null. Ids are case-sensitive.
const Profile* find_profile(const std::vector<Profile>& profiles, std::string_view id);

// Returns all ids, separated by commas.
std::string profile_ids(const std::vector<Profile>& profiles);

}  // namespace troffer
