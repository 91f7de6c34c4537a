// What light a task asks for: requirements after EN 12464-1 as a small table, and own ones.
// Reference: [1] EN 12464-1, table of requirements for interior areas, tasks and activities.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace troffer {

struct Profile {
  std::string id, name;
  double illuminance_lx = 0;  // least maintained mean
  double ugr_limit = 0;       // most; 0: none
  double uniformity = 0;      // least of least over mean
  int colour_rendering = 0;   // Ra that lamps should have: told, not tested
  double cylindrical_lx = 0;  // least mean at eye height; 0: none
  double eye_height = 1.2;    // m above the floor: 1.2 seated, 1.6 standing
  // The area around a task, in the same room: observers there have the task's UGR limit.
  bool is_around_task = false;
};

// The table that comes with the program.
const std::vector<Profile>& standard_profiles();

// The profile of that id; null where there is none. Ids are compared letter by letter.
const Profile* find_profile(const std::vector<Profile>& profiles, std::string_view id);

// All ids, as a sentence lists them.
std::string profile_ids(const std::vector<Profile>& profiles);

}  // namespace troffer
