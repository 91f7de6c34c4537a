#include "transport/shadow_record.h"

#include <algorithm>

namespace troffer {

bool is_same_surface(const ShadowRecord& a, const ShadowRecord& b) {
  constexpr float cos_same_way = 0.906f;
  if (a.geometry != b.geometry) return false;
  if (a.geometry == no_geometry) return true;
  return a.is_front == b.is_front && dot(a.normal, b.normal) >= cos_same_way;
}

bool agreed_pattern(std::span<const ShadowRecord* const> neighbours, const ShadowRecord& here,
                    uint32_t source, ShadowPattern& agreed) {
  int voices = 0;
  agreed.lit = agreed.dark = ~uint64_t(0);
  for (const ShadowRecord* n : neighbours) {
    if (n == nullptr || !is_same_surface(*n, here)) continue;
    const SourcePattern* p = n->of(source);
    if (p == nullptr) continue;
    agreed.lit &= p->pattern.lit;
    agreed.dark &= p->pattern.dark;
    ++voices;
  }
  return voices >= 2;
}

float pattern_contrast(const ShadowRecord& a, const ShadowRecord& b) {
  float sum = 0;
  for (const SourcePattern& p : a.patterns)
    if (const SourcePattern* q = b.of(p.source))
      sum += std::max(p.weight, q->weight) * pattern_difference(p.pattern, q->pattern);
  return sum;
}

}  // namespace troffer
