// What is kept of a viewing ray for comparison with its neighbours: the object it met, and how each
// sampled source was seen from there.
// References: [1] Painter & Sloan, "Antialiased Ray Tracing by Adaptive Progressive Refinement",
//   SIGGRAPH 1989. [2] Kok & Jansen, Eurographics '92, §5 (patterns of neighbours).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"
#include "trace/ray.h"
#include "transport/shadow_pattern.h"

namespace troffer {

struct SourcePattern {
  uint32_t source = 0;
  float weight = 0;  // luminance that it would send on if nothing were in the way
  ShadowPattern pattern;
};

struct ShadowRecord {
  uint32_t geometry = no_geometry;  // as in Hit; no_geometry: the ray left the scene
  bool is_front = true;
  Vec3 normal;  // shading normal on the viewer's side
  Vec3 position;
  std::vector<SourcePattern> patterns;  // by increasing source; empty on mirrors

  const SourcePattern* of(uint32_t source) const {
    for (const SourcePattern& p : patterns)
      if (p.source == source) return &p;
    return nullptr;
  }
};

// The same side of the same object, facing about the same way (within 25 degrees).
bool is_same_surface(const ShadowRecord& a, const ShadowRecord& b);

// Records of nearby viewing rays; unused ones are null.
using NeighbourRecords = std::array<const ShadowRecord*, 5>;

// The cells of a source about which the neighbours on the same surface agree, as a pattern: lit,
// dark, or (neither) to be asked by rays. False where fewer than two of them know the source.
bool agreed_pattern(std::span<const ShadowRecord* const> neighbours, const ShadowRecord& here,
                    uint32_t source, ShadowPattern& agreed);

// The light that the patterns of two rays on the same surface disagree about: the sum over sources
// of weight × share of the source, luminance of radiance.
float pattern_contrast(const ShadowRecord& a, const ShadowRecord& b);

}  // namespace troffer
