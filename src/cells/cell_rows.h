// How cells light each other: rows of a sparse matrix, by rays.
//
//     E_i = D_i + 1/M_i Σ_k w_k E_j(k)
//
// where the M_i rays of row i, distributed by cosine, see cells j(k), and w_k is the reflectance
// there times what mirrors and glass on the way leave of the light.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/rgb.h"
#include "cells/noise_draws.h"

namespace troffer {

struct RowEntry {
  uint32_t cell = 0;
  Rgb weight;
};

// Rays of one cell, traced at one time.
struct RowPart {
  uint32_t cell = 0;
  uint32_t rays = 0;
  uint32_t entries = 0;
  bool is_second_half = false;  // which half of all rays it belongs to
  // Irradiance times rays, of sources that were run into, or drawn at narrow things.
  Rgb emission;
};

struct CellLight {
  std::vector<Rgb> irradiance;
  // Half the difference of what either half of the rays, and of the hits that were lit, would bring
  // a cell, by way of other cells too: luminance; how far halves differ says how much noise there
  // is.
  std::vector<float> half_difference;
  int iterations = 0;
};

class CellRows {
 public:
  // Entries of `part`, in their order.
  void add(const RowPart& part, std::span<const RowEntry> entries);
  // Call before all that follow; cells: how many there are.
  void finish(size_t cells);

  std::span<const RowPart> parts() const { return parts_; }
  std::span<const RowEntry> entries(size_t part) const {
    return std::span(entries_).subspan(first_entry_[part], parts_[part].entries);
  }
  size_t entry_count() const { return entries_.size(); }
  uint64_t ray_count() const { return rays_in_all_; }
  bool has_row(size_t cell) const { return cell < rays_.size() && rays_[cell] > 0; }
  uint32_t rays(size_t cell) const { return rays_[cell]; }

  // Solves for E; direct: D, per cell; of_direct: half the difference of two halves of it;
  // importance: of each cell, for what is asked (those beyond its end have none).
  CellLight solve(const std::vector<Rgb>& direct, const std::vector<float>& of_direct,
                  std::vector<float> importance, int threads) const;
  // How much of what is asked for each cell's light is, all bounces counted: y = c + Wᵀ y. `known`:
  // of rows that were nearly these, or nothing; not more than `iterations` bounces more.
  std::vector<float> importance(const std::vector<float>& asked, std::vector<float> known,
                                int iterations) const;
  // What each cell is off by, by the choice of its own rays: half the difference of two halves of
  // them, as one draw. e: light of cells.
  std::vector<float> differences(const std::vector<Rgb>& e, int threads) const;
  // Draws of what each cell is off by, by way of others too, where each by itself is off by both of
  // these, either way, each by a sign of its own: differences(), and half the difference of two
  // halves of `direct`.
  std::vector<NoiseDraws> noise_draws(const std::vector<float>& by_rows,
                                      const std::vector<float>& by_hits, int threads) const;

 private:
  enum class Half { first, second };
  // Over half of a cell's rays: what the cells that they see reflect, and `emission`.
  struct RowSum {
    Rgb reflected, emitted;
    uint32_t rays = 0;
  };
  std::vector<Rgb> light_of_sources(const std::vector<Rgb>& direct, int threads) const;
  // Of each cell Σ w_k / M, one after the other: a solve goes over them again and again.
  struct Packed {
    std::vector<size_t> begin;  // of each cell, and the end
    std::vector<RowEntry> entries;
    std::span<const RowEntry> of(size_t cell) const {
      return std::span(entries).subspan(begin[cell], begin[cell + 1] - begin[cell]);
    }
  };
  Packed packed() const;
  float bounded_share(size_t cell) const;
  RowSum sum_of(size_t cell, const std::vector<Rgb>& e, Half half) const;
  float difference_of_halves(size_t cell, const std::vector<Rgb>& e) const;
  static void spread(const Packed& rows, std::vector<float>& differences, int threads);

  std::vector<RowPart> parts_;
  std::vector<size_t> first_entry_;  // of each part
  std::vector<RowEntry> entries_;
  std::vector<uint32_t> rays_;  // per cell
  // … what a unit of all that they bring is worth: one over their number, or less where they would
  // bring more than there is (few rays, of which one that gloss sent on counts for many)
  std::vector<float> share_;
  std::vector<uint32_t> order_;  // parts by cell
  std::vector<size_t> begin_;    // of each cell in order_, and the end
  uint64_t rays_in_all_ = 0;
};

}  // namespace troffer
