// Data of a viewing ray for comparison with its neighbours: the object that it met, and the
// visibility of each sampled source from there.
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
  float weight = 0;  // luminance of the reflected unoccluded light of the source
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

// True if both are on the same side of the same object, with normals within 25 degrees.
bool is_same_surface(const ShadowRecord& a, const ShadowRecord& b);

// Records of nearby viewing rays; unused ones are null.
using NeighbourRecords = std::array<const ShadowRecord*, 5>;

// Finds the cells of a source on which all neighbours on the same surface agree. A cell that is
// neither lit nor dark in `agreed` needs rays. Returns false if fewer than two neighbours know the
// source.
bool agreed_pattern(std::span<const ShadowRecord* const> neighbours, const ShadowRecord& here,
                    uint32_t source, ShadowPattern& agreed);

// Returns the luminance of the light on which the patterns of two rays disagree: the sum over
// sources of weight × pattern_difference().
float pattern_contrast(const ShadowRecord& a, const ShadowRecord& b);

}  // namespace troffer
