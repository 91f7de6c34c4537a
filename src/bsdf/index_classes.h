// Chooses the indices of refraction for which BsdfTables builds tables, where a scene has more
// indices than tables.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace troffer {

class IndexClasses {
 public:
  void add(float index) { indices_.push_back(index); }

  // Divides the indices into at most `most` classes, 2 or more, so that the largest ratio within a
  // class is as small as possible. Indices above and below 1 never share a class: light is totally
  // reflected on one side only. The result does not depend on the order of add().
  void divide(size_t most) {
    std::sort(indices_.begin(), indices_.end());
    indices_.erase(std::unique(indices_.begin(), indices_.end()), indices_.end());
    // Indices are within [1/100, 100], so a ratio of 1e4 leaves one class on each side of 1.
    float small = 1 + least_step, large = 1e4f;
    if (count(small) > most) {
      for (int i = 0; i < 40; ++i) {
        const float middle = std::sqrt(small * large);
        (count(middle) > most ? small : large) = middle;
      }
      small = large;
    }
    classes_.clear();
    for (size_t i = 0; i < indices_.size();) {
      const size_t end = end_of_class(i, small);
      const float first = indices_[i], last = indices_[end - 1];
      classes_.push_back({first, first == last ? first : std::sqrt(first * last)});
      i = end;
    }
  }

  // Number of classes, and the index that represents one.
  size_t size() const { return classes_.size(); }
  float representative(size_t c) const { return classes_[c].index; }
  // Returns the class of an added index.
  int32_t of(float index) const {
    const auto above = std::upper_bound(classes_.begin(), classes_.end(), index,
                                        [](float x, const Class& c) { return x < c.first; });
    return int32_t(above - classes_.begin()) - 1;
  }

 private:
  // Tables of indices this close together differ by less than the tables' own error of .001.
  static constexpr float least_step = 1e-4f;

  struct Class {
    float first, index;  // smallest index, representative
  };

  size_t end_of_class(size_t first, float ratio) const {
    const float start = indices_[first];
    size_t end = first + 1;
    while (end < indices_.size() && indices_[end] <= start * ratio &&
           (start < 1) == (indices_[end] < 1))
      ++end;
    return end;
  }
  size_t count(float ratio) const {
    size_t n = 0;
    for (size_t i = 0; i < indices_.size(); ++n) i = end_of_class(i, ratio);
    return n;
  }

  std::vector<float> indices_;
  std::vector<Class> classes_;
};

}  // namespace troffer
