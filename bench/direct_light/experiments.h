// The experiments that bench_direct can do: each prints a table and appends rows to CSV files.
#pragma once

#include <cstdint>
#include <string>

#include "pairs.h"
#include "reference.h"

namespace troffer::bench {

struct Arguments {
  std::string mode, scene, only, csv_folder;
  std::string view_name = "view";  // as it is called in the CSV files
  View view;
  ReferenceOptions reference;
  uint64_t seeds = 1000;
  double error = 0.01;  // thin: certified visibility's setting
  bool is_quick = false;
};

// Error against time of all methods: curves.csv; the pairs: pairs.csv; how certified visibility
// answered: answers.csv.
void curves(const Arguments& a);
// Mean error of certified visibility over many seeds: bias.csv.
void bias(const Arguments& a);
// Certified visibility on the thin-occluder scenes: thin.csv.
void thin(const Arguments& a);
// The unoccluded light of `--method certified` for every shape of source: shapes.csv.
void shapes(const Arguments& a);

// A row at the end of FOLDER/file; `header` where the file is new. Nothing if `folder` is empty.
void append_row(const std::string& folder, const std::string& file, const std::string& header,
                const std::string& row);

}  // namespace troffer::bench
