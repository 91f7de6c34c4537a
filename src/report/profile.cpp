#include "report/profile.h"

#include <algorithm>

namespace troffer {

const std::vector<Profile>& standard_profiles() {
  constexpr double seated = 1.2, standing = 1.6;
  static const std::vector<Profile> profiles{
      {"office-writing", "Office: writing, reading, typing", 500, 19, 0.6, 80, 150, seated},
      {"office-filing", "Office: filing, copying", 300, 19, 0.4, 80, 50, standing},
      {"technical-drawing", "Technical drawing", 750, 16, 0.7, 80, 150, seated},
      {"cad", "CAD work stations", 500, 19, 0.6, 80, 150, seated},
      {"meeting", "Conference and meeting rooms", 500, 19, 0.6, 80, 150, seated},
      {"reception", "Reception desk", 300, 22, 0.6, 80, 50, seated},
      {"archive", "Archives", 200, 25, 0.4, 80, 0, standing},
      {"classroom", "Classrooms", 300, 19, 0.6, 80, 50, seated},
      {"classroom-adults", "Classrooms for evening classes and adults, lecture halls", 500, 19, 0.6,
       80, 150, seated},
      {"board", "Black, green and white boards", 500, 19, 0.7, 80, 0, standing},
      {"library-reading", "Libraries: reading area", 500, 19, 0.6, 80, 50, seated},
      {"library-shelves", "Libraries: bookshelves", 200, 19, 0.6, 80, 0, standing},
      {"corridor", "Corridors and circulation areas", 100, 28, 0.4, 40, 0, standing},
      {"stairs", "Stairs, escalators, travelators", 100, 25, 0.4, 40, 0, standing},
      {"restroom", "Washrooms, bathrooms, toilets", 200, 25, 0.4, 80, 0, standing},
      {"canteen", "Canteens, pantries", 200, 22, 0.4, 80, 50, seated},
      {"kitchen", "Kitchens", 500, 22, 0.6, 80, 0, standing},
      {"sales", "Sales areas", 300, 22, 0.4, 80, 75, standing},
      {"store-room", "Store and stockrooms", 100, 25, 0.4, 60, 0, standing},
      {"assembly-medium", "Assembly work, medium", 500, 22, 0.6, 80, 0, standing},
      {"assembly-fine", "Assembly work, fine", 750, 19, 0.7, 80, 0, seated},
      {"surrounding", "Immediate surroundings of a task of 500 lx", 300, 0, 0.4, 0, 0, seated,
       true},
      {"background", "Background of tasks of 500 lx", 100, 0, 0.1, 0, 0, seated, true},
      {"none", "No requirement", 0, 0, 0, 0, 0, seated},
  };
  return profiles;
}

const Profile* find_profile(const std::vector<Profile>& profiles, std::string_view id) {
  const auto at =
      std::find_if(profiles.begin(), profiles.end(), [&](const Profile& p) { return p.id == id; });
  return at == profiles.end() ? nullptr : &*at;
}

std::string profile_ids(const std::vector<Profile>& profiles) {
  std::string ids;
  for (const Profile& p : profiles) ids += (ids.empty() ? "" : ", ") + p.id;
  return ids;
}

}  // namespace troffer
