#include "cells/cell_map.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/prefetch.h"
#include "base/random.h"

namespace troffer {

namespace {

// Hits of one cell lie in one plane within this share of its size, or farther off where it is
// curved.
constexpr float flatness = 0.05f;
// Least cosine between normals in a cell.
constexpr float least_cosine = 0.87f;
// Height above the surface of visibility tests, in cell sizes.
constexpr float lift = 0.1f;
// Largest width of the surface of a narrow cell, and the precision to which it is found, in cell
// sizes.
constexpr float most_of_narrow = 1.2f, known_width = 0.05f;
// Cells of one voxel. A hit that is compatible with none of so many joins the least incompatible
// one. Otherwise the leaves of a tree would make a long list in each voxel.
constexpr int most_in_voxel = 12;
// Number of times that a cell may be halved.
constexpr int32_t most_halvings = 6;

// Returns the axis along which a normal points most, and its sign. The factors keep rounding from
// tearing surfaces at 45°.
uint32_t face_of(const Vec3& n) {
  const float x = std::abs(n.x), y = std::abs(n.y) * 1.017f, z = std::abs(n.z) * 1.031f;
  const uint32_t axis = x > y && x > z ? 0 : y > z ? 1 : 2;
  return 2 * axis + (n[axis] < 0 ? 1u : 0u);
}

// Returns the voxel's number along one axis. The shift keeps the grid off the round coordinates at
// which people build.
constexpr double shift = 0.3819660;
int64_t voxel_of(float x, float size) {
  return int64_t(std::floor(double(x) / double(size) + shift));
}

uint64_t key_of(const CellHit& h, float size, int32_t level) {
  const uint64_t key = hash_of(
      uint64_t(voxel_of(h.position.x, size)), uint64_t(voxel_of(h.position.y, size)),
      uint64_t(voxel_of(h.position.z, size)), face_of(h.normal) + 8 * uint64_t(int64_t(level)));
  return key == 0 ? 1 : key;  // 0 marks an empty slot
}

// Returns the outline of the voxel of a hit. Its normal must not be far from its main axis.
CellOutline outline_of(const CellHit& hit, float size) {
  const Vec3& n = hit.horizon;
  const size_t up = face_of(hit.normal) / 2, u = (up + 1) % 3, v = (up + 2) % 3;
  CellOutline outline;
  outline.normal = n;
  outline.offset = hit.offset;
  for (size_t i = 0; i < 4; ++i) {
    Vec3 d;
    const auto low = [&](size_t axis) {
      return float((double(voxel_of(hit.position[axis], size)) - shift) * double(size)) -
             hit.position[axis];
    };
    d[u] = low(u) + (i == 1 || i == 2 ? size : 0.0f);
    d[v] = low(v) + (i >= 2 ? size : 0.0f);
    d[up] = -(n[u] * d[u] + n[v] * d[v]) / n[up];
    outline.corners[i] = hit.position + d;
  }
  return outline;
}

bool is_blocked(const Tracer& tracer, const Ray& ray) {
  if (length_squared(ray.direction) == 0) return false;
  uint8_t is_occluded = 0;
  tracer.occluded({&ray, 1}, {&is_occluded, 1});
  return is_occluded != 0;
}

}  // namespace

CellMap::CellMap(const Tracer& tracer, float size) : tracer_(tracer), size_(size), slots_(1024) {}

size_t CellMap::bytes() const {
  return anchors_.capacity() * sizeof(Anchor) + hits_.capacity() * sizeof(Hits) +
         more_hits_.size() * hits_of_asked_cell * sizeof(CellHit) +
         slots_.capacity() * sizeof(Slot);
}

size_t CellMap::slot_of(uint64_t key) const {
  size_t i = first_slot(key);
  while (slots_[i].key != 0 && slots_[i].key != key) i = (i + 1) & (slots_.size() - 1);
  return i;
}

bool CellMap::sees(const Anchor& a, const CellHit& hit) const {
  return !is_blocked(tracer_, segment(a.position + a.normal * (lift * a.size),
                                      hit.position + hit.horizon * (lift * a.size)));
}

// Searches the cells of one voxel, from its first one.
CellMap::Found CellMap::search(uint32_t first, const CellHit& hit) const {
  Found found;
  uint32_t best = no_cell;
  float least = 0;
  int cells = 0;
  for (uint32_t c = first; c != no_cell; c = anchors_[c].next, ++cells) {
    found.last = c;
    const Anchor& a = anchors_[c];
    const Vec3 d = hit.position - a.position;
    const float cosine = dot(a.normal, hit.horizon);
    const float off = std::abs(dot(d, a.normal));
    const float turn = length(hit.horizon - a.normal);
    const bool is_fitting = cosine >= least_cosine && off <= flatness * a.size + length(d) * turn;
    if (is_fitting && (!a.is_divided || sees(a, hit))) {
      found.cell = c;
      return found;
    }
    const float misfit =
        off / a.size + turn + (is_fitting ? 4.0f : 0.0f);  // unseen: the last resort
    if (best == no_cell || misfit < least) {
      best = c;
      least = misfit;
    }
  }
  if (cells >= most_in_voxel) found.cell = best;
  return found;
}

uint64_t CellMap::prefetch_voxel(const CellHit& hit, float distance) const {
  const int32_t level = first_level(distance);
  const uint64_t key = key_of(hit, size_at(level), level);
  prefetch_line(&slots_[first_slot(key)]);
  return key;
}

void CellMap::prefetch_cell(uint64_t voxel) const {
  const uint32_t cell = slots_[first_slot(voxel)].first;
  if (cell != no_cell) prefetch_object(anchors_[cell]);
}

uint32_t CellMap::find(const CellHit& hit, float distance) const {
  const int32_t level = first_level(distance);
  return find(hit, distance, key_of(hit, size_at(level), level));
}

uint32_t CellMap::find(const CellHit& hit, float distance, uint64_t voxel) const {
  for (int32_t level = first_level(distance);;) {
    const Slot& slot = slots_[slot_of(voxel)];
    if (slot.first == no_cell) return no_cell;
    const uint32_t cell = search(slot.first, hit).cell;
    if (cell == no_cell || !anchors_[cell].is_halved || level == most_halvings) return cell;
    ++level;
    voxel = key_of(hit, size_at(level), level);
  }
}

uint32_t CellMap::find_from_afar(const CellHit& hit) const {
  uint32_t cell = find(hit, near());
  float distance = sizes_of_far * size_;
  for (int32_t k = 0; cell == no_cell && k < most_doublings; ++k, distance *= 2)
    cell = find(hit, distance);
  return cell;
}

void CellMap::keep(const CellHit& hit, bool is_asked, Hits& h) {
  if (h.count < hits_per_cell) {
    h.hits[h.count++] = hit;
    return;
  }
  if (!is_asked) return;
  if (h.more == no_cell) {
    h.more = uint32_t(more_hits_.size());
    more_hits_.emplace_back(h.hits.begin(), h.hits.end()).reserve(hits_of_asked_cell);
  }
  std::vector<CellHit>& hits = more_hits_[h.more];
  if (hits.size() < hits_of_asked_cell) hits.push_back(hit);
}

uint32_t CellMap::add(const CellHit& hit, float distance, bool is_asked) {
  int32_t level = first_level(distance);
  uint32_t cell = add_at(hit, level, is_asked);
  while (anchors_[cell].is_halved && level < most_halvings) cell = add_at(hit, ++level, is_asked);
  if (cell >= frozen_) keep(hit, is_asked, hits_[cell]);
  return cell;
}

// Returns the cell of one level there, or the halved one; makes one if there is none.
uint32_t CellMap::add_at(const CellHit& hit, int32_t level, bool is_asked) {
  const uint64_t key = key_of(hit, size_at(level), level);
  Slot& slot = slots_[slot_of(key)];
  Found found;
  if (slot.first != no_cell) found = search(slot.first, hit);
  if (found.cell != no_cell) return found.cell;
  const uint32_t cell = make(hit, level, is_asked);
  if (found.last != no_cell) {
    anchors_[found.last].next = cell;
    return cell;
  }
  slot = {key, cell};
  if (++used_ * 2 > slots_.size()) grow();
  return cell;
}

uint32_t CellMap::make(const CellHit& hit, int32_t level, bool is_asked) {
  Anchor a;
  a.position = hit.position;
  a.normal = hit.horizon;
  a.size = size_at(level);
  const size_t up = face_of(hit.normal) / 2;
  // If shading turns the normal too far from the surface's plane, there is no outline to test.
  a.is_divided = std::abs(hit.horizon[up]) < 0.2f;
  if (!a.is_divided) {
    const CellOutline outline = outline_of(hit, a.size);
    a.is_divided = is_divided(hit, outline, a.size);
    a.is_halved = level < most_halvings && is_uneven_ && is_uneven_(outline, is_asked);
  }
  a.is_narrow = resolves_narrow_ && !a.is_halved && ends_both_ways(a.position, a.normal, a.size);
  anchors_.push_back(a);
  hits_.emplace_back();
  return uint32_t(anchors_.size() - 1);
}

// True if something parts the surface within the voxel. It then crosses the outline of the voxel on
// the surface's plane, which four short rays test just above it.
bool CellMap::is_divided(const CellHit& hit, const CellOutline& outline, float size) const {
  const Vec3 up = outline.normal * (lift * size);
  const auto corner = [&](size_t i) { return outline.corners[i % 4] + up; };
  for (size_t i = 0; i < 4; ++i)
    if (is_blocked(tracer_, segment(corner(i), corner(i + 1)))) return true;
  // A small thing stands between the outline and the hit.
  return is_blocked(tracer_, segment(hit.position + up, corner(0))) ||
         is_blocked(tracer_, segment(hit.position + up, corner(2)));
}

// True if the surface is not much wider than a cell along one of the voxel's axes, because it ends
// or bends away at both sides. The place on it does not matter. A cell's light is that of few hits,
// so cells at the darker edge must not be marked differently from those at the brighter one.
bool CellMap::ends_both_ways(const Vec3& position, const Vec3& normal, float size) const {
  const size_t up = face_of(normal) / 2;
  const Vec3 above = normal * (lift * size);
  const auto is_there = [&](const Vec3& d) {
    return is_blocked(tracer_, segment(position + d + above, position + d - above));
  };
  // Returns how far the surface goes, in cell sizes, but no more than `most`. Bisects.
  const auto extent = [&](const Vec3& to, float most) {
    if (is_there(to * most)) return most;
    float is = 0, ends = most;
    while (ends - is > known_width) {
      const float middle = 0.5f * (is + ends);
      (is_there(to * middle) ? is : ends) = middle;
    }
    return 0.5f * (is + ends);
  };
  for (const size_t along : {(up + 1) % 3, (up + 2) % 3}) {
    Vec3 d;  // along the surface's plane
    d[along] = size;
    d[up] = -d[along] * normal[along] / normal[up];
    const float before = extent(d, most_of_narrow), most = most_of_narrow - before;
    if (most > 0 && extent(-d, most) < most) return true;
  }
  return false;
}

void CellMap::resolve_narrow(bool looks, int threads) {
  resolves_narrow_ = looks;
  constexpr size_t at_a_time = 1024;
  parallel_for((size() + at_a_time - 1) / at_a_time, threads, [&](size_t part) {
    const size_t end = std::min((part + 1) * at_a_time, size());
    for (size_t c = part * at_a_time; c < end; ++c) {
      Anchor& a = anchors_[c];
      a.is_narrow = looks && !a.is_halved && ends_both_ways(a.position, a.normal, a.size);
    }
  });
}

bool CellMap::would_be_narrow(const CellHit& hit, float distance) const {
  return resolves_narrow_ &&
         ends_both_ways(hit.position, hit.horizon, size_at(first_level(distance)));
}

void CellMap::grow() {
  std::vector<Slot> old(2 * slots_.size());
  old.swap(slots_);
  for (const Slot& s : old)
    if (s.key != 0) slots_[slot_of(s.key)] = s;
}

}  // namespace troffer
