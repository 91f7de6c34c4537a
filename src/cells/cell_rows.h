// Light between cells: rows of a sparse transport matrix, estimated by rays.
//
// E_i = D_i + 1/M_i Σ_k w_k E_j(k)
//
// E is irradiance and D its part straight from sources. The M_i rays of row i, distributed by
// cosine, see cells j(k). w_k is the reflectance there times what mirrors and glass on the way
// leave of the light. Built by gather/cell_builder.cpp, kept by cell_store.h.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/rgb.h"
#include "cells/noise_draws.h"

namespace troffer {

// Result of one ray: the cell j(k) and the weight w_k.
struct RowEntry {
  uint32_t cell = 0;
  Rgb weight;
};

// Rays of one cell, traced at one time.
struct RowPart {
  uint32_t cell = 0;
  uint32_t rays = 0;
  uint32_t entries = 0;
  bool is_second_half = false;  // half of the cell's rays that it belongs to
  // Irradiance × rays, from sources that rays ran into, or that were sampled at sub-cell features.
  Rgb emission;
};

struct CellLight {
  std::vector<Rgb> irradiance;
  // One draw of the noise of each cell, including noise by way of other cells. It is half the
  // difference of what the two halves of its rays, and of its lit hits, would bring. Luminance.
  std::vector<float> half_difference;
  int iterations = 0;
};

class CellRows {
 public:
  // Adds a part and its entries, in their order.
  void add(const RowPart& part, std::span<const RowEntry> entries);
  // Prepares for all that follow; call it after add(). cells: their number.
  void finish(size_t cells);

  std::span<const RowPart> parts() const { return parts_; }
  std::span<const RowEntry> entries(size_t part) const {
    return std::span(entries_).subspan(first_entry_[part], parts_[part].entries);
  }
  size_t entry_count() const { return entries_.size(); }
  uint64_t ray_count() const { return rays_in_all_; }
  bool has_row(size_t cell) const { return cell < rays_.size() && rays_[cell] > 0; }
  uint32_t rays(size_t cell) const { return rays_[cell]; }

  // Solves for E. direct: D per cell. of_direct: half the difference of two halves of D.
  // importance: of each cell for what is asked; 0 for cells beyond its end.
  CellLight solve(const std::vector<Rgb>& direct, const std::vector<float>& of_direct,
                  std::vector<float> importance, int threads) const;
  // Returns the importance of cells, y = c + Wᵀ y: how much of what c asks for is each cell's
  // light, all bounces counted. known: importance for nearly these rows, to start from, or empty.
  // iterations: limit of further bounces.
  std::vector<float> importance(const std::vector<float>& asked, std::vector<float> known,
                                int iterations) const;
  // Returns one draw of the error of each cell by the choice of its own rays: half the difference
  // of two halves of them. e: irradiance of cells.
  std::vector<float> differences(const std::vector<Rgb>& e, int threads) const;
  // Returns draws of the error of each cell, by way of others too. A cell itself errs by by_rows
  // (differences()) and by by_hits (half the difference of two halves of direct light). Each draw
  // gives both a random sign.
  std::vector<NoiseDraws> noise_draws(const std::vector<float>& by_rows,
                                      const std::vector<float>& by_hits, uint64_t seed,
                                      int threads) const;

 private:
  enum class Half { first, second };
  // Over half of a cell's rays: the light that cells reflect to them, and `emission`.
  struct RowSum {
    Rgb reflected, emitted;
    uint32_t rays = 0;
  };
  std::vector<Rgb> light_of_sources(const std::vector<Rgb>& direct, int threads) const;
  // All Σ w_k / M, cell by cell in memory, because a solve reads them again and again.
  struct Packed {
    std::vector<size_t> begin;  // first entry of each cell, and the end
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
  std::vector<size_t> first_entry_;  // per part
  std::vector<RowEntry> entries_;
  std::vector<uint32_t> rays_;  // per cell
  // Per cell, the factor of all that its rays bring. It is one over their number, or less where
  // they would bring more than there is: few rays, one of them made heavy by roulette at gloss.
  std::vector<float> share_;
  std::vector<uint32_t> order_;  // parts, ordered by cell
  std::vector<size_t> begin_;    // per cell: its first part in order_, and the end
  uint64_t rays_in_all_ = 0;
};

}  // namespace troffer
