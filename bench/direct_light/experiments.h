// The experiments of bench_direct. Each prints a table and appends rows to CSV files.
#pragma once

#include <cstdint>
#include <string>

#include "pairs.h"
#include "reference.h"

namespace troffer::bench {

// Command line of bench_direct.
struct Arguments {
  std::string mode, scene, only, csv_folder;
  std::string view_name = "view";  // name in the CSV files
  View view;
  ReferenceOptions reference;
  uint64_t seeds = 1000;
  double error = 0.01;  // error of certified visibility for `thin`
  bool is_quick = false;
};

// Writes error against time of all methods (curves.csv), the pairs (pairs.csv), and the answers of
// certified visibility by kind (answers.csv).
void curves(const Arguments& a);
// Writes the mean error of certified visibility over many seeds: bias.csv.
void bias(const Arguments& a);
// Writes results of certified visibility on the thin-occluder scenes: thin.csv.
void thin(const Arguments& a);
// Writes the unoccluded light of `--method certified` for every shape of source: shapes.csv.
void shapes(const Arguments& a);

// Appends a row to FOLDER/file, after `header` in a new file. Does nothing if `folder` is empty.
void append_row(const std::string& folder, const std::string& file, const std::string& header,
                const std::string& row);

}  // namespace troffer::bench
