// What a source's shadows have taught so far: the facets that rays met, and that lists stay too
// long.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace troffer {

// Occluders of one source that rays met: kept from cluster to cluster by the caller.
class FoundFacets {
 public:
  struct Entry {
    uint32_t id;
    uint32_t hits;
  };
  // Rays met these facets; sorts them.
  void add(std::vector<uint32_t>& ids);
  // Keeps the `most` most hit, and halves the counts.
  void trim(size_t most);
  const std::vector<Entry>& entries() const { return entries_; }

  // A cluster about `centre` within `radius` had lists that stayed too long; and whether one has,
  // that close.
  void note_hopeless(const Vec3d& centre, double radius) { hopeless_.push_back({centre, radius}); }
  bool is_hopeless_at(const Vec3d& centre, double radius) const;
  bool is_hopeless() const { return !hopeless_.empty(); }

  // What rays straight to the source have found: halved with each cluster, so that it is that of
  // the last few.
  class Dense {
   public:
    void note(double light, double unoccluded, double variance, double random_variance) {
      light_ = 0.5 * light_ + light;
      unoccluded_ = 0.5 * unoccluded_ + unoccluded;
      variance_ = 0.5 * variance_ + variance;
      random_variance_ = 0.5 * random_variance_ + random_variance;
    }
    float open_share() const { return unoccluded_ > 0 ? float(light_ / unoccluded_) : 0.5f; }
    // Where much is open no single facet hides it all.
    bool is_partly_open() const { return unoccluded_ > 0 && light_ > 0.05 * unoccluded_; }
    // Their variance over that of as many independent ones.
    float gain() const {
      return random_variance_ > 0 ? std::clamp(float(variance_ / random_variance_), 0.1f, 1.0f)
                                  : 0.5f;
    }

    // Receivers were worth so many rays each, by the error asked of each of them.
    void note_wanted(double receivers, double rays) {
      receivers_ += receivers;
      roots_ += receivers * std::sqrt(rays);
    }
    // Rays for those that are worth `rays`: for the mean square of all receivers' errors, relative
    // to what each may err by, the fewest are had by numbers in proportion to the roots of what is
    // wanted. Nobody errs by more than twice what it may.
    double spread(double rays) const {
      if (!(receivers_ > 0)) return rays;
      return std::clamp(std::sqrt(rays) * roots_ / receivers_, 0.25 * rays, 4 * rays);
    }

   private:
    double light_ = 0, unoccluded_ = 0, variance_ = 0, random_variance_ = 0;
    double receivers_ = 0, roots_ = 0;
  };
  Dense dense;
  // Whether anything that rises over the source's plane comes within rounding of the source: rays
  // must then look at it to its end.
  enum class Rim : uint8_t { unknown, none, some };
  Rim rim = Rim::unknown;

 private:
  struct Place {
    Vec3d centre;
    double radius;
  };
  std::vector<Place> hopeless_;
  std::vector<Entry> entries_;
};

}  // namespace troffer
