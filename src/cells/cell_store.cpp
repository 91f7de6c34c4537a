#include "cells/cell_store.h"

#include <algorithm>
#include <cmath>

#include "base/own_file.h"

namespace troffer {

namespace {

constexpr OwnFile cell_file{{'t', 'r', 'o', 'f', 'f', 'C', 'e', 'l'}, 7, "cell file"};
constexpr uint32_t most_rays = 1 << 16;  // largest number for one part of a row
constexpr uint32_t divided_flag = 1, halved_flag = 2;

struct Header {
  char magic[8];
  uint32_t version;
  float size;
  uint64_t scene_key;
  double direct_error;
  uint64_t cells, hits, slots, parts, entries;
  uint64_t hash;  // hash of the body, and of the header with 0 here
};
static_assert(sizeof(Header) == 80);

struct FileCell {
  Vec3 position, normal;
  uint32_t next;
  float size;
  uint32_t flags, hits;
  Rgb direct;
  float direct_half_difference;
};
static_assert(sizeof(FileCell) == 56);

struct FileSlot {
  uint64_t key;
  uint32_t first, unused;
};

struct FilePart {
  uint32_t cell, rays, entries, is_second_half;
  Rgb emission;
};
static_assert(sizeof(FilePart) == 28 && sizeof(RowEntry) == 16 && sizeof(CellHit) == 52);

bool is_light(const Rgb& c) {
  return is_finite(c) && c.r >= 0 && c.g >= 0 && c.b >= 0;
}
bool is_unit(const Vec3& v) {
  return std::abs(length_squared(v) - 1) < 1e-3f;
}

}  // namespace

// Reads and writes what a map is made of. Reading checks everything, because a file may come from
// anybody.
struct CellMapParts {
  static uint64_t hits_of(const CellMap& map) {
    uint64_t n = 0;
    for (size_t c = 0; c < map.size(); ++c) n += map.hits(c).size();
    return n;
  }
  static uint64_t slots_of(const CellMap& map) { return map.used_; }

  static void write(const CellStore& s, std::vector<uint8_t>& out) {
    const CellMap& map = *s.map;
    for (size_t c = 0; c < map.size(); ++c) {
      const CellMap::Anchor& a = map.anchors_[c];
      const uint32_t flags = (a.is_divided ? divided_flag : 0) | (a.is_halved ? halved_flag : 0);
      append(out, FileCell{a.position, a.normal, a.next, a.size, flags,
                           uint32_t(map.hits(c).size()), s.direct[c], s.direct_half_difference[c]});
    }
    for (size_t c = 0; c < map.size(); ++c)
      for (const CellHit& hit : map.hits(c)) append(out, hit);
    std::vector<FileSlot> slots;
    for (const CellMap::Slot& slot : map.slots_)
      if (slot.key != 0) slots.push_back({slot.key, slot.first, 0});
    // Sorted, because the order of slots depends on the order in which the table was filled.
    std::sort(slots.begin(), slots.end(),
              [](const FileSlot& a, const FileSlot& b) { return a.key < b.key; });
    for (const FileSlot& slot : slots) append(out, slot);
  }

  // Reads a cell; false if no map can have it. Cells of a voxel are linked in the order in which
  // they were made, so their lists end.
  static bool read_cell(const FileCell& f, size_t cell, size_t cells, CellMap& map) {
    if (!is_finite(f.position) || !is_unit(f.normal) || !(f.size > 0) || !std::isfinite(f.size) ||
        f.flags > (divided_flag | halved_flag) || f.hits > hits_of_asked_cell)
      return false;
    const bool is_halved = (f.flags & halved_flag) != 0;
    if (is_halved != (f.hits == 0)) return false;
    if (f.next != no_cell && (f.next <= cell || f.next >= cells)) return false;
    map.anchors_.push_back(
        {f.position, f.normal, f.next, f.size, (f.flags & divided_flag) != 0, is_halved});
    CellMap::Hits& hits = map.hits_.emplace_back();
    hits.count = std::min(f.hits, uint32_t(hits_per_cell));
    if (f.hits > hits_per_cell) {
      hits.more = uint32_t(map.more_hits_.size());
      map.more_hits_.emplace_back(f.hits);
    }
    return true;
  }

  static bool read_hits(ByteReader& in, CellMap& map) {
    for (CellMap::Hits& h : map.hits_) {
      const auto all = h.more == no_cell ? std::span(h.hits.data(), size_t(h.count))
                                         : std::span(map.more_hits_[h.more]);
      for (size_t i = 0; i < all.size(); ++i) {
        const auto hit = in.next<CellHit>();
        if (!is_finite(hit.position) || !is_unit(hit.normal) || !is_unit(hit.horizon) ||
            !(hit.offset >= 0) || !std::isfinite(hit.offset) || !std::isfinite(hit.uv.x) ||
            !std::isfinite(hit.uv.y))
          return false;
        all[i] = hit;
        if (i < h.count) h.hits[i] = hit;
      }
    }
    return true;
  }

  static bool read_slots(ByteReader& in, uint64_t slots, CellMap& map) {
    for (uint64_t i = 0; i < slots; ++i) {
      const auto f = in.next<FileSlot>();
      if (f.key == 0 || f.first >= map.size()) return false;
      CellMap::Slot& slot = map.slots_[map.slot_of(f.key)];
      if (slot.key != 0) return false;
      slot = {f.key, f.first};
      if (++map.used_ * 2 > map.slots_.size()) map.grow();
    }
    return true;
  }
};

bool are_cells(std::span<const uint8_t> bytes) {
  return cell_file.is_of(bytes);
}

std::vector<uint8_t> save_cells(const CellStore& store, uint64_t scene_key) {
  TROFFER_CHECK(store.map != nullptr && store.direct.size() == store.map->size());
  std::vector<uint8_t> body;
  CellMapParts::write(store, body);
  const std::span<const RowPart> parts = store.rows.parts();
  for (const RowPart& p : parts)
    append(body, FilePart{p.cell, p.rays, p.entries, p.is_second_half ? 1u : 0u, p.emission});
  for (size_t p = 0; p < parts.size(); ++p)
    for (const RowEntry& e : store.rows.entries(p)) append(body, e);
  Header h{};
  h.size = store.map->size_of_cells();
  h.scene_key = scene_key;
  h.direct_error = store.direct_error;
  h.cells = store.map->size();
  h.hits = CellMapParts::hits_of(*store.map);
  h.slots = CellMapParts::slots_of(*store.map);
  h.parts = parts.size();
  h.entries = store.rows.entry_count();
  return own_file(cell_file, h, body);
}

namespace {

Header header_of(std::span<const uint8_t> bytes, const std::string& file, uint64_t scene_key) {
  const auto refuse = [&](const std::string& what) { throw InputError(file, 0, 0, what); };
  const auto count = [](const Header& h, BodySize& body) {
    body.take(h.cells, sizeof(FileCell));
    body.take(h.hits, sizeof(CellHit));
    body.take(h.slots, sizeof(FileSlot));
    body.take(h.parts, sizeof(FilePart));
    body.take(h.entries, sizeof(RowEntry));
  };
  const auto h = checked_header<Header>(cell_file, bytes, file, count);
  if (!(h.size >= least_cell) || !std::isfinite(h.size) || !(h.direct_error >= 0) ||
      h.cells >= no_cell)
    refuse("cell file has invalid values");
  if (h.scene_key != scene_key)
    refuse("cell file belongs to another scene, or other light: compute it again");
  return h;
}

bool read_cells(ByteReader& in, const Header& h, CellMap& map, CellStore& store) {
  uint64_t hits = 0;
  for (size_t c = 0; c < h.cells; ++c) {
    const auto f = in.next<FileCell>();
    // Cells reserve room for their hits, so they may not announce more than the file has.
    if (f.hits > h.hits - hits || !CellMapParts::read_cell(f, c, h.cells, map)) return false;
    if (!is_finite(f.direct) || !std::isfinite(f.direct_half_difference)) return false;
    hits += f.hits;
    store.direct.push_back(f.direct);
    store.direct_half_difference.push_back(f.direct_half_difference);
  }
  return hits == h.hits && CellMapParts::read_hits(in, map) &&
         CellMapParts::read_slots(in, h.slots, map);
}

bool read_rows(ByteReader& in, const Header& h, const CellMap& map, CellRows& rows) {
  // A halved cell is no cell, and has no hits at which rays could start.
  const auto is_cell = [&](uint32_t c) { return c < h.cells && !map.hits(c).empty(); };
  std::vector<RowPart> parts;
  uint64_t entries = 0;
  for (size_t p = 0; p < h.parts; ++p) {
    const auto f = in.next<FilePart>();
    if (!is_cell(f.cell) || f.rays < 1 || f.rays > most_rays || f.is_second_half > 1 ||
        !is_light(f.emission))
      return false;
    entries += f.entries;
    parts.push_back({f.cell, f.rays, f.entries, f.is_second_half != 0, f.emission});
  }
  if (entries != h.entries) return false;
  std::vector<RowEntry> row;
  for (const RowPart& p : parts) {
    row.clear();
    for (uint32_t e = 0; e < p.entries; ++e) {
      row.push_back(in.next<RowEntry>());
      if (!is_cell(row.back().cell) || !is_light(row.back().weight)) return false;
    }
    rows.add(p, row);
  }
  rows.finish(h.cells);
  return true;
}

}  // namespace

CellStore load_cells(std::span<const uint8_t> bytes, const std::string& file, uint64_t scene_key,
                     const Tracer& tracer) {
  const Header h = header_of(bytes, file, scene_key);
  ByteReader in(bytes.subspan(sizeof(Header)));
  CellStore store;
  auto map = std::make_shared<CellMap>(tracer, h.size);
  if (!read_cells(in, h, *map, store) || !read_rows(in, h, *map, store.rows))
    throw InputError(file, 0, 0, "cell file has invalid values");
  store.map = std::move(map);
  store.direct_error = h.direct_error;
  return store;
}

}  // namespace troffer
