#include "cells/cell_map.h"

#include <cmath>

#include "base/random.h"

namespace troffer {

namespace {

// Hits of one cell lie in one plane within this share of its size; more where it is curved.
constexpr float flatness = 0.05f;
// Cosine of the angle by which normals in a cell may differ.
constexpr float least_cosine = 0.87f;
// How high above the surface sight is tried, in sizes.
constexpr float lift = 0.1f;
// Cells of one voxel; what is compatible with none of so many joins the least incompatible, or the
// leaves of a tree would be a list each voxel.
constexpr int most_in_voxel = 12;

// The axis along which a normal points most, and which way. Weights keep surfaces at 45° from being
// torn by rounding.
uint32_t face_of(const Vec3& n) {
  const float x = std::abs(n.x), y = std::abs(n.y) * 1.017f, z = std::abs(n.z) * 1.031f;
  const uint32_t axis = x > y && x > z ? 0 : y > z ? 1 : 2;
  return 2 * axis + (n[axis] < 0 ? 1u : 0u);
}

// The voxel's number along one axis. The grid is off the planes at which people build.
constexpr double shift = 0.3819660;
int64_t voxel_of(float x, float size) {
  return int64_t(std::floor(double(x) / double(size) + shift));
}

uint64_t key_of(const CellHit& h, float size, uint32_t level) {
  const uint64_t key =
      hash_of(uint64_t(voxel_of(h.position.x, size)), uint64_t(voxel_of(h.position.y, size)),
              uint64_t(voxel_of(h.position.z, size)), face_of(h.normal) + 8 * level);
  return key == 0 ? 1 : key;  // 0: an empty slot
}

Ray segment(const Vec3& from, const Vec3& to) {
  Ray r;
  r.origin = from;
  r.direction = to - from;
  r.t_max = 1;
  return r;
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
  size_t i = key & (slots_.size() - 1);
  while (slots_[i].key != 0 && slots_[i].key != key) i = (i + 1) & (slots_.size() - 1);
  return i;
}

bool CellMap::sees(const Anchor& a, const CellHit& hit) const {
  return !is_blocked(tracer_, segment(a.position + a.normal * (lift * a.size),
                                      hit.position + hit.horizon * (lift * a.size)));
}

// Through the cells of one voxel, the first of which is given.
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

uint32_t CellMap::find(const CellHit& hit, float distance) const {
  const bool is_near = distance < near();
  const Slot& slot = slots_[slot_of(key_of(hit, is_near ? 0.5f * size_ : size_, is_near ? 1 : 0))];
  return slot.first == no_cell ? no_cell : search(slot.first, hit).cell;
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
  const bool is_near = distance < near();
  const float size = is_near ? 0.5f * size_ : size_;
  const uint64_t key = key_of(hit, size, is_near ? 1 : 0);
  Slot& slot = slots_[slot_of(key)];
  Found found;
  if (slot.first != no_cell) found = search(slot.first, hit);
  if (found.cell != no_cell) {
    if (found.cell >= frozen_) keep(hit, is_asked, hits_[found.cell]);
    return found.cell;
  }
  const uint32_t cell = make(hit, size);
  if (found.last != no_cell) {
    anchors_[found.last].next = cell;
    return cell;
  }
  slot = {key, cell};
  if (++used_ * 2 > slots_.size()) grow();
  return cell;
}

uint32_t CellMap::make(const CellHit& hit, float size) {
  Anchor a;
  a.position = hit.position;
  a.normal = hit.horizon;
  a.size = size;
  a.is_divided = is_divided(hit, size);
  anchors_.push_back(a);
  Hits& h = hits_.emplace_back();
  h.hits[0] = hit;
  h.count = 1;
  return uint32_t(anchors_.size() - 1);
}

// Whatever parts the surface within the voxel also crosses the outline of the voxel on the
// surface's plane: four short rays above it.
bool CellMap::is_divided(const CellHit& hit, float size) const {
  const Vec3& n = hit.horizon;
  const size_t up = face_of(hit.normal) / 2, u = (up + 1) % 3, v = (up + 2) % 3;
  if (std::abs(n[up]) < 0.2f) return true;  // shading turns it too far from its plane to say
  std::array<Vec3, 4> corners;
  for (size_t i = 0; i < 4; ++i) {
    Vec3 d;
    const auto low = [&](size_t axis) {
      return float((double(voxel_of(hit.position[axis], size)) - shift) * double(size)) -
             hit.position[axis];
    };
    d[u] = low(u) + (i == 1 || i == 2 ? size : 0.0f);
    d[v] = low(v) + (i >= 2 ? size : 0.0f);
    d[up] = -(n[u] * d[u] + n[v] * d[v]) / n[up];
    corners[i] = hit.position + d + n * (lift * size);
  }
  for (size_t i = 0; i < 4; ++i)
    if (is_blocked(tracer_, segment(corners[i], corners[(i + 1) % 4]))) return true;
  // … and stands between the outline and the hit, if it is small
  return is_blocked(tracer_, segment(hit.position + n * (lift * size), corners[0])) ||
         is_blocked(tracer_, segment(hit.position + n * (lift * size), corners[2]));
}

void CellMap::grow() {
  std::vector<Slot> old(2 * slots_.size());
  old.swap(slots_);
  for (const Slot& s : old)
    if (s.key != 0) slots_[slot_of(s.key)] = s;
}

}  // namespace troffer
